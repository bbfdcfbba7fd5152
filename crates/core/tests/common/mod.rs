//! Small robots built by hand.

use gyroflex::model::*;
use gyroflex::spatial::*;

/// A joint about `axis` at `offset` from the parent's link frame, moving a link of one kilogram at `com`.
pub fn link(parent: Option<usize>, axis: [f64; 3], offset: [f64; 3], com: [f64; 3]) -> BodySpec {
    BodySpec {
        parent,
        joint: JointKind::Revolute,
        axis: axis.into(),
        placement: Transform::from_pose(Mat3::identity(), offset.into()),
        inertia: SpatialInertia::from_com(1.0, com.into(), SymMat3::diagonal(0.02, 0.03, 0.04)),
        friction: Friction::none(),
        drive: None,
    }
}

/// A drive whose rotor sits at the origin of `mount` and spins about `axis` there.
pub fn drive(mount: Option<usize>, axis: [f64; 3], gear_ratio: f64, transmission: TransmissionSpec) -> DriveSpec {
    DriveSpec {
        rotor: RotorSpec {
            inertia: 1e-4,
            body: Some(RotorBody { mass: 0.5, transverse_inertia: 8e-5 }),
            mount: MountSpec { body: mount, placement: Transform::identity(), axis: axis.into() },
        },
        gear_ratio,
        transmission,
        friction: Friction::none(),
    }
}

/// A linear spring with damping.
pub fn elastic(stiffness: f64, damping: f64) -> TransmissionSpec {
    TransmissionSpec::Elastic {
        spring: SpringSpec::Polynomial { stiffness, cubic: 0.0 },
        damping,
        error: TransmissionError::none(),
    }
}

/// Storage for a lowered robot.
pub struct Lowered {
    pub bodies: Vec<Body<f64>>,
    pub knots: Vec<Knot<f64>>,
    pub gravity: Vec3<f64>,
}

impl Lowered {
    /// Lowers a robot without spring tables.
    pub fn new(bodies: &[BodySpec], gravity: [f64; 3], fidelity: Fidelity) -> Self {
        Self::with_tables(bodies, &[], gravity, fidelity)
    }

    /// Lowers a robot.
    pub fn with_tables(bodies: &[BodySpec], tables: &[[f64; 2]], gravity: [f64; 3], fidelity: Fidelity) -> Self {
        let spec = RobotSpec { bodies, spring_tables: tables, gravity: gravity.into() };
        let mut records = vec![Body::empty(); bodies.len()];
        let mut knots = vec![Knot::EMPTY; spec.knots_needed()];
        spec.lower(fidelity, &mut records, &mut knots).expect("the robot of a test is valid");
        Self { bodies: records, knots, gravity: gravity.into() }
    }

    pub fn model(&self) -> Model<'_, f64> {
        Model::new(&self.bodies, &self.knots, self.gravity)
    }
}
