//! Derivatives of forward dynamics by central differences of fourth order.

use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::simulate::StateVec;
use gyroflex::dynamics::{External, Forward};
use gyroflex::integrate::integrate;
use gyroflex::model::Model;

/// What to derive by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    /// Link positions.
    Q,
    /// Link velocities.
    Qd,
    /// Reflected motor positions.
    Theta,
    /// Reflected motor velocities.
    Thetad,
    /// Reflected motor torques.
    Tau,
}

/// Derivatives of all that forward dynamics gives by one argument, `nv × nv` by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Differences {
    /// Of the link accelerations.
    pub qdd: Vec<f64>,
    /// Of the reflected motor accelerations.
    pub thetadd: Vec<f64>,
    /// Of the torques through the transmissions.
    pub tau_j: Vec<f64>,
}

/// Derivatives by one argument at a state and motor torques `tau` (`nv` entries):
/// `f' = (8 (f(h) − f(−h)) − (f(2h) − f(−2h))) / 12 h`, exact for polynomials of degree four.
///
/// # Errors
/// A slice that does not fit the model.
pub fn differences(
    dynamics: &mut Dynamics,
    state: &StateVec,
    tau: &[f64],
    argument: Argument,
) -> Result<Differences, Error> {
    let nv = dynamics.nv();
    let step = step(&dynamics.model(), argument);
    let zeros = || vec![0.0; nv * nv];
    let mut sum = Differences { qdd: zeros(), thetadd: zeros(), tau_j: zeros() };
    let (mut qdd, mut thetadd, mut tau_j) = (vec![0.0; nv], vec![0.0; nv], vec![0.0; nv]);
    let mut shift = vec![0.0; nv];
    for column in 0..nv {
        for (reach, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
            let (mut state, mut tau) = (state.clone(), tau.to_vec());
            shift[column] = reach * step;
            match argument {
                Argument::Q => {
                    let mut moved = state.q.clone();
                    integrate(&dynamics.model(), &state.q, &shift, &mut moved)?;
                    state.q = moved;
                }
                Argument::Qd => state.qd[column] += shift[column],
                Argument::Theta => state.theta[column] += shift[column],
                Argument::Thetad => state.thetad[column] += shift[column],
                Argument::Tau => tau[column] += shift[column],
            }
            shift[column] = 0.0;
            let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
            dynamics.forward(state.view(), &tau, External::none(), out)?;
            let weight = weight / (12.0 * step);
            for (sum, f) in [(&mut sum.qdd, &qdd), (&mut sum.thetadd, &thetadd), (&mut sum.tau_j, &tau_j)] {
                f.iter().enumerate().for_each(|(row, f)| sum[row * nv + column] += weight * f);
            }
        }
    }
    Ok(sum)
}

/// A step small against the shortest length over which the laws of the drives bend.
fn step(model: &Model<f64>, argument: Argument) -> f64 {
    let drives = || model.bodies().iter().filter_map(|b| b.drive.as_ref());
    let shortest = |lengths: &mut dyn Iterator<Item = f64>| lengths.fold(0.1_f64, f64::min);
    match argument {
        Argument::Tau => 1.0,
        Argument::Q | Argument::Theta => {
            let waves = drives().filter_map(|d| {
                let error = d.elastic.as_ref()?.error.as_ref()?;
                Some(1.0 / (error.cycles_per_rotor_turn * d.rotor.gear_ratio).abs())
            });
            1e-3 * shortest(&mut waves.filter(|x| x.is_finite()))
        }
        Argument::Qd | Argument::Thetad => {
            let links = model.bodies().iter().map(|b| (&b.friction, 1.0));
            let motors = drives().map(|d| (&d.rotor.friction, d.rotor.gear_ratio.abs()));
            let bends = links.chain(motors).filter(|(f, _)| f.dry);
            1e-3 * shortest(&mut bends.map(|(f, ratio)| f.smoothing_velocity.min(f.stribeck_velocity) / ratio))
        }
    }
}
