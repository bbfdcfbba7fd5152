//! Forward dynamics, by whichever of two algorithms takes fewer operations.

use super::tracing::{Tracing, traced, zeros};
use crate::function::Function;
use crate::robot::{Records, Robot};
use crate::sym::Sym;
use gyroflex::dynamics::{AbaScratch, External, Forward, JointSpaceScratch, State, aba, forward_in_joint_space};
use gyroflex::model::Model;

/// Accelerations from state and motor torques.
pub(super) fn forward(robot: &Robot) -> Function {
    let by_matrix = by(robot, |model, state, tau, out| {
        let mut scratch = vec![JointSpaceScratch::new(); model.bodies().len()];
        let mut matrix = zeros(model.nv() * model.nv());
        forward_in_joint_space(model, state, tau, External::none(), &mut scratch, &mut matrix, out)
            .expect("lengths are the model's");
    });
    if robot.model.has_remote_rigid_rotor() {
        return by_matrix;
    }
    let by_aba = by(robot, |model, state, tau, out| {
        let mut scratch = vec![AbaScratch::new(); model.bodies().len()];
        aba(model, state, tau, External::none(), &mut scratch, out).expect("lengths are the model's");
    });
    // The matrix has the shorter chains of operations that wait for each other: a tenth more of them is worth it.
    let (aba, matrix) = (by_aba.operations().total(), by_matrix.operations().total());
    if 10 * matrix <= 11 * aba { by_matrix } else { by_aba }
}

fn by(robot: &Robot, solve: impl FnOnce(&Model<Sym>, State<Sym>, &[Sym], Forward<Sym>)) -> Function {
    let meaning = "Accelerations of joints and motors from state and motor torques.";
    traced("forward_dynamics", meaning, |t: &mut Tracing| {
        let records = Records::of(&robot.model).regrouped();
        let (model, nv) = (records.view(), robot.nv());
        let state = t.state(robot);
        let tau = t.argument("tau", nv, "motor torques, reflected [N m or N]");
        let (mut qdd, mut thetadd, mut tau_j) = (zeros(nv), zeros(nv), zeros(nv));
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        solve(&model, state.view(), &tau, out);
        t.vector("qdd", &qdd, "joint accelerations [rad/s² or m/s²]");
        if robot.is_elastic() {
            t.vector("thetadd", &thetadd, "motor accelerations, reflected [rad/s² or m/s²]");
        }
        t.vector("tau_j", &tau_j, "torque of each transmission, gear or motor on its joint [N m or N]");
    })
}
