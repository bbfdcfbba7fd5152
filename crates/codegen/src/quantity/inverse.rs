//! Inverse dynamics.

use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::{Records, Robot};
use gyroflex::dynamics::{Acceleration, External, Inverse, RneaScratch, rnea};

/// Torques that make the robot accelerate as asked.
pub(super) fn inverse(robot: &Robot) -> Function {
    traced("inverse_dynamics", "Torques that make the robot accelerate as asked.", |t| {
        let records = Records::of(&robot.model).regrouped();
        let (model, nv) = (records.view(), robot.nv());
        let state = t.state(robot);
        let qdd = t.argument("qdd", nv, "joint accelerations [rad/s² or m/s²]");
        let thetadd = t.of_motors(robot, "thetadd", "motor accelerations, reflected [rad/s² or m/s²]");
        let (mut tau_j, mut tau) = (zeros(nv), zeros(nv));
        let mut scratch = vec![RneaScratch::new(); model.bodies().len()];
        let accel = Acceleration { qdd: &qdd, thetadd: &thetadd };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        rnea(&model, state.view(), accel, External::none(), &mut scratch, out).expect("lengths are the model's");
        t.vector("tau_j", &tau_j, "torque on each joint [N m or N]");
        t.vector("tau", &tau, "torque of each motor, reflected [N m or N]");
    })
}
