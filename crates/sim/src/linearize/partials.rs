//! How the accelerations, and the torques through the transmissions, change with state and torque.

use crate::dynamics::{Direction, Dynamics};
use crate::error::Error;
use crate::simulate::StateVec;
use gyroflex::dynamics::{
    Acceleration, DerivativeScratch, External, Forward, ForwardDerivatives, InverseDerivatives, derivative_matrix_len,
    forward_derivatives, inverse_derivatives,
};
use nalgebra::DMatrix;

/// Derivatives of one vector over the joints, each `nv × nv`: a row an entry of it, a column what it is derived by.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// By the link positions as small motions; a floating root's in its own frame, angular part first.
    pub q: DMatrix<f64>,
    /// By the link velocities.
    pub qd: DMatrix<f64>,
    /// By the reflected motor positions; zero where there is no elastic transmission.
    pub theta: DMatrix<f64>,
    /// By the reflected motor velocities; zero where there is no elastic transmission.
    pub thetad: DMatrix<f64>,
    /// By the reflected motor torques.
    pub tau: DMatrix<f64>,
}

impl Derivatives {
    /// The blocks of a matrix of `nv` rows and `5 nv` columns.
    fn split(all: &DMatrix<f64>) -> Self {
        let nv = all.nrows();
        let [q, qd, theta, thetad, tau] = [0, 1, 2, 3, 4].map(|block| all.columns(block * nv, nv).into_owned());
        Self { q, qd, theta, thetad, tau }
    }
}

/// Derivatives of forward dynamics.
#[derive(Clone, Debug, PartialEq)]
pub struct Partials {
    /// Of the link accelerations `q̈`.
    pub qdd: Derivatives,
    /// Of the reflected motor accelerations `θ̈`; where there is no elastic transmission they repeat those of `q̈`.
    pub thetadd: Derivatives,
    /// Of the torques that transmissions, rigid gears and ideal motors exert on the joints, `τ_J`.
    pub tau_j: Derivatives,
}

/// Derivatives of forward dynamics at a state and motor torques `tau` (`nv` entries).
///
/// Those of `τ_J` follow from inverse dynamics `τ_J(q, q̇, q̈, θ̇, θ̈)`, since both accelerations are functions of state and torque.
/// Where links bend, forward dynamics runs on numbers that carry their derivative, once per column.
///
/// # Errors
/// A slice that does not fit the model.
pub fn partials(dynamics: &Dynamics, state: &StateVec, tau: &[f64]) -> Result<Partials, Error> {
    if dynamics.modes() > 0 {
        return by_columns(&mut dynamics.clone(), state, tau);
    }
    let model = dynamics.model();
    let nv = model.nv();
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; nv]);
    let [mut d_qdd, mut d_thetadd] = [(); 2].map(|()| vec![0.0; 5 * nv * nv]);
    let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
    let mut matrix = vec![0.0; derivative_matrix_len(&model)];
    let value = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    let out = ForwardDerivatives { qdd: &mut d_qdd, thetadd: &mut d_thetadd };
    forward_derivatives(&model, state.view(), tau, External::none(), &mut scratch, &mut matrix, value, out)?;

    let [mut by_motion, mut unused] = [(); 2].map(|()| vec![0.0; 6 * nv * nv]);
    let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
    let out = InverseDerivatives { tau_j: &mut by_motion, tau: &mut unused };
    inverse_derivatives(&model, state.view(), accel, External::none(), &mut scratch, out)?;

    let rows = |entries: &[f64]| DMatrix::from_row_slice(nv, entries.len() / nv.max(1), entries);
    let (d_qdd, d_thetadd, by_motion) = (rows(&d_qdd), rows(&d_thetadd), rows(&by_motion));
    // Columns of inverse dynamics: q, q̇, q̈, θ, θ̇, θ̈.
    let block = |i: usize| by_motion.columns(i * nv, nv);
    let mut d_tau_j = block(2) * &d_qdd + block(5) * &d_thetadd;
    for (to, from) in [(0, 0), (1, 1), (2, 3), (3, 4)] {
        let mut columns = d_tau_j.columns_mut(to * nv, nv);
        columns += block(from);
    }
    Ok(Partials {
        qdd: Derivatives::split(&d_qdd),
        thetadd: Derivatives::split(&d_thetadd),
        tau_j: Derivatives::split(&d_tau_j),
    })
}

fn by_columns(dynamics: &mut Dynamics, state: &StateVec, tau: &[f64]) -> Result<Partials, Error> {
    let nv = dynamics.nv();
    let mut all = [(); 3].map(|()| DMatrix::zeros(nv, 5 * nv));
    let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; nv]);
    let blocks = [Direction::Q, Direction::Qd, Direction::Theta, Direction::Thetad, Direction::Tau];
    for (block, direction) in blocks.into_iter().enumerate() {
        for k in 0..nv {
            let out = [qdd.as_mut_slice(), thetadd.as_mut_slice(), tau_j.as_mut_slice()];
            dynamics.forward_slope(state.view(), tau, direction(k), out)?;
            for (matrix, column) in all.iter_mut().zip([&qdd, &thetadd, &tau_j]) {
                matrix.column_mut(block * nv + k).copy_from_slice(column);
            }
        }
    }
    let [qdd, thetadd, tau_j] = all.map(|matrix| Derivatives::split(&matrix));
    Ok(Partials { qdd, thetadd, tau_j })
}
