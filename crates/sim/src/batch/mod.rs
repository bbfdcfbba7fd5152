//! Many states of one robot at once: side by side in the lanes of the processor, and on all its cores.
//!
//! Arrays are row-major, one state a row: `q` has `nq` columns, everything else `nv`. An array of a single row stands for all.

mod algorithm;
mod real;
mod rollout;
mod rows;
mod work;

pub use algorithm::Algorithm;
pub use real::Real;
pub use rollout::{Rollout, Scheme, Trajectories, rollout};

use crate::error::Error;
use crate::robot::OwnedModel;
use gyroflex::dynamics::{Forward, Inverse};
use gyroflex::model::SizeError;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::LazyLock;
use work::Work;

/// Lanes that one task takes one after the other: enough to hide what handing it out costs, few enough to keep all cores busy to
/// the end.
const GROUPS: usize = 32;

/// What an algorithm reads, one state a row or one for all; what is left empty is zero.
#[derive(Clone, Copy, Debug, Default)]
pub struct Given<'a, F> {
    /// Joint positions, `nq` columns.
    pub q: &'a [F],
    /// Joint velocities.
    pub qd: &'a [F],
    /// Reflected motor positions.
    pub theta: &'a [F],
    /// Reflected motor velocities.
    pub thetad: &'a [F],
    /// Joint accelerations.
    pub qdd: &'a [F],
    /// Reflected motor accelerations.
    pub thetadd: &'a [F],
    /// Reflected motor torques.
    pub tau: &'a [F],
    /// Further generalised forces on the link side.
    pub tau_ext: &'a [F],
}

/// Runs an algorithm over so many rows, and writes the first of its results, as many as `out` has, each with the columns that
/// [`Algorithm::columns`] says.
///
/// # Errors
/// An array that has neither one row nor as many as asked for, or a robot with links that bend.
pub fn evaluate<F: Real>(
    model: &OwnedModel,
    algorithm: Algorithm,
    rows: usize,
    given: Given<F>,
    out: &mut [&mut [F]],
) -> Result<(), Error> {
    model.refuse_bending("a batch of states")?;
    let records = model.cast::<F>();
    let model = &records.view();
    rows::check(model, rows, &given)?;
    let columns = algorithm.columns(model.nv());
    let task = GROUPS * F::LANES;
    let mut tasks: Vec<Vec<&mut [F]>> = (0..rows.div_ceil(task)).map(|_| Vec::new()).collect();
    for (out, columns) in out.iter_mut().zip(&columns) {
        SizeError::check("out", out.len(), rows * columns)?;
        for (task, rows) in tasks.iter_mut().zip(out.chunks_mut(task * columns.max(&1))) {
            task.push(rows);
        }
    }
    let run = |work: &mut Work<F::Lanes>, (index, mut out): (usize, Vec<&mut [F]>)| {
        let first = index * task;
        for row in (first..rows.min(first + task)).step_by(F::LANES) {
            rows::load(given, row, work);
            algorithm.run(model, work)?;
            for (to, (from, columns)) in out.iter_mut().zip(work.out.iter().zip(&columns)) {
                rows::scatter(&from[..*columns], to, row - first);
            }
        }
        Ok(())
    };
    in_parallel(tasks, || Work::new(model), run)
}

/// Runs tasks on all cores; a single one in the calling thread, which is faster than waking another.
fn in_parallel<T: Send, W>(
    tasks: Vec<T>,
    work: impl Fn() -> W + Sync + Send,
    run: impl Fn(&mut W, (usize, T)) -> Result<(), Error> + Sync + Send,
) -> Result<(), Error> {
    if tasks.len() <= 1 {
        return tasks.into_iter().enumerate().try_for_each(|task| run(&mut work(), task));
    }
    POOL.install(|| tasks.into_par_iter().enumerate().try_for_each_init(work, run))
}

/// Unoptimised builds keep all intermediate lanes on the stack, which is more than a thread has by default.
const STACK: usize = 32 << 20;

/// One thread for each core, or `RAYON_NUM_THREADS`.
static POOL: LazyLock<ThreadPool> =
    LazyLock::new(|| ThreadPoolBuilder::new().stack_size(STACK).build().expect("the system has threads"));

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

/// Forward dynamics of every row, as [`gyroflex::dynamics::forward_dynamics`] without external loads: writes `qdd`, `thetadd` and
/// `tau_j`, `nv` columns each.
///
/// # Errors
/// An array that has neither as many rows as `q` nor a single one, which stands for all.
pub fn forward(model: &OwnedModel, given: ForwardBatch, out: Forward<f64>) -> Result<(), Error> {
    let ForwardBatch { q, qd, theta, thetad, tau } = given;
    let rows = rows::count("q", q, model.nq())?;
    let given = Given { q, qd, theta, thetad, tau, ..Given::default() };
    evaluate(model, Algorithm::ForwardDynamics, rows, given, &mut [out.qdd, out.thetadd, out.tau_j])
}

/// Inverse dynamics of every row, as [`gyroflex::dynamics::rnea`] without external loads: writes `tau_j` and `tau`, `nv` columns
/// each.
///
/// # Errors
/// An array that has neither as many rows as `q` nor a single one, which stands for all.
pub fn inverse(model: &OwnedModel, given: InverseBatch, out: Inverse<f64>) -> Result<(), Error> {
    let InverseBatch { q, qd, theta, thetad, qdd, thetadd } = given;
    let rows = rows::count("q", q, model.nq())?;
    let given = Given { q, qd, theta, thetad, qdd, thetadd, ..Given::default() };
    evaluate(model, Algorithm::InverseDynamics, rows, given, &mut [out.tau_j, out.tau])
}
