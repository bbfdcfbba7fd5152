//! Rows of an array, into lanes and back.

use super::work::Work;
use super::{Given, Real};
use crate::error::{Error, ErrorKind};
use crate::robot::OwnedModel;
use gyroflex::model::SizeError;
use std::ops::Range;

/// Whether all that is given has so many rows, or one.
pub(super) fn check<F: Real>(model: &OwnedModel, rows: usize, given: &Given<F>) -> Result<(), Error> {
    fits("q", given.q, model.nq(), rows)?;
    let over_joints = given.named().into_iter().skip(1).filter(|(_, all)| !all.is_empty());
    over_joints.into_iter().try_for_each(|(name, all)| fits(name, all, model.nv(), rows))
}

impl<'a, F> Given<'a, F> {
    /// All arrays by name, the positions first.
    fn named(&self) -> [(&'static str, &'a [F]); 8] {
        let Given { q, qd, theta, thetad, qdd, thetadd, tau, tau_ext } = *self;
        [
            ("q", q),
            ("qd", qd),
            ("theta", theta),
            ("thetad", thetad),
            ("qdd", qdd),
            ("thetadd", thetadd),
            ("tau", tau),
            ("tau_ext", tau_ext),
        ]
    }
}

/// Names an entry of these rows, or of an array of a single one, that is not finite.
pub(super) fn refuse_not_finite<F: Real>(
    given: &Given<F>,
    columns: [usize; 2],
    rows: Range<usize>,
) -> Result<(), Error> {
    for (i, (name, all)) in given.named().into_iter().enumerate() {
        let n = columns[i.min(1)];
        let part = if all.len() == n { 0..n } else { rows.start * n..all.len().min(rows.end * n) };
        if let Some(k) = all.get(part.clone()).and_then(|part| part.iter().position(|x| !x.is_finite())) {
            let (at, value): (usize, f64) = (part.start + k, all[part.start + k].into());
            return Err(Error {
                kind: ErrorKind::Shape,
                file: String::new(),
                element: name.to_owned(),
                problem: format!("entry {} of row {} is {value}", at % n, at / n),
                remedy: "give finite numbers".to_owned(),
            });
        }
    }
    Ok(())
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
