//! One scenario over many values of its keys: every run becomes a row of numbers.

mod grid;
mod measures;
mod rows;
mod table;

pub use grid::{Axis, Grid};
pub use measures::{Measures, measure};
pub use rows::{Outcome, run_in_order};
pub use table::Table;

use crate::error::{Error, ErrorKind};

/// Whether an error is about one run alone, which is a result as well; others would meet every run: files that cannot be read, keys
/// that are not known.
pub fn is_of_the_run(error: &Error) -> bool {
    !matches!(error.kind, ErrorKind::Io | ErrorKind::Urdf | ErrorKind::Yaml)
}
