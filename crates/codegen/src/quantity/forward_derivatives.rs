//! Derivatives of forward dynamics.

use super::Options;
use super::bending::forward_partials;
use super::tracing::{SymbolicState, traced, zeros};
use crate::function::Function;
use crate::robot::{Records, Robot};
use crate::sym::Sym;
use gyroflex::dynamics::{
    DerivativeScratch, External, Forward, ForwardDerivatives, derivative_matrix_len, forward_derivatives as derivatives,
};

const BLOCKS: &str =
    "nv columns each by q, qd, theta, thetad, tau; a floating root's pose by a small motion in its own frame";

/// `∂q̈` and `∂θ̈`.
pub(super) fn forward_derivatives(robot: &Robot, options: &Options) -> Function {
    traced("forward_derivatives", "Derivatives of the accelerations by state and motor torques.", |t| {
        let nv = robot.nv();
        let state = t.state(robot);
        let tau = t.argument("tau", nv, "motor torques, reflected [N m or N]");
        let records = t.records(robot, options).regrouped();
        let [dqdd, dthetadd] = partials(&records, &state, &tau);
        t.matrix("dqdd", &dqdd, 5 * nv, &format!("of the joint accelerations, {BLOCKS}"));
        if robot.is_elastic() {
            t.matrix("dthetadd", &dthetadd, 5 * nv, &format!("of the motor accelerations, {BLOCKS}"));
        }
    })
}

/// `∂q̈` and `∂θ̈`, `nv` rows of five blocks.
pub(super) fn partials(records: &Records, state: &SymbolicState, tau: &[Sym]) -> [Vec<Sym>; 2] {
    if let Some(model) = records.flexible() {
        return forward_partials(&model, state, tau);
    }
    let (model, nv) = (records.view(), tau.len());
    let (mut dqdd, mut dthetadd) = (zeros(5 * nv * nv), zeros(5 * nv * nv));
    let (mut qdd, mut thetadd, mut tau_j) = (zeros(nv), zeros(nv), zeros(nv));
    let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
    let mut matrix = zeros(derivative_matrix_len(&model));
    let value = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
    let out = ForwardDerivatives { qdd: &mut dqdd, thetadd: &mut dthetadd };
    derivatives(&model, state.view(), tau, External::none(), &mut scratch, &mut matrix, value, out)
        .expect("lengths are the model's");
    [dqdd, dthetadd]
}
