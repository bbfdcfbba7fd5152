//! Rows of an array, into lanes and back.

use super::{LANES, Wide};
use crate::error::Error;
use gyroflex::model::SizeError;
use rayon::slice::ChunksMut;
use rayon::slice::ParallelSliceMut;

/// Number of rows of an array of so many columns.
pub(super) fn count(argument: &'static str, all: &[f64], columns: usize) -> Result<usize, Error> {
    let rows = all.len().checked_div(columns).unwrap_or(0);
    SizeError::check(argument, all.len(), rows * columns)?;
    Ok(rows)
}

/// An array that is read.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    all: &'a [f64],
    columns: usize,
}

impl<'a> Rows<'a> {
    pub(super) fn new(argument: &'static str, all: &'a [f64], columns: usize, rows: usize) -> Result<Self, Error> {
        SizeError::check(argument, all.len(), rows * columns)?;
        Ok(Self { all, columns })
    }
}

/// An array that is written.
pub(super) struct RowsMut;

impl RowsMut {
    /// Its rows, in tasks of so many.
    pub(super) fn tasks<'a>(
        argument: &'static str,
        all: &'a mut [f64],
        columns: usize,
        rows: usize,
        task: usize,
    ) -> Result<ChunksMut<'a, f64>, Error> {
        SizeError::check(argument, all.len(), rows * columns)?;
        Ok(all.par_chunks_mut(task * columns.max(1)))
    }
}

/// Rows from `row` on, one a lane; beyond the last row it is repeated.
pub(super) fn gather(from: Rows, row: usize, to: &mut [Wide]) {
    let last = (from.all.len() / from.columns.max(1)).saturating_sub(1);
    for lane in 0..LANES {
        let start = (row + lane).min(last) * from.columns;
        for (to, x) in to.iter_mut().zip(&from.all[start..start + from.columns]) {
            to.0[lane] = *x;
        }
    }
}

/// Lanes into the rows from `row` on, as far as there are any.
pub(super) fn scatter(from: &[Wide], to: &mut [f64], row: usize, columns: usize) {
    for (lane, row) in to.chunks_mut(columns.max(1)).skip(row).take(LANES).enumerate() {
        for (to, from) in row.iter_mut().zip(from) {
            *to = from.0[lane];
        }
    }
}
