//! The inverse of a robot with rigid gears whose links bend: joints on their way, deflections as they must be.
//!
//! What the joints do is given, so the links' modes are a forced, collocated system of their own: integrated forward in time by the
//! classical Runge-Kutta scheme, `η̈` from [`hybrid`](crate::dynamics::Dynamics::hybrid).

use super::along::{check_smoothness, refuse_floating_root};
use super::motor_output::DERIVATIVES;
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::load::yaml::Keys;
use crate::reference::References;
use crate::robot::Robot;
use crate::zeros::ELASTIC_AND_BENDING;
use gyroflex::dynamics::{Acceleration, External, Inverse, State};
use gyroflex::model::Fidelity;

/// The inverse, and what it found at the last instant.
#[derive(Clone, Debug)]
pub struct BendingInverse {
    dynamics: Dynamics,
    joints: Coordinates,
    /// Joints and modes.
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
    tau: Vec<f64>,
    tau_j: Vec<f64>,
    etadd: Vec<f64>,
}

impl BendingInverse {
    /// Of a robot on a fixed base whose gears are all rigid in this model.
    ///
    /// # Errors
    /// A robot that is not physical in this model, a floating root, elastic joints, references that are not smooth enough.
    pub fn new(
        robot: &Robot,
        fidelity: Fidelity,
        joints: &Coordinates,
        references: &References,
        keys: &Keys,
    ) -> Result<Self, Error> {
        refuse_floating_root(joints, keys)?;
        let dynamics = Dynamics::new(robot.model(fidelity)?);
        if dynamics.model().bodies().iter().any(|b| b.is_elastic()) {
            robot.refuse_bending("the inverse of elastic joints", ELASTIC_AND_BENDING)?;
        }
        let remedy = "use references whose velocity does not jump";
        check_smoothness(joints, references, keys, |_| DERIVATIVES, remedy)?;
        let (nq, nv, n) = (dynamics.nq(), dynamics.nv(), dynamics.modes());
        let zeros = |n| vec![0.0; n];
        Ok(Self {
            joints: joints.clone(),
            q: zeros(nq),
            qd: zeros(nv),
            qdd: zeros(nv),
            tau: zeros(nv),
            tau_j: zeros(nv),
            etadd: zeros(n),
            dynamics,
        })
    }

    /// Goes to time 0, where the links are deflected as they hang at rest.
    ///
    /// # Errors
    /// No such deflection.
    pub fn start(&mut self, references: &References) -> Result<(), Error> {
        let n = self.joints.len();
        self.q[n..].fill(0.0);
        self.qd[n..].fill(0.0);
        self.look(references, 0.0);
        self.dynamics.settle(&mut self.q, External::none())
    }

    /// Torques and the modes' accelerations at time `t` [s].
    ///
    /// # Errors
    /// None but of arrays that do not fit.
    pub fn at(&mut self, references: &References, t: f64) -> Result<(), Error> {
        self.look(references, t);
        let state = State { q: &self.q, qd: &self.qd, theta: &self.q, thetad: &self.qd };
        let accel = Acceleration { qdd: &self.qdd, thetadd: &self.qdd };
        let out = Inverse { tau_j: &mut self.tau_j, tau: &mut self.tau };
        self.dynamics.hybrid(state, accel, External::none(), out, &mut self.etadd)
    }

    /// Moves the deflections on from time `t` by `step` [s]; the torques stay those of the last instant.
    ///
    /// # Errors
    /// As [`BendingInverse::at`].
    pub fn advance(&mut self, references: &References, t: f64, step: f64) -> Result<(), Error> {
        let (n, modes) = (self.joints.len(), self.etadd.len());
        let (eta, etad) = (self.q[n..].to_vec(), self.qd[n..].to_vec());
        let tau = self.tau.clone();
        let (mut shift, mut push) = (vec![0.0; modes], vec![0.0; modes]);
        // x ← x₀ + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄), each slope taken at x₀ + (0, ½, ½, 1) h k.
        for (now, reach, weight) in [(0.0, 0.5, 1.0), (0.5, 0.5, 2.0), (0.5, 1.0, 2.0), (1.0, 0.0, 1.0)] {
            self.at(references, t + now * step)?;
            for j in 0..modes {
                let (rate, acceleration) = (self.qd[n + j], self.etadd[j]);
                (shift[j], push[j]) = (shift[j] + weight * rate, push[j] + weight * acceleration);
                (self.q[n + j], self.qd[n + j]) = (eta[j] + reach * step * rate, etad[j] + reach * step * acceleration);
            }
        }
        for j in 0..modes {
            (self.q[n + j], self.qd[n + j]) = (eta[j] + step / 6.0 * shift[j], etad[j] + step / 6.0 * push[j]);
        }
        self.tau.copy_from_slice(&tau);
        Ok(())
    }

    /// Positions of joints and modes at the last instant: `nq` entries.
    pub fn q(&self) -> &[f64] {
        &self.q
    }

    /// Their velocities: `nv` entries.
    pub fn qd(&self) -> &[f64] {
        &self.qd
    }

    /// Motor torques there, reflected: `nv` entries, zero for the modes [N m or N].
    pub fn tau(&self) -> &[f64] {
        &self.tau
    }

    /// Places the joints.
    fn look(&mut self, references: &References, t: f64) {
        for (i, joint) in self.joints.joints.iter().enumerate() {
            let point = references.point(i, t);
            (self.q[joint.q], self.qd[joint.v], self.qdd[joint.v]) = (point.q, point.qd, point.qdd);
        }
    }
}
