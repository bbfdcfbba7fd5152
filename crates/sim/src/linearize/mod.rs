//! Linear models of a robot about an operating point, their modes and their frequency response.
//!
//! State `x = (q, η, θ, q̇, η̇, θ̇)`: link positions as small motions (`nv` entries, a floating root's as a twist in its own frame,
//! angular part first), modal coordinates of links that bend, reflected positions of the motors behind elastic transmissions, and the
//! velocities of all. Input `u`: the
//! reflected motor torques of the joints; a floating root has no motors. Both are deviations from the operating point:
//!
//! ```text
//! ẋ = A x + B u,    y = C x + D u.
//! ```

mod discrete;
mod extremes;
mod friction;
mod layout;
pub mod mat;
mod natural;
mod nullspace;
mod outputs;
mod partials;
mod point;
mod reference;
mod response;
mod tables;
mod torque;

pub use discrete::{zero_order_hold, zero_order_hold_of};
pub use extremes::Extreme;
pub use friction::KeptFriction;
pub use layout::Layout;
pub(crate) use natural::eigenvalues;
pub use natural::{ModeKind, NaturalMode, natural_modes};
pub use outputs::Output;
pub use partials::{Derivatives, Partials, partials};
pub use point::OperatingPoint;
pub use reference::ReferenceMotion;
pub use response::{Response, Sweep, bode, frequency_response, logarithmic};
pub use tables::{Matrices, write_csv, write_mat};

use crate::dynamics::Dynamics;
use crate::error::{Error, ErrorKind};
use crate::robot::Robot;
use gyroflex::model::{Fidelity, JointKind};
use gyroflex::spatial::Vec3;
use nalgebra::DMatrix;

/// A robot in one of its models, ready to be linearized anywhere.
#[derive(Clone, Debug)]
pub struct Linearizer {
    pub(crate) robot: Robot,
    pub(crate) dynamics: Dynamics,
    pub(crate) layout: Layout,
}

/// A linear model about an operating point; see the module for `x` and `u`.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// `A`, by the states on both sides [units of the states, per second].
    pub a: DMatrix<f64>,
    /// `B`, a column an input.
    pub b: DMatrix<f64>,
    /// `C`, a row an output.
    pub c: DMatrix<f64>,
    /// `D`, a row an output, a column an input.
    pub d: DMatrix<f64>,
    /// Names of the states, as `q.joint1`, `theta.joint1`, `qd.joint1`, `thetad.joint1`.
    pub states: Vec<String>,
    /// Names of the inputs, as `tau.joint1`.
    pub inputs: Vec<String>,
    /// Names of the outputs, as `motor_position.joint1` or `pose.tool.x`.
    pub outputs: Vec<String>,
    /// What all is relative to.
    pub point: OperatingPoint,
    /// Sampling time [s]: `x` of the next sample is `A x + B u`; `None` for the model in continuous time.
    pub step: Option<f64>,
}

impl Linearizer {
    /// Prepares a robot; `kept` says which of its friction acts.
    ///
    /// # Errors
    /// Names the joint that is not physical in this model.
    pub fn new(robot: &Robot, fidelity: Fidelity, kept: KeptFriction) -> Result<Self, Error> {
        let mut robot = robot.clone();
        robot.fidelity = fidelity;
        kept.apply(&mut robot);
        let dynamics = Dynamics::new(robot.model(fidelity)?);
        let layout = Layout::of(&robot, &dynamics.model());
        Ok(Self { robot, dynamics, layout })
    }

    /// The robot, with the model and the friction asked for.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Which entry of state and input is what.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// `A, B, C, D` about a point.
    ///
    /// # Errors
    /// Vectors that do not fit the robot, an output it does not have, or a point where its accelerations are not finite.
    pub fn linearize(&self, point: &OperatingPoint, outputs: &[Output]) -> Result<Linearization, Error> {
        let partials = partials(&self.dynamics, &point.state, &point.tau)?;
        let rows = outputs::rows(self, point, &partials, outputs)?;
        let linear = Linearization {
            a: self.state_matrix(point, &partials),
            b: self.input_matrix(&partials),
            c: rows.c,
            d: rows.d,
            states: self.layout.state_names(),
            inputs: self.layout.input_names(),
            outputs: rows.names,
            point: point.clone(),
            step: None,
        };
        match [&linear.a, &linear.b, &linear.c, &linear.d].iter().all(|m| m.iter().all(|x| x.is_finite())) {
            true => Ok(linear),
            false => Err(Error {
                kind: ErrorKind::Diverged,
                file: String::new(),
                element: "linearization".to_owned(),
                problem: "the derivatives of the accelerations are not finite at this point".to_owned(),
                remedy: "check inertias, stiffnesses and the size of the numbers given".to_owned(),
            }),
        }
    }

    /// `A`: kinematics above, accelerations below.
    fn state_matrix(&self, point: &OperatingPoint, partials: &Partials) -> DMatrix<f64> {
        let layout = &self.layout;
        let (nv, half) = (layout.nv(), layout.positions());
        let mut a = DMatrix::zeros(2 * half, 2 * half);
        a.view_mut((0, half), (half, half)).fill_with_identity();
        if layout.floating() {
            root_transport(&point.state.qd, &mut a);
        }
        for row in 0..half {
            let (of, r) = match row {
                _ if row < nv => (&partials.qdd, row),
                _ => (&partials.thetadd, layout.elastic()[row - nv]),
            };
            for (column, k) in (0..nv).enumerate() {
                a[(half + row, column)] = of.q[(r, k)];
                a[(half + row, half + column)] = of.qd[(r, k)];
            }
            for (column, &k) in layout.elastic().iter().enumerate() {
                a[(half + row, nv + column)] = of.theta[(r, k)];
                a[(half + row, half + nv + column)] = of.thetad[(r, k)];
            }
        }
        a
    }

    /// `B`: torques accelerate.
    fn input_matrix(&self, partials: &Partials) -> DMatrix<f64> {
        let layout = &self.layout;
        let (nv, half) = (layout.nv(), layout.positions());
        DMatrix::from_fn(2 * half, layout.inputs().len(), |row, column| {
            let k = layout.inputs()[column];
            match row.checked_sub(half) {
                None => 0.0,
                Some(r) if r < nv => partials.qdd.tau[(r, k)],
                Some(r) => partials.thetadd.tau[(layout.elastic()[r - nv], k)],
            }
        })
    }
}

/// A small motion `ξ` of a floating root, given in its own moving frame, obeys `ξ̇ = δv − v × ξ`: the frame turns and travels with
/// the twist `v`.
fn root_transport(twist: &[f64], a: &mut DMatrix<f64>) {
    let cross = |v: &[f64]| gyroflex::spatial::Mat3::skew(Vec3::new(v[0], v[1], v[2]));
    let (turn, shift) = (cross(&twist[..3]), cross(&twist[3..6]));
    for (i, (t, s)) in turn.rows.iter().zip(&shift.rows).enumerate() {
        for (j, (t, s)) in t.to_array().into_iter().zip(s.to_array()).enumerate() {
            a[(i, j)] = -t;
            a[(3 + i, 3 + j)] = -t;
            a[(3 + i, j)] = -s;
        }
    }
}

/// Whether a body is moved by a joint of one degree of freedom.
fn is_joint(kind: JointKind) -> bool {
    kind != JointKind::Floating
}
