//! Many states of one robot at once: side by side in the lanes of the processor, and on all its cores.
//!
//! Arrays are row-major, one state a row: `q` has `nq` columns, everything else `nv`. An array of a single row stands for all.

mod algorithm;
mod bending;
mod real;
mod rollout;
mod rows;
mod work;

pub use algorithm::Algorithm;
pub use real::Real;
pub use rollout::{Rollout, Scheme, Trajectories, rollout};

use crate::error::{Error, ErrorKind};
use crate::robot::OwnedModel;
use bending::One;
use gyroflex::dynamics::{Acceleration, External, State};
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

impl<'a, F> Given<'a, F> {
    /// Positions and velocities, where this is about one state.
    pub fn state(&self) -> State<'a, F> {
        State { q: self.q, qd: self.qd, theta: self.theta, thetad: self.thetad }
    }

    /// Accelerations.
    pub fn acceleration(&self) -> Acceleration<'a, F> {
        Acceleration { qdd: self.qdd, thetadd: self.thetadd }
    }

    /// The load from outside.
    pub fn load(&self) -> External<'a, F> {
        External { tau: self.tau_ext, wrenches: &[] }
    }
}

/// Runs an algorithm over so many rows, and writes the first of its results, as many as `out` has, each with the columns that
/// [`Algorithm::columns`] says. A robot whose links bend is computed row by row, in `f64`.
///
/// # Errors
/// An array that has neither one row nor as many as asked for, or an entry that is not finite; [`ErrorKind::Diverged`] if a result is not.
pub fn evaluate<F: Real>(
    model: &OwnedModel,
    algorithm: &Algorithm,
    rows: usize,
    given: Given<F>,
    out: &mut [&mut [F]],
) -> Result<(), Error> {
    rows::check(model, rows, &given)?;
    let (columns, sizes) = (algorithm.columns(model.nv()), [model.nq(), model.nv()]);
    SizeError::check("out", out.len(), out.len().min(columns.len()))?;
    let bends = model.flexible().is_some();
    let task = GROUPS * if bends { 1 } else { F::LANES };
    let mut tasks: Vec<Vec<&mut [F]>> = (0..rows.div_ceil(task)).map(|_| Vec::new()).collect();
    for (out, columns) in out.iter_mut().zip(&columns) {
        SizeError::check("out", out.len(), rows * columns)?;
        for (task, rows) in tasks.iter_mut().zip(out.chunks_mut(task * columns.max(&1))) {
            task.push(rows);
        }
    }
    let rows_of = |index: usize| index * task..rows.min((index + 1) * task);
    if bends {
        let run = |one: &mut One, (index, mut out): (usize, Vec<&mut [F]>)| {
            for row in rows_of(index) {
                rows::refuse_not_finite(&given, sizes, row..row + 1)?;
                one.load(given, row);
                one.run(algorithm)?;
                for (i, (to, columns)) in out.iter_mut().zip(&columns).enumerate() {
                    let to = &mut to[(row - index * task) * columns..][..*columns];
                    one.write(i, to);
                    if !all_finite(to) {
                        return Err(diverged(algorithm.names()[i], row));
                    }
                }
            }
            Ok(())
        };
        return in_parallel(tasks, || One::new(model), run);
    }
    let records = model.cast::<F>();
    let model = &records.view();
    let run = |work: &mut Work<F::Lanes>, (index, mut out): (usize, Vec<&mut [F]>)| {
        for row in rows_of(index).step_by(F::LANES) {
            rows::load(given, row, work);
            if !work.given().into_iter().all(lanes_are_finite::<F>) {
                rows::refuse_not_finite(&given, sizes, row..rows.min(row + F::LANES))?;
            }
            algorithm.run(model, work)?;
            for (i, (to, columns)) in out.iter_mut().zip(&columns).enumerate() {
                let from = &work.out[i][..*columns];
                rows::scatter(from, to, row - index * task);
                if !lanes_are_finite::<F>(from) {
                    let lane = (0..F::LANES).find(|lane| from.iter().any(|x| !F::each(x)[*lane].is_finite()));
                    return Err(diverged(algorithm.names()[i], row + lane.unwrap_or(0)));
                }
            }
        }
        Ok(())
    };
    in_parallel(tasks, || Work::new(model), run)
}

fn diverged(result: &str, row: usize) -> Error {
    Error {
        kind: ErrorKind::Diverged,
        file: String::new(),
        element: String::new(),
        problem: format!("the result `{result}[{row}]` is not finite"),
        remedy: "check the size of the numbers given".to_owned(),
    }
}

/// Whether all numbers are finite, without a branch for each.
fn all_finite<F: Real>(numbers: &[F]) -> bool {
    numbers.iter().fold(true, |all, x| all & x.is_finite())
}

fn lanes_are_finite<F: Real>(lanes: &[F::Lanes]) -> bool {
    lanes.iter().fold(true, |all, x| all & all_finite(F::each(x)))
}

/// Runs tasks on all cores, or on those of the pool of rayon's that this is called in, whose threads then need a stack of 32 MiB in
/// unoptimised builds; a single one in the calling thread, which is faster than waking another.
///
/// # Errors
/// The first that a task has.
pub fn in_parallel<T: Send, W>(
    tasks: Vec<T>,
    work: impl Fn() -> W + Sync + Send,
    run: impl Fn(&mut W, (usize, T)) -> Result<(), Error> + Sync + Send,
) -> Result<(), Error> {
    if tasks.len() <= 1 {
        return tasks.into_iter().enumerate().try_for_each(|task| run(&mut work(), task));
    }
    let all = || tasks.into_par_iter().enumerate().try_for_each_init(work, run);
    if rayon::current_thread_index().is_some() { all() } else { POOL.install(all) }
}

/// Unoptimised builds keep all intermediate lanes on the stack, more than a thread has by default.
const STACK: usize = 32 << 20;

/// One thread for each core, or `RAYON_NUM_THREADS`.
static POOL: LazyLock<ThreadPool> =
    LazyLock::new(|| ThreadPoolBuilder::new().stack_size(STACK).build().expect("the system has threads"));
