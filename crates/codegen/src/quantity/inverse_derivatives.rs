//! Derivatives of inverse dynamics.

use super::Options;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::Robot;
use gyroflex::dynamics::{Acceleration, DerivativeScratch, External, InverseDerivatives};

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
        let (mut dtau_j, mut dtau) = (zeros(6 * nv * nv), zeros(6 * nv * nv));
        let mut scratch = vec![DerivativeScratch::new(); records.view().bodies().len()];
        let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
        let out = InverseDerivatives { tau_j: &mut dtau_j, tau: &mut dtau };
        gyroflex::dynamics::inverse_derivatives(
            &records.view(),
            state.view(),
            accel,
            External::none(),
            &mut scratch,
            out,
        )
        .expect("lengths are the model's");
        t.matrix("dtau_j", &dtau_j, 6 * nv, &format!("of the torques on the joints, {BLOCKS}"));
        t.matrix("dtau", &dtau, 6 * nv, &format!("of the motor torques, {BLOCKS}"));
    })
}
