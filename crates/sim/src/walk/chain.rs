//! A planar biped as its controller sees it: a chain of five links from the foot it stands on to the other one (Mu & Wu 2004, figure 1).

use crate::dynamics::Dynamics;
use crate::error::{Error, ErrorKind};
use crate::gait::{PlanarGait, Side};
use crate::robot::{OwnedModel, Robot};
use gyroflex::dynamics::{Acceleration, External, Inverse, State};
use gyroflex::model::{BodySpec, Fidelity, Friction, JointKind};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};
use nalgebra::{Matrix2x5, Matrix3x5, Matrix5, SVector, Vector2, Vector3};

/// Numbers for the five joints of a chain.
pub(super) type Five = SVector<f64, 5>;

/// What a controller believes of the robot's parameters: factors on the true ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beliefs {
    /// On masses and on moments of inertia about the centres of mass.
    pub mass: f64,
    /// On lengths and on places of the centres of mass.
    pub length: f64,
}

/// Where the parts of a planar biped are among its coordinates and bodies.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    /// Coordinates in the order of [`PlanarGait::COORDINATES`].
    pub(super) v: [usize; 7],
    bodies: [usize; 7],
    /// Foot points in the frames of the left and the right shank [m].
    feet: [Vec3<f64>; 2],
}

impl Parts {
    /// Finds the joints by their names.
    pub(super) fn of(robot: &Robot, feet: [Vec3<f64>; 2]) -> Result<Self, Error> {
        let mut v = [0; 7];
        for (at, name) in v.iter_mut().zip(PlanarGait::COORDINATES) {
            *at = robot.joints.iter().position(|j| j.name == name).ok_or_else(|| not_a_biped(robot, name))?;
        }
        // No floating root: joints, bodies and velocities are the same in number.
        if robot.joints.len() != 7 || robot.is_floating() {
            return Err(not_a_biped(robot, "anything but these seven"));
        }
        Ok(Self { v, bodies: v, feet })
    }

    /// Hip, knee of a leg among the seven.
    pub(super) fn leg(side: Side) -> [usize; 2] {
        match side {
            Side::Left => [3, 4],
            Side::Right => [5, 6],
        }
    }

    /// The body of a leg's shank.
    pub(super) fn shank(&self, side: Side) -> usize {
        self.bodies[Self::leg(side)[1]]
    }

    pub(super) fn foot(&self, side: Side) -> Vec3<f64> {
        self.feet[match side {
            Side::Left => 0,
            Side::Right => 1,
        }]
    }
}

fn not_a_biped(robot: &Robot, what: &str) -> Error {
    Error {
        kind: ErrorKind::Scenario,
        file: robot.sources.first().map_or(String::new(), |s| s.name.clone()),
        element: "controller.type".to_owned(),
        problem: format!("`walk` is for a planar biped, and the joint {what} does not fit"),
        remedy: format!("use a robot with the joints {}", PlanarGait::COORDINATES.join(", ")),
    }
}

/// The other leg.
pub(super) fn other(side: Side) -> Side {
    match side {
        Side::Left => Side::Right,
        Side::Right => Side::Left,
    }
}

/// The chain from one foot, in the joint angles `s`: the shank's against the vertical, then each link's against the one before. All about +y.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    dynamics: Dynamics,
    /// Vectors along the links at zero angles, foot to foot: shank, thigh, none for the trunk, thigh, shank [m].
    links: [Vector2<f64>; 5],
    /// Rotors' inertias reflected through the gears, which the controller knows of or not.
    reflected: Five,
    side: Side,
}

impl Chain {
    /// The chain that stands on a leg. With `rotors` it has the reflected inertias of rigid gears.
    pub(super) fn new(robot: &Robot, parts: &Parts, side: Side, beliefs: Beliefs, rotors: bool) -> Result<Self, Error> {
        let [hip, knee] = Parts::leg(side).map(|at| parts.bodies[at]);
        let [far_hip, far_knee] = Parts::leg(other(side)).map(|at| parts.bodies[at]);
        let trunk = parts.bodies[2];
        let at = |body: usize| robot.bodies[body].placement.pos;
        let (foot, far_foot) = (parts.foot(side), parts.foot(other(side)));
        // The near leg is passed from its foot upwards: its frames move to the lower ends of its links.
        let links = [-foot, -at(knee), Vec3::zero(), at(far_knee), far_foot];
        let placements = [Vec3::zero(), -foot, -at(knee), at(far_hip) - at(hip), at(far_knee)];
        let origins = [-foot, -at(knee), -at(hip), Vec3::zero(), Vec3::zero()];
        let sources = [knee, hip, trunk, far_hip, far_knee];
        let bodies: Vec<BodySpec> = (0..5)
            .map(|i: usize| BodySpec {
                parent: i.checked_sub(1),
                joint: JointKind::Revolute,
                axis: Vec3::new(0.0, 1.0, 0.0),
                placement: Transform::from_pose(Mat3::identity(), placements[i].scale(beliefs.length)),
                inertia: believed(robot.bodies[sources[i]].inertia, origins[i], beliefs),
                friction: Friction::none(),
                drive: None,
            })
            .collect();
        let reflected = [None, Some(knee), Some(hip), Some(far_hip), Some(far_knee)].map(|body| {
            let drive = body.filter(|_| rotors).and_then(|body| robot.bodies[body].drive);
            drive.map_or(0.0, |d| d.gear_ratio * d.gear_ratio * d.rotor.inertia)
        });
        Ok(Self {
            dynamics: Dynamics::new(lowered(&bodies, robot.gravity)?),
            links: links.map(|v| Vector2::new(v.x, v.z) * beliefs.length),
            reflected: Five::from(reflected),
            side,
        })
    }

    /// Angles or rates of the chain's joints, from those of the robot in the order of [`PlanarGait::COORDINATES`].
    pub(super) fn angles(&self, q: [f64; 7]) -> Five {
        let [hip, knee] = Parts::leg(self.side).map(|at| q[at]);
        let [far_hip, far_knee] = Parts::leg(other(self.side)).map(|at| q[at]);
        Five::from([q[2] + hip + knee, -knee, -hip, far_hip, far_knee])
    }

    /// Torques of the robot's joints, in the order of [`PlanarGait::COORDINATES`], from those of the chain; the first one of these is the couple
    /// of the ground on the shank.
    pub(super) fn torques(&self, tau: &Five) -> [f64; 7] {
        let mut out = [0.0; 7];
        let ([hip, knee], [far_hip, far_knee]) = (Parts::leg(self.side), Parts::leg(other(self.side)));
        (out[knee], out[hip], out[far_hip], out[far_knee]) = (-tau[1], -tau[2], tau[3], tau[4]);
        out
    }

    /// `D` and `N`: `D s̈ + N = T`, with nothing held but the foot.
    pub(super) fn equations(&mut self, s: &Five, rates: &Five) -> Result<(Matrix5<f64>, Five), Error> {
        let (mut m, rest) = ([0.0; 25], [0.0; 5]);
        let [mut n, mut unused] = [[0.0; 5]; 2];
        self.dynamics.mass_matrix(s.as_slice(), &mut m)?;
        let state = State { q: s.as_slice(), qd: rates.as_slice(), theta: &rest, thetad: &rest };
        let out = Inverse { tau_j: &mut n, tau: &mut unused };
        self.dynamics.inverse(state, Acceleration { qdd: &rest, thetadd: &rest }, External::none(), out)?;
        Ok((Matrix5::from_row_slice(&m) + Matrix5::from_diagonal(&self.reflected), Five::from(n)))
    }

    /// Jacobians of the hip's position, the trunk's angle and the far foot's position, and their rates times the rates of the joints: `R`, `J`, `Ṙ ṡ`,
    /// `J̇ ṡ` (Mu & Wu 2004, equations 9 to 13).
    pub(super) fn motion(&self, s: &Five, rates: &Five) -> Motion {
        let (mut angle, mut rate) = (0.0, 0.0);
        let (mut r, mut j) = (Matrix3x5::zeros(), Matrix2x5::zeros());
        let (mut r_rate, mut j_rate) = (Vector3::zeros(), Vector2::zeros());
        for (i, link) in self.links.iter().enumerate() {
            angle += s[i];
            rate += rates[i];
            let (sin, cos) = angle.sin_cos();
            let along = Vector2::new(link.x * cos + link.y * sin, link.y * cos - link.x * sin);
            let across = Vector2::new(along.y, -along.x);
            // All joints up to the link's own turn it.
            for k in 0..=i {
                j.column_mut(k).axpy(1.0, &across, 1.0);
                if i < 2 {
                    r.fixed_view_mut::<2, 1>(0, k).axpy(1.0, &across, 1.0);
                }
            }
            j_rate -= along * (rate * rate);
            if i < 2 {
                r_rate.fixed_rows_mut::<2>(0).axpy(-rate * rate, &along, 1.0);
            }
        }
        (0..3).for_each(|k| r[(2, k)] = 1.0);
        Motion { outputs: r, outputs_rate: r_rate, foot: j, foot_rate: j_rate }
    }
}

/// See [`Chain::motion`].
pub(super) struct Motion {
    pub(super) outputs: Matrix3x5<f64>,
    pub(super) outputs_rate: Vector3<f64>,
    pub(super) foot: Matrix2x5<f64>,
    pub(super) foot_rate: Vector2<f64>,
}

/// A link's inertia about another origin, with the parameters that the controller believes in; `origin` is that of its own frame.
fn believed(link: SpatialInertia<f64>, origin: Vec3<f64>, beliefs: Beliefs) -> SpatialInertia<f64> {
    if link.mass == 0.0 {
        return SpatialInertia::zero();
    }
    let com = link.first_moment.scale(1.0 / link.mass);
    let about_com = link.rotational - SpatialInertia::from_com(link.mass, com, SymMat3::zero()).rotational;
    SpatialInertia::from_com(
        link.mass * beliefs.mass,
        (com + origin).scale(beliefs.length),
        about_com.scale(beliefs.mass),
    )
}

fn lowered(bodies: &[BodySpec], gravity: Vec3<f64>) -> Result<OwnedModel, Error> {
    let robot = Robot {
        name: "chain".to_owned(),
        joints: Vec::new(),
        bodies: bodies.to_vec(),
        spring_tables: Vec::new(),
        gravity,
        fidelity: Fidelity::RigidReflected,
        links: Vec::new(),
        table: Vec::new(),
        warnings: Vec::new(),
        sources: Vec::new(),
        payload: None,
        contacts: Vec::new(),
        held: Vec::new(),
        flexible: crate::flexible::Flexible::default(),
    };
    robot.model(Fidelity::RigidReflected)
}
