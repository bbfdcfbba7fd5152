//! Rows of an array, into lanes and back.

use super::work::Work;
use super::{Given, Real};
use crate::error::Error;
use crate::robot::OwnedModel;
use gyroflex::model::SizeError;

/// Whether all that is given has so many rows, or one.
pub(super) fn check<F: Real>(model: &OwnedModel, rows: usize, given: &Given<F>) -> Result<(), Error> {
    let (nq, nv) = (model.nq(), model.nv());
    let Given { q, qd, theta, thetad, qdd, thetadd, tau, tau_ext } = *given;
    let over_joints = [
        ("qd", qd),
        ("theta", theta),
        ("thetad", thetad),
        ("qdd", qdd),
        ("thetadd", thetadd),
        ("tau", tau),
        ("tau_ext", tau_ext),
    ];
    fits("q", q, nq, rows)?;
    over_joints.into_iter().try_for_each(|(name, all)| if all.is_empty() { Ok(()) } else { fits(name, all, nv, rows) })
}

/// Whether an array has so many rows, or one.
pub(super) fn fits<F>(name: &'static str, all: &[F], columns: usize, rows: usize) -> Result<(), Error> {
    if all.len() == columns { Ok(()) } else { Ok(SizeError::check(name, all.len(), rows * columns)?) }
}

/// Fills the lanes with the states from `row` on.
pub(super) fn load<F: Real>(given: Given<F>, row: usize, work: &mut Work<F::Lanes>) {
    let Given { q, qd, theta, thetad, qdd, thetadd, tau, tau_ext } = given;
    gather(q, row, &mut work.q);
    gather(qd, row, &mut work.qd);
    gather(theta, row, &mut work.theta);
    gather(thetad, row, &mut work.thetad);
    gather(qdd, row, &mut work.qdd);
    gather(thetadd, row, &mut work.thetadd);
    gather(tau, row, &mut work.tau);
    gather(tau_ext, row, &mut work.tau_ext);
}

/// Rows from `row` on, one a lane; beyond the last row it is repeated. Nothing given leaves the zeros that are there.
pub(super) fn gather<F: Real>(from: &[F], row: usize, to: &mut [F::Lanes]) {
    gather_step(from, row, (0, 1), to);
}

/// The same of rows that have `steps` steps of `to.len()` numbers, of which step `k` is taken.
pub(super) fn gather_step<F: Real>(from: &[F], row: usize, (k, steps): (usize, usize), to: &mut [F::Lanes]) {
    let columns = to.len();
    let Some(last) = from.len().checked_div(steps * columns).and_then(|rows| rows.checked_sub(1)) else { return };
    for lane in 0..F::LANES {
        let start = ((row + lane).min(last) * steps + k) * columns;
        for (to, x) in to.iter_mut().zip(&from[start..start + columns]) {
            F::each_mut(to)[lane] = *x;
        }
    }
}

/// Lanes into the rows from `row` on, as far as there are any.
pub(super) fn scatter<F: Real>(from: &[F::Lanes], to: &mut [F], row: usize) {
    for (lane, row) in to.chunks_mut(from.len().max(1)).skip(row).take(F::LANES).enumerate() {
        for (to, from) in row.iter_mut().zip(from) {
            *to = F::each(from)[lane];
        }
    }
}
