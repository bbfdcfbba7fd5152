//! The inverse of an elastic robot: motors and torques from the motion of the links, with storage of its own.
//!
//! ```
//! use gyroflex::control::reference::{PointToPoint, Reference};
//! use gyroflex::dynamics::External;
//! use gyroflex_sim::inverse::InverseModel;
//! use gyroflex_sim::load::{LoadOptions, load};
//!
//! # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../robots/lwr/robot.yaml");
//! # /*
//! let path = "robots/lwr/robot.yaml";
//! # */
//! let robot = load(path.as_ref(), &LoadOptions::default())?;
//! let mut inverse = InverseModel::new(&robot, robot.fidelity, 0)?;
//! let (nv, order) = (robot.joints.len(), inverse.smoothness().order());
//!
//! // All joints from 0 to 0.5 rad in a second, at rest in as many derivatives as are needed.
//! let motion = PointToPoint::new(0.0, 0.5, 0.0, 1.0, order).ok_or("numbers out of range")?;
//! let mut row = vec![0.0; 1 + order];
//! inverse.rest(&vec![0.0; nv], External::none())?;
//! for tick in 0..1000 {
//!     motion.derivatives(1e-3 * f64::from(tick), &mut row);
//!     let derivatives: Vec<f64> = row[1..].iter().flat_map(|r| vec![*r; nv]).collect();
//!     inverse.at(&vec![row[0]; nv], &derivatives, External::none(), 1e-3)?;
//!     inverse.advance();
//!     let (theta, tau) = (inverse.theta(0), inverse.tau(0));
//!     # assert!((theta[0] - row[0]).abs() < 0.1 && tau[0].is_finite());
//! }
//! # assert_eq!(order, 6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod along;
mod bending;
mod motor_output;
mod output;
mod run;
mod smoothness;

pub use along::ReferenceInverse;
pub use bending::BendingInverse;
pub use motor_output::MotorOutput;
pub use output::OutputInverse;
pub use run::{InverseRun, InverseSummary, JointInverse};
pub use smoothness::{JointSmoothness, SmoothnessTable, joint_orders};

use crate::dynamics::Dynamics;
use crate::equilibrium::Equilibrium;
use crate::error::{Error, ErrorKind};
use crate::robot::{OwnedModel, Robot};
use gyroflex::dynamics::{
    Contains, Deflections, DerivativeScratch, ElasticInverse, ElasticInverseScratch, External, InverseError,
    JointMotion, JointOrders, MAX_COEFFICIENTS, Smoothness, SmoothnessScratch, VANISHING, elastic_inverse,
    elastic_inverse_len, required_smoothness, smoothness_len,
};
use gyroflex::model::{Fidelity, TransmissionSpec};

/// A model, what its inverse needs, and everything the inverse writes.
#[derive(Clone, Debug)]
pub struct InverseModel {
    model: OwnedModel,
    names: Vec<String>,
    orders: Vec<JointOrders>,
    torque_derivatives: usize,
    series: Vec<ElasticInverseScratch<f64>>,
    theta: Vec<f64>,
    tau_j: Vec<f64>,
    tau: Vec<f64>,
    deflection: Vec<f64>,
    deflection_after: Vec<f64>,
    deflection_rate: Vec<f64>,
}

impl InverseModel {
    /// Prepares the inverse of a robot in one of its models, with `torque_derivatives` time derivatives of the torques.
    ///
    /// # Errors
    /// Names the joint that is not physical in this model; a robot that needs more derivatives than can be carried.
    pub fn new(robot: &Robot, fidelity: Fidelity, torque_derivatives: usize) -> Result<Self, Error> {
        robot.refuse_bending("the inverse of elastic joints", crate::zeros::ELASTIC_AND_BENDING)?;
        let model = robot.model(fidelity)?;
        let orders = orders(&model, torque_derivatives, VANISHING)?;
        let smoothness = Smoothness { joints: &orders, torque_derivatives };
        let (needed, nv) = (smoothness.coefficients(), model.view().nv());
        let length = elastic_inverse_len(&model.view(), &smoothness).ok_or_else(|| too_many(robot, needed))?;
        let zeros = |rows: usize| vec![0.0; rows * nv];
        Ok(Self {
            names: robot.joints.iter().map(|j| j.name.clone()).collect(),
            series: vec![ElasticInverseScratch::new(); length],
            theta: zeros(3 + torque_derivatives),
            tau_j: zeros(1 + torque_derivatives),
            tau: zeros(1 + torque_derivatives),
            deflection: zeros(1),
            deflection_after: zeros(1),
            deflection_rate: zeros(1),
            torque_derivatives,
            orders,
            model,
        })
    }

    /// What the inverse asks of every joint.
    pub fn smoothness(&self) -> Smoothness<'_> {
        Smoothness { joints: &self.orders, torque_derivatives: self.torque_derivatives }
    }

    /// The model.
    pub fn model(&self) -> &OwnedModel {
        &self.model
    }

    /// Deflections of the damped transmissions, the state of the inverse: `nv` entries [rad or m].
    pub fn deflection(&self) -> &[f64] {
        &self.deflection
    }

    /// Sets them.
    pub fn set_deflection(&mut self, deflection: &[f64]) {
        self.deflection.copy_from_slice(deflection);
    }

    /// Sets them to those at which the transmissions hold the links at rest at `q` (`nq` entries) against gravity and `ext`.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn rest(&mut self, q: &[f64], ext: External<f64>) -> Result<(), Error> {
        let nv = self.deflection.len();
        let (mut theta, mut tau) = (vec![0.0; nv], vec![0.0; nv]);
        let mut dynamics = Dynamics::new(self.model.clone());
        Equilibrium::new(nv).solve(&mut dynamics, q, ext, &mut theta, &mut tau)?;
        for body in dynamics.model().bodies() {
            let (k, Some(drive)) = (body.v_index(), &body.drive) else { continue };
            let Some(elastic) = &drive.elastic else { continue };
            let error = elastic.error.map_or(0.0, |e| e.value_and_slope(theta[k], drive.rotor.gear_ratio).0);
            self.deflection[k] = theta[k] - q[body.q_index()] - error;
        }
        Ok(())
    }

    /// Finds motors and torques for positions `q` (`nq` entries) and their derivatives, one after the other (`nv` entries each); `step` is the
    /// time to the next call [s], for which [`InverseModel::advance`] moves the deflections.
    ///
    /// # Errors
    /// Names the joint and what is wrong: a motion with too few derivatives, a transmission that cannot be inverted, torques that
    /// are not finite.
    pub fn at(&mut self, q: &[f64], derivatives: &[f64], ext: External<f64>, step: f64) -> Result<(), Error> {
        let smoothness = Smoothness { joints: &self.orders, torque_derivatives: self.torque_derivatives };
        let out = ElasticInverse {
            theta: &mut self.theta,
            tau_j: &mut self.tau_j,
            tau: &mut self.tau,
            deflection: &mut self.deflection_after,
            deflection_rate: &mut self.deflection_rate,
        };
        elastic_inverse::<f64, MAX_COEFFICIENTS>(
            &self.model.view(),
            &smoothness,
            JointMotion { q, derivatives },
            ext,
            Deflections { now: &self.deflection, step },
            &mut self.series,
            out,
        )
        .map_err(|error| self.error(error))
    }

    /// Moves the deflections on by the step of the last call.
    pub fn advance(&mut self) {
        self.deflection.copy_from_slice(&self.deflection_after);
    }

    /// A derivative of the reflected motor positions, the position being the zeroth: `nv` entries.
    ///
    /// # Panics
    /// If there are not so many: there are two more than of the torques.
    pub fn theta(&self, derivative: usize) -> &[f64] {
        row(&self.theta, derivative, self.deflection.len())
    }

    /// A derivative of the torques through the transmissions, link side: `nv` entries [N m or N].
    ///
    /// # Panics
    /// If there are not so many.
    pub fn tau_j(&self, derivative: usize) -> &[f64] {
        row(&self.tau_j, derivative, self.deflection.len())
    }

    /// A derivative of the motor torques, reflected: `nv` entries [N m or N].
    ///
    /// # Panics
    /// If there are not so many.
    pub fn tau(&self, derivative: usize) -> &[f64] {
        row(&self.tau, derivative, self.deflection.len())
    }

    /// Present rates of the deflections: `nv` entries [rad/s or m/s].
    pub fn deflection_rate(&self) -> &[f64] {
        &self.deflection_rate
    }

    /// What the core's error means for this robot.
    pub(crate) fn error(&self, error: InverseError) -> Error {
        let (body, kind) = match error {
            InverseError::Size(e) => return e.into(),
            InverseError::TooManyDerivatives { .. } => (0, ErrorKind::Model),
            InverseError::NotSmooth { body, .. } => (body, ErrorKind::Shape),
            InverseError::Transmission { body } | InverseError::Overflow { body } => (body, ErrorKind::Diverged),
        };
        let (problem, remedy) = match error {
            InverseError::NotSmooth { needed, given, .. } => (
                format!("the torques depend on derivative {needed} of its position, but {given} are given"),
                "give a smoother motion, or take the reduced model, which needs fewer derivatives",
            ),
            InverseError::Transmission { .. } => (
                "its transmission cannot be inverted at the torque that it must carry".to_owned(),
                "check its spring, and whether the motion is one that the robot could ever make",
            ),
            _ => (
                "the inverse leaves the finite numbers".to_owned(),
                "check the motion and its derivatives, and the damping of the transmissions",
            ),
        };
        Error {
            kind,
            file: String::new(),
            element: format!("joint `{}`", self.names.get(body).map_or("", String::as_str)),
            problem,
            remedy: remedy.to_owned(),
        }
    }
}

/// The orders of a lowered model.
fn orders(model: &OwnedModel, torque_derivatives: usize, vanishing: f64) -> Result<Vec<JointOrders>, Error> {
    let view = model.view();
    let (n, nv) = (view.bodies().len(), view.nv());
    let mut orders = vec![JointOrders::default(); n];
    let scratch = SmoothnessScratch {
        bodies: &mut vec![DerivativeScratch::new(); n],
        numbers: &mut vec![0.0; smoothness_len(&view)],
        contains: &mut vec![Contains::default(); nv * nv],
    };
    required_smoothness(&view, torque_derivatives, vanishing, scratch, &mut orders)?;
    Ok(orders)
}

/// The robot with at least this damping in its elastic transmissions [N m s/rad or N s/m]: an inverse of it is stable and needs fewer
/// derivatives, and is wrong by what the damping adds (Thümmel, Otter & Bals, §2: "introducing additional damping terms").
pub fn with_least_damping(robot: &Robot, least: f64) -> Robot {
    let mut robot = robot.clone();
    for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
        if let TransmissionSpec::Elastic { damping, .. } = &mut drive.transmission {
            *damping = damping.max(least);
        }
    }
    robot
}

/// Takes the damping out of all transmissions.
fn without_damping(robot: &mut Robot) {
    for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
        if let TransmissionSpec::Elastic { damping, .. } = &mut drive.transmission {
            *damping = 0.0;
        }
    }
}

fn row(all: &[f64], derivative: usize, nv: usize) -> &[f64] {
    &all[derivative * nv..(derivative + 1) * nv]
}

fn too_many(robot: &Robot, needed: usize) -> Error {
    Error {
        kind: ErrorKind::Model,
        file: robot.sources.first().map_or_else(String::new, |s| s.name.clone()),
        element: format!("robot `{}`", robot.name),
        problem: format!(
            "its inverse carries series of {needed} coefficients, more than the {MAX_COEFFICIENTS} there is code for"
        ),
        remedy: "invert the reduced model, give the transmissions damping, or ask for fewer derivatives of the torques"
            .to_owned(),
    }
}
