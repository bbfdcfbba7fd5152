//! Motions of many copies of a robot, each from its own state and under its own torques.

use super::bending::{One, take};
use super::rows::{fits, gather, gather_step};
use super::work::Work;
use super::{Real, in_parallel};
use crate::error::Error;
use crate::robot::OwnedModel;
use gyroflex::Scalar;
use gyroflex::dynamics::External;
use gyroflex::integrate::{self, StateMut};
use gyroflex::model::{Model, SizeError};

/// How a step is taken; motor torques are held over it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// [`integrate::semi_implicit_euler`].
    SemiImplicitEuler,
    /// [`integrate::rk4`].
    Rk4,
}

/// Where motions start, one a row or one for all, and what drives them.
#[derive(Clone, Copy, Debug)]
pub struct Rollout<'a, F> {
    /// Joint positions, `nq` columns.
    pub q: &'a [F],
    /// Joint velocities.
    pub qd: &'a [F],
    /// Reflected motor positions.
    pub theta: &'a [F],
    /// Reflected motor velocities.
    pub thetad: &'a [F],
    /// Reflected motor torques of every step, of one motion after the other or of one for all.
    pub tau: &'a [F],
    /// Steps that `tau` has of a motion: all of them, or one that is held.
    pub tau_steps: usize,
    /// Time step [s].
    pub step: F,
    /// How many steps.
    pub steps: usize,
    /// How they are taken.
    pub scheme: Scheme,
}

/// States at all times, the start included: `steps + 1` rows of a motion, one motion after the other.
#[derive(Debug)]
pub struct Trajectories<'a, F> {
    /// Joint positions, `nq` columns.
    pub q: &'a mut [F],
    /// Joint velocities.
    pub qd: &'a mut [F],
    /// Reflected motor positions.
    pub theta: &'a mut [F],
    /// Reflected motor velocities.
    pub thetad: &'a mut [F],
}

/// Simulates so many motions. One that diverges is not finite from there on, and leaves the others alone. A robot whose links bend is
/// computed one motion after the other, in `f64`.
///
/// # Errors
/// An array that does not fit.
pub fn rollout<F: Real>(model: &OwnedModel, rows: usize, given: Rollout<F>, out: Trajectories<F>) -> Result<(), Error> {
    let (nq, nv, times) = (model.nq(), model.nv(), given.steps + 1);
    let over_joints = [("qd", given.qd), ("theta", given.theta), ("thetad", given.thetad)];
    fits("q", given.q, nq, rows)?;
    over_joints.into_iter().try_for_each(|(name, all)| fits(name, all, nv, rows))?;
    fits("tau", given.tau, given.tau_steps * nv, rows)?;
    let Trajectories { q, qd, theta, thetad } = out;
    let chunk = |name, all: &'_ [F], columns| SizeError::check(name, all.len(), rows * times * columns);
    chunk("out.q", q, nq)?;
    [("out.qd", &*qd), ("out.theta", &*theta), ("out.thetad", &*thetad)]
        .into_iter()
        .try_for_each(|(name, all)| chunk(name, all, nv))?;

    let bends = model.flexible().is_some();
    let length = |columns: usize| (if bends { 1 } else { F::LANES } * times * columns).max(1);
    let tasks: Vec<[&mut [F]; 4]> = q
        .chunks_mut(length(nq))
        .zip(qd.chunks_mut(length(nv)))
        .zip(theta.chunks_mut(length(nv)).zip(thetad.chunks_mut(length(nv))))
        .map(|((q, qd), (theta, thetad))| [q, qd, theta, thetad])
        .collect();
    if bends {
        return in_parallel(tasks, || One::new(model), |one, (row, out)| bending_motion(&given, row, one, out));
    }
    let records = model.cast::<F>();
    let model = &records.view();
    let storage = || {
        let stages = integrate::rk4_len(model).max(integrate::euler_len(model));
        (Work::new(model), vec![F::Lanes::zero(); stages])
    };
    in_parallel(tasks, storage, |(work, stages), (index, out)| {
        motion(model, &given, index * F::LANES, work, stages, out)
    })
}

/// The motions of one group of lanes, from `row` on.
fn motion<F: Real>(
    model: &Model<F>,
    given: &Rollout<F>,
    row: usize,
    work: &mut Work<F::Lanes>,
    stages: &mut [F::Lanes],
    mut out: [&mut [F]; 4],
) -> Result<(), Error> {
    let times = given.steps + 1;
    gather(given.q, row, &mut work.q);
    gather(given.qd, row, &mut work.qd);
    gather(given.theta, row, &mut work.theta);
    gather(given.thetad, row, &mut work.thetad);
    record(&mut out, work, 0, times);
    for k in 0..given.steps {
        if k < given.tau_steps {
            gather_step(given.tau, row, (k, given.tau_steps), &mut work.tau);
        }
        let Work { q, qd, theta, thetad, tau, scratch, .. } = &mut *work;
        let (state, step) = (StateMut { q, qd, theta, thetad }, F::Lanes::from_param(given.step));
        let (none, scratch) = (External::none(), scratch.forward());
        match given.scheme {
            Scheme::SemiImplicitEuler => {
                let stages = &mut stages[..integrate::euler_len(model)];
                integrate::semi_implicit_euler(model, state, tau, none, step, scratch, stages)?;
            }
            Scheme::Rk4 => {
                let stages = &mut stages[..integrate::rk4_len(model)];
                integrate::rk4(model, state, tau, none, step, scratch, stages)?;
            }
        }
        record(&mut out, work, k + 1, times);
    }
    Ok(())
}

/// The motion of one robot whose links bend.
fn bending_motion<F: Real>(given: &Rollout<F>, row: usize, one: &mut One, mut out: [&mut [F]; 4]) -> Result<(), Error> {
    let One { dynamics, q, qd, theta, thetad, tau, .. } = one;
    take(given.q, row, q);
    take(given.qd, row, qd);
    take(given.theta, row, theta);
    take(given.thetad, row, thetad);
    let batched = given.tau.len() > given.tau_steps * tau.len();
    for k in 0..=given.steps {
        for (out, now) in out.iter_mut().zip([&*q, &*qd, &*theta, &*thetad]) {
            let n = now.len();
            out[k * n..][..n].iter_mut().zip(now).for_each(|(out, x)| *out = F::from_f64(*x));
        }
        if k < given.tau_steps {
            let step = k + if batched { row * given.tau_steps } else { 0 };
            take(&given.tau[step * tau.len()..][..tau.len()], 0, tau);
        }
        if k < given.steps {
            let (state, none, step) = (StateMut { q, qd, theta, thetad }, External::none(), given.step.into());
            match given.scheme {
                Scheme::SemiImplicitEuler => dynamics.semi_implicit_euler(state, tau, none, step)?,
                Scheme::Rk4 => dynamics.rk4(state, tau, none, step)?,
            }
        }
    }
    Ok(())
}

/// Writes the states at time `k` where they belong.
fn record<F: Real>(out: &mut [&mut [F]; 4], work: &Work<F::Lanes>, k: usize, times: usize) {
    for (out, from) in out.iter_mut().zip([&work.q, &work.qd, &work.theta, &work.thetad]) {
        let columns = from.len().max(1);
        for (lane, motion) in out.chunks_mut(times * columns).enumerate() {
            for (to, from) in motion[k * columns..].iter_mut().zip(from) {
                *to = F::each(from)[lane];
            }
        }
    }
}
