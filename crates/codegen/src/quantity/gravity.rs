//! Gravity torques.

use super::Options;
use super::inverse::torques;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::Robot;
use gyroflex::dynamics::{Acceleration, DerivativeScratch, State, gravity_torques};

/// `g(q)`.
pub(super) fn gravity(robot: &Robot, options: &Options) -> Function {
    traced("gravity_torques", "Generalised forces that hold the robot at rest against gravity.", |t| {
        let q = t.positions(robot);
        let records = t.records(robot, options).regrouped();
        let rest = zeros(robot.nv());
        let g = if robot.flexible.is_some() {
            let state = State { q: &q, qd: &rest, theta: &rest, thetad: &rest };
            let [g, _] = torques(&records.frictionless(), state, Acceleration { qdd: &rest, thetadd: &rest });
            g
        } else {
            let mut g = rest;
            let mut scratch = vec![DerivativeScratch::new(); records.view().bodies().len()];
            gravity_torques(&records.view(), &q, &mut scratch, &mut g).expect("lengths are the model's");
            g
        };
        t.vector("g", &g, "gravity torques [N m or N]");
    })
}
