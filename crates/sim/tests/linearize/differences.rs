//! Derivatives of forward dynamics by central differences of fourth order: the oracle of the analytical ones.

use gyroflex::dynamics::{External, Forward};
use gyroflex::integrate::integrate;
use gyroflex_sim::Dynamics;
use gyroflex_sim::simulate::StateVec;
use nalgebra::DMatrix;

/// What to derive by, and the step.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Argument {
    Q,
    Qd,
    Theta,
    Thetad,
    Tau,
}

/// Small against the waves of the transmission error and against one.
const STEP: f64 = 1e-5;

/// Derivatives of `q̈`, `θ̈` and `τ_J`, `nv × nv` each: `f' = (8 (f(h) − f(−h)) − (f(2h) − f(−2h))) / 12 h`.
pub(crate) fn differences(
    dynamics: &mut Dynamics,
    state: &StateVec,
    tau: &[f64],
    argument: Argument,
) -> [DMatrix<f64>; 3] {
    let nv = dynamics.nv();
    let mut sums = [(); 3].map(|()| DMatrix::zeros(nv, nv));
    for column in 0..nv {
        for (reach, weight) in [(1.0, 8.0), (-1.0, -8.0), (2.0, -1.0), (-2.0, 1.0)] {
            let (mut state, mut tau, step) = (state.clone(), tau.to_vec(), reach * STEP);
            match argument {
                Argument::Q => {
                    let (from, mut shift) = (state.q.clone(), vec![0.0; nv]);
                    shift[column] = step;
                    integrate(&dynamics.model(), &from, &shift, &mut state.q).expect("slices fit");
                }
                Argument::Qd => state.qd[column] += step,
                Argument::Theta => state.theta[column] += step,
                Argument::Thetad => state.thetad[column] += step,
                Argument::Tau => tau[column] += step,
            }
            let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; nv]);
            let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
            dynamics.forward(state.view(), &tau, External::none(), out).expect("slices fit");
            for (sum, values) in sums.iter_mut().zip([qdd, thetadd, tau_j]) {
                values.iter().enumerate().for_each(|(row, f)| sum[(row, column)] += weight * f / (12.0 * STEP));
            }
        }
    }
    sums
}
