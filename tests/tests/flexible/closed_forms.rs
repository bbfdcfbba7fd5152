//! Links so simple that their equations can be written down: whether the kinematics that core and oracle share is that of bodies.

use gyroflex::model::{BodySpec, Fidelity, Friction, JointKind};
use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};
use gyroflex_testkit::State;
use gyroflex_testkit::flexible::{BendingLink, Particle, Seats, Shapes};
use gyroflex_testkit::random::{RandomFlexible, RandomRobot};
use gyroflex_tests::FlexibleCore;
use nalgebra::DMatrix;

/// From the axis of the turntable to the hinge [m].
const HUB: f64 = 0.3;
/// Length of the rod [m].
const ROD: f64 = 0.7;
/// At its end [kg].
const MASS: f64 = 1.3;
/// Of the hinge, by the way of the mass [N/m].
const STIFFNESS: f64 = 2.0;

/// A mass on a light rod that is hinged to the rim of a turntable about `z`; modes are its ways along `y` and `z`.
fn pendulum(stiffening: bool) -> RandomFlexible {
    let (y, z) = (Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0));
    let at = Vec3::new(HUB + ROD, 0.0, 0.0);
    // The end of a rod whose slope is 1/l sinks by ½ η²/l for each way.
    let sink = Vec3::new(-1.0 / ROD, 0.0, 0.0);
    let shortening = if stiffening { vec![sink, Vec3::zero(), Vec3::zero(), sink] } else { Vec::new() };
    let hub = SpatialInertia { mass: 1.0, first_moment: Vec3::zero(), rotational: SymMat3::diagonal(0.1, 0.1, 0.2) };
    let body = BodySpec {
        parent: None,
        joint: JointKind::Revolute,
        axis: z,
        placement: Transform::identity(),
        inertia: hub + SpatialInertia::from_com(MASS, at, SymMat3::zero()),
        friction: Friction::none(),
        drive: None,
    };
    RandomFlexible {
        robot: RandomRobot { seed: 0, bodies: vec![body], spring_tables: Vec::new(), gravity: Vec3::zero() },
        links: vec![BendingLink {
            body: 0,
            hub,
            cloud: vec![Particle { mass: MASS, at, shapes: Shapes { displacement: vec![y, z], shortening } }],
            sections: Vec::new(),
            stiffness: DMatrix::identity(2, 2) * STIFFNESS,
            damping: DMatrix::zeros(2, 2),
            stiffening,
        }],
        seats: vec![Seats::default()],
    }
}

/// A steadily turning table pulls the mass outwards: in the plane it swings with `ω² = Ω² R/l` beside its hinge's stiffness, across it
/// with `Ω² (R + l)/l`. Without the shortening of the rod the pull only softens, `−Ω²` in the plane and nothing across.
#[test]
fn a_pendulum_on_a_turntable_stiffens() {
    let (turning, eta): (f64, [f64; 2]) = (9.0, [0.02, -0.03]);
    let own = STIFFNESS / MASS;
    for (stiffening, pulls) in [(true, [HUB / ROD, (HUB + ROD) / ROD]), (false, [-1.0, 0.0])] {
        let robot = pendulum(stiffening);
        let zeros = || vec![0.0; 3];
        let s = State {
            q: vec![0.4, eta[0], eta[1]],
            qd: vec![turning, 0.0, 0.0],
            theta: zeros(),
            thetad: zeros(),
            qdd: zeros(),
            thetadd: zeros(),
            ..State::default()
        };
        let (_, etadd) = FlexibleCore::<f64>::new(&robot, Fidelity::Complete).hybrid(&s);
        for k in 0..2 {
            let want = -(own + turning * turning * pulls[k]) * eta[k];
            assert!((etadd[k] - want).abs() < 1e-13 * turning * turning, "mode {k}: {} for {want}", etadd[k]);
        }
    }
}
