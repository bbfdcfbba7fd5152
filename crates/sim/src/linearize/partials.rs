//! How the accelerations change with state and torque.

use super::differences::{Argument, differences};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::simulate::StateVec;

/// Derivatives of one vector of accelerations, each `nv × nv` by rows: a row an acceleration, a column what it is derived by.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// By the link positions as small motions; a floating root's in its own frame, angular part first.
    pub q: Vec<f64>,
    /// By the link velocities.
    pub qd: Vec<f64>,
    /// By the reflected motor positions; zero where there is no elastic transmission.
    pub theta: Vec<f64>,
    /// By the reflected motor velocities; zero where there is no elastic transmission.
    pub thetad: Vec<f64>,
    /// By the reflected motor torques.
    pub tau: Vec<f64>,
}

/// Derivatives of forward dynamics.
#[derive(Clone, Debug, PartialEq)]
pub struct Partials {
    /// Of the link accelerations `q̈`.
    pub qdd: Derivatives,
    /// Of the reflected motor accelerations `θ̈`; where there is no elastic transmission they repeat those of `q̈`.
    pub thetadd: Derivatives,
}

/// Derivatives of forward dynamics at a state and motor torques `tau` (`nv` entries).
///
/// # Errors
/// A slice that does not fit the model.
pub fn partials(dynamics: &mut Dynamics, state: &StateVec, tau: &[f64]) -> Result<Partials, Error> {
    let mut by = |argument| differences(dynamics, state, tau, argument);
    let (q, qd) = (by(Argument::Q)?, by(Argument::Qd)?);
    let (theta, thetad, tau) = (by(Argument::Theta)?, by(Argument::Thetad)?, by(Argument::Tau)?);
    Ok(Partials {
        qdd: Derivatives { q: q.qdd, qd: qd.qdd, theta: theta.qdd, thetad: thetad.qdd, tau: tau.qdd },
        thetadd: Derivatives {
            q: q.thetadd,
            qd: qd.thetadd,
            theta: theta.thetadd,
            thetad: thetad.thetadd,
            tau: tau.thetadd,
        },
    })
}
