//! Forward dynamics, by whichever of two algorithms takes fewer operations.

use super::Options;
use super::bending::Storage;
use super::tracing::{Tracing, traced, zeros};
use crate::function::Function;
use crate::robot::{Records, Robot};
use crate::sym::Sym;
use gyroflex::dynamics::{
    AbaScratch, External, Forward, JointSpaceScratch, State, aba, flexible_aba, forward_in_joint_space,
};

/// Accelerations from state and motor torques.
pub(super) fn forward(robot: &Robot, options: &Options) -> Function {
    let by = |solve: fn(&Records, State<Sym>, &[Sym], Forward<Sym>)| by(robot, options, solve);
    if robot.flexible.is_some() {
        return by(bending);
    }
    let by_matrix = by(matrix);
    if robot.model.has_remote_rigid_rotor() {
        return by_matrix;
    }
    let by_aba = by(articulated);
    // The matrix has the shorter chains of operations that wait for each other: a tenth more of them is worth it.
    let (aba, matrix) = (by_aba.operations().total(), by_matrix.operations().total());
    if 10 * matrix <= 11 * aba { by_matrix } else { by_aba }
}

fn by(robot: &Robot, options: &Options, solve: fn(&Records, State<Sym>, &[Sym], Forward<Sym>)) -> Function {
    let meaning = "Accelerations of joints and motors from state and motor torques.";
    traced("forward_dynamics", meaning, |t: &mut Tracing| {
        let nv = robot.nv();
        let state = t.state(robot);
        let tau = t.argument("tau", nv, "motor torques, reflected [N m or N]");
        let records = t.records(robot, options).regrouped();
        let (mut qdd, mut thetadd, mut tau_j) = (zeros(nv), zeros(nv), zeros(nv));
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        solve(&records, state.view(), &tau, out);
        t.vector("qdd", &qdd, "joint accelerations [rad/s² or m/s²]");
        if robot.is_elastic() {
            t.vector("thetadd", &thetadd, "motor accelerations, reflected [rad/s² or m/s²]");
        }
        t.vector("tau_j", &tau_j, "torque of each transmission, gear or motor on its joint [N m or N]");
    })
}

fn matrix(records: &Records, state: State<Sym>, tau: &[Sym], out: Forward<Sym>) {
    let model = records.view();
    let mut scratch = vec![JointSpaceScratch::new(); model.bodies().len()];
    let mut matrix = zeros(model.nv() * model.nv());
    forward_in_joint_space(&model, state, tau, External::none(), &mut scratch, &mut matrix, out)
        .expect("lengths are the model's");
}

fn articulated(records: &Records, state: State<Sym>, tau: &[Sym], out: Forward<Sym>) {
    let model = records.view();
    let mut scratch = vec![AbaScratch::new(); model.bodies().len()];
    aba(&model, state, tau, External::none(), &mut scratch, out).expect("lengths are the model's");
}

fn bending(records: &Records, state: State<Sym>, tau: &[Sym], out: Forward<Sym>) {
    let Some(model) = records.flexible() else { return };
    let mut storage = Storage::of(&model);
    flexible_aba(&model, state, tau, External::none(), storage.lend(), out).expect("lengths are the model's");
}
