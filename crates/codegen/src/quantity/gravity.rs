//! Gravity torques: the bias of a robot at rest.

use super::Options;
use super::bias::forces;
use super::tracing::{SymbolicState, traced, zeros};
use crate::function::Function;
use crate::robot::Robot;

/// `g(q)`.
pub(super) fn gravity(robot: &Robot, options: &Options) -> Function {
    traced("gravity_torques", "Generalised forces that hold the robot at rest against gravity.", |t| {
        let q = t.positions(robot);
        let records = t.records(robot, options).regrouped();
        let rest = || zeros(robot.nv());
        let [g, _] = forces(records, &SymbolicState { q, qd: rest(), theta: rest(), thetad: rest() });
        t.vector("g", &g, "gravity torques [N m or N]");
    })
}
