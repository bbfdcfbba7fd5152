//! Derivatives of inverse dynamics.

use super::Options;
use super::bending::inverse_partials;
use super::tracing::{SymbolicState, traced, zeros};
use crate::function::Function;
use crate::robot::{Records, Robot};
use crate::sym::Sym;
use gyroflex::dynamics::{
    Acceleration, DerivativeScratch, External, InverseDerivatives, inverse_derivatives as derivatives,
};

const BLOCKS: &str =
    "nv columns each by q, qd, qdd, theta, thetad, thetadd; a floating root's pose by a small motion in its own frame";

/// `∂τ_J` and `∂τ`.
pub(super) fn inverse_derivatives(robot: &Robot, options: &Options) -> Function {
    traced("inverse_derivatives", "Derivatives of the torques by the motion.", |t| {
        let nv = robot.nv();
        let state = t.state(robot);
        let qdd = t.argument("qdd", nv, "joint accelerations [rad/s² or m/s²]");
        let thetadd = t.of_motors(robot, "thetadd", "motor accelerations, reflected [rad/s² or m/s²]");
        let records = t.records(robot, options).regrouped();
        let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
        let [dtau_j, dtau] = match records.flexible() {
            Some(model) => inverse_partials(&model, &state, accel),
            None => partials(&records, &state, accel),
        };
        t.matrix("dtau_j", &dtau_j, 6 * nv, &format!("of the torques on the joints, {BLOCKS}"));
        t.matrix("dtau", &dtau, 6 * nv, &format!("of the motor torques, {BLOCKS}"));
    })
}

/// `∂τ_J` and `∂τ`, `nv` rows of six blocks.
fn partials(records: &Records, state: &SymbolicState, accel: Acceleration<Sym>) -> [Vec<Sym>; 2] {
    let (model, len) = (records.view(), 6 * state.qd.len() * state.qd.len());
    let (mut dtau_j, mut dtau) = (zeros(len), zeros(len));
    let mut scratch = vec![DerivativeScratch::new(); model.bodies().len()];
    let out = InverseDerivatives { tau_j: &mut dtau_j, tau: &mut dtau };
    derivatives(&model, state.view(), accel, External::none(), &mut scratch, out).expect("lengths are the model's");
    [dtau_j, dtau]
}
