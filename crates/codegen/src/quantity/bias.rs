//! Forces of velocity and gravity: inverse dynamics without acceleration of a robot that has nothing but inertia.
//!
//! That takes half the operations of the core's `bias`, whose walk leaves at the base what its matrices need.

use super::Options;
use super::inverse::torques;
use super::tracing::{SymbolicState, traced, zeros};
use crate::function::Function;
use crate::robot::{Records, Robot};
use crate::sym::Sym;
use gyroflex::dynamics::Acceleration;
use gyroflex::model::Body;

/// `C q̇ + C₁ θ̇ + g` and `C₂ q̇`.
pub(super) fn bias(robot: &Robot, options: &Options) -> Function {
    let meaning = "What links and motors need to go on without acceleration, besides friction, springs and dampers.";
    traced("bias_forces", meaning, |t| {
        let state = t.moving(robot);
        let records = t.records(robot, options).regrouped();
        let [link, motor] = forces(records, &state);
        t.vector("link", &link, "on the link side, with gravity [N m or N]");
        if robot.is_elastic() {
            t.vector("motor", &motor, "on the motors, reflected [N m or N]");
        }
    })
}

/// Of links and motors. The motor of an elastic joint bears what its rotor needs beside the transmission's torque, that of a rigid
/// gear is one with the link.
pub(super) fn forces(records: Records, state: &SymbolicState) -> [Vec<Sym>; 2] {
    let rest = zeros(state.qd.len());
    let records = records.frictionless();
    let [mut link, tau] = torques(&records, state.view(), Acceleration { qdd: &rest, thetadd: &rest });
    let mut motor = rest;
    for body in records.view().bodies().iter().filter(|body| body.joint.nv() == 1) {
        let k = body.v_index();
        match Body::is_elastic(body) {
            true => motor[k] = tau[k] - link[k],
            false => link[k] = tau[k],
        }
    }
    [link, motor]
}
