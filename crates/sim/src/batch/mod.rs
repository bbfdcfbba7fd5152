//! Many states of one robot at once: side by side in the lanes of the processor, and on all its cores.
//!
//! Arrays are row-major, one state a row: `q` has `nq` columns, everything else `nv`.

mod rows;

use crate::error::Error;
use crate::robot::OwnedModel;
use gyroflex::Lanes;
use gyroflex::dynamics::{
    self, AbaScratch, Acceleration, External, Forward, ForwardScratch, Inverse, RneaScratch, State,
};
use gyroflex::dynamics::{JointSpaceScratch, joint_space_len, matrix_len};
use gyroflex::model::Model;
use rayon::prelude::*;
use rows::{Rows, RowsMut, gather, scatter};

/// States side by side in one call: eight `f64` fill a register of AVX-512, or two of AVX2.
pub const LANES: usize = 8;
/// Rows that one task takes: enough to hide what handing it out costs, few enough to keep all cores busy to the end.
const TASK: usize = 32 * LANES;

type Wide = Lanes<f64, LANES>;

/// States of forward dynamics: positions, velocities and motor torques, one state a row.
#[derive(Clone, Copy, Debug)]
pub struct ForwardBatch<'a> {
    /// Joint positions, `nq` columns.
    pub q: &'a [f64],
    /// Joint velocities.
    pub qd: &'a [f64],
    /// Reflected motor positions.
    pub theta: &'a [f64],
    /// Reflected motor velocities.
    pub thetad: &'a [f64],
    /// Reflected motor torques.
    pub tau: &'a [f64],
}

/// States of inverse dynamics: positions, velocities and the accelerations asked for, one state a row.
#[derive(Clone, Copy, Debug)]
pub struct InverseBatch<'a> {
    /// Joint positions, `nq` columns.
    pub q: &'a [f64],
    /// Joint velocities.
    pub qd: &'a [f64],
    /// Reflected motor positions.
    pub theta: &'a [f64],
    /// Reflected motor velocities.
    pub thetad: &'a [f64],
    /// Joint accelerations.
    pub qdd: &'a [f64],
    /// Reflected motor accelerations.
    pub thetadd: &'a [f64],
}

/// Forward dynamics of every row, as [`dynamics::forward_dynamics`] without external loads: writes `qdd`, `thetadd` and
/// `tau_j`, `nv` columns each.
///
/// # Errors
/// An array whose length is not the same number of rows as the others'.
pub fn forward(model: &OwnedModel, given: ForwardBatch, out: Forward<f64>) -> Result<(), Error> {
    model.refuse_bending("a batch of states")?;
    let model = &model.view();
    let (nq, nv) = (model.nq(), model.nv());
    let rows = rows::count("q", given.q, nq)?;
    let of = |name, all| Rows::new(name, all, nv, rows);
    let states = [of("qd", given.qd)?, of("theta", given.theta)?, of("thetad", given.thetad)?, of("tau", given.tau)?];
    let q = Rows::new("q", given.q, nq, rows)?;
    let qdd = RowsMut::tasks("qdd", out.qdd, nv, rows, TASK)?;
    let thetadd = RowsMut::tasks("thetadd", out.thetadd, nv, rows, TASK)?;
    let tau_j = RowsMut::tasks("tau_j", out.tau_j, nv, rows, TASK)?;
    (qdd, thetadd, tau_j).into_par_iter().enumerate().try_for_each_init(
        || ForwardWork::new(model),
        |work, (task, (qdd, thetadd, tau_j))| {
            for start in (0..qdd.len() / nv.max(1)).step_by(LANES) {
                let row = task * TASK + start;
                work.load(q, states, row);
                work.run(model)?;
                scatter(&work.out[0], qdd, start, nv);
                scatter(&work.out[1], thetadd, start, nv);
                scatter(&work.out[2], tau_j, start, nv);
            }
            Ok(())
        },
    )
}

/// Inverse dynamics of every row, as [`dynamics::rnea`] without external loads: writes `tau_j` and `tau`, `nv` columns each.
///
/// # Errors
/// An array whose length is not the same number of rows as the others'.
pub fn inverse(model: &OwnedModel, given: InverseBatch, out: Inverse<f64>) -> Result<(), Error> {
    model.refuse_bending("a batch of states")?;
    let model = &model.view();
    let (nq, nv) = (model.nq(), model.nv());
    let rows = rows::count("q", given.q, nq)?;
    let of = |name, all| Rows::new(name, all, nv, rows);
    let states = [of("qd", given.qd)?, of("theta", given.theta)?, of("thetad", given.thetad)?];
    let accelerations = [of("qdd", given.qdd)?, of("thetadd", given.thetadd)?];
    let q = Rows::new("q", given.q, nq, rows)?;
    let tau_j = RowsMut::tasks("tau_j", out.tau_j, nv, rows, TASK)?;
    let tau = RowsMut::tasks("tau", out.tau, nv, rows, TASK)?;
    (tau_j, tau).into_par_iter().enumerate().try_for_each_init(
        || InverseWork::new(model),
        |work, (task, (tau_j, tau))| {
            for start in (0..tau.len() / nv.max(1)).step_by(LANES) {
                let row = task * TASK + start;
                work.load(q, states, accelerations, row);
                work.run(model)?;
                scatter(&work.tau_j, tau_j, start, nv);
                scatter(&work.tau, tau, start, nv);
            }
            Ok(())
        },
    )
}

/// What one thread needs for forward dynamics.
struct ForwardWork {
    q: Vec<Wide>,
    /// `qd`, `theta`, `thetad`, `tau`.
    states: [Vec<Wide>; 4],
    aba: Vec<AbaScratch<Wide>>,
    joint_space: Vec<JointSpaceScratch<Wide>>,
    matrix: Vec<Wide>,
    /// `qdd`, `thetadd`, `tau_j`.
    out: [Vec<Wide>; 3],
}

impl ForwardWork {
    fn new(model: &Model<f64>) -> Self {
        let zero = vec![Wide::splat(0.0); model.nv()];
        Self {
            q: vec![Wide::splat(0.0); model.nq()],
            states: core::array::from_fn(|_| zero.clone()),
            aba: vec![AbaScratch::new(); model.bodies().len()],
            joint_space: vec![JointSpaceScratch::new(); joint_space_len(model)],
            matrix: vec![Wide::splat(0.0); matrix_len(model)],
            out: core::array::from_fn(|_| zero.clone()),
        }
    }

    fn load(&mut self, q: Rows, states: [Rows; 4], row: usize) {
        gather(q, row, &mut self.q);
        for (to, from) in self.states.iter_mut().zip(states) {
            gather(from, row, to);
        }
    }

    fn run(&mut self, model: &Model<f64>) -> Result<(), Error> {
        let [qd, theta, thetad, tau] = &self.states;
        let [qdd, thetadd, tau_j] = &mut self.out;
        let scratch =
            ForwardScratch { bodies: &mut self.aba, joint_space: &mut self.joint_space, matrix: &mut self.matrix };
        let state = State { q: &self.q, qd, theta, thetad };
        let out = Forward { qdd, thetadd, tau_j };
        Ok(dynamics::forward_dynamics(model, state, tau, External::none(), scratch, out)?)
    }
}

/// What one thread needs for inverse dynamics.
struct InverseWork {
    q: Vec<Wide>,
    /// `qd`, `theta`, `thetad`.
    states: [Vec<Wide>; 3],
    /// `qdd`, `thetadd`.
    accelerations: [Vec<Wide>; 2],
    scratch: Vec<RneaScratch<Wide>>,
    tau_j: Vec<Wide>,
    tau: Vec<Wide>,
}

impl InverseWork {
    fn new(model: &Model<f64>) -> Self {
        let zero = vec![Wide::splat(0.0); model.nv()];
        Self {
            q: vec![Wide::splat(0.0); model.nq()],
            states: core::array::from_fn(|_| zero.clone()),
            accelerations: core::array::from_fn(|_| zero.clone()),
            scratch: vec![RneaScratch::new(); model.bodies().len()],
            tau_j: zero.clone(),
            tau: zero,
        }
    }

    fn load(&mut self, q: Rows, states: [Rows; 3], accelerations: [Rows; 2], row: usize) {
        gather(q, row, &mut self.q);
        let to = self.states.iter_mut().chain(&mut self.accelerations);
        for (to, from) in to.zip(states.into_iter().chain(accelerations)) {
            gather(from, row, to);
        }
    }

    fn run(&mut self, model: &Model<f64>) -> Result<(), Error> {
        let ([qd, theta, thetad], [qdd, thetadd]) = (&self.states, &self.accelerations);
        let state = State { q: &self.q, qd, theta, thetad };
        let out = Inverse { tau_j: &mut self.tau_j, tau: &mut self.tau };
        let accel = Acceleration { qdd, thetadd };
        Ok(dynamics::rnea(model, state, accel, External::none(), &mut self.scratch, out)?)
    }
}
