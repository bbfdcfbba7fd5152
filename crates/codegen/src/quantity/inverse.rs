//! Inverse dynamics.

use super::Options;
use super::bending::Storage;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::{Records, Robot};
use crate::sym::Sym;
use gyroflex::dynamics::{Acceleration, External, Inverse, RneaScratch, State, flexible_rnea, rnea};

/// Torques that make the robot accelerate as asked.
pub(super) fn inverse(robot: &Robot, options: &Options) -> Function {
    traced("inverse_dynamics", "Torques that make the robot accelerate as asked.", |t| {
        let state = t.state(robot);
        let qdd = t.argument("qdd", robot.nv(), "joint accelerations [rad/s² or m/s²]");
        let thetadd = t.of_motors(robot, "thetadd", "motor accelerations, reflected [rad/s² or m/s²]");
        let records = t.records(robot, options).regrouped();
        let [tau_j, tau] = torques(&records, state.view(), Acceleration { qdd: &qdd, thetadd: &thetadd });
        t.vector("tau_j", &tau_j, "torque on each joint [N m or N]");
        t.vector("tau", &tau, "torque of each motor, reflected [N m or N]");
    })
}

/// `τ_J` and `τ`.
pub(super) fn torques(records: &Records, state: State<Sym>, accel: Acceleration<Sym>) -> [Vec<Sym>; 2] {
    let nv = state.qd.len();
    let (mut tau_j, mut tau) = (zeros(nv), zeros(nv));
    let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
    match records.flexible() {
        Some(model) => flexible_rnea(&model, state, accel, External::none(), Storage::of(&model).lend(), out),
        None => {
            let mut scratch = vec![RneaScratch::new(); records.view().bodies().len()];
            rnea(&records.view(), state, accel, External::none(), &mut scratch, out)
        }
    }
    .expect("lengths are the model's");
    [tau_j, tau]
}
