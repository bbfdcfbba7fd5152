//! Robots whose links bend: scratch of the core's algorithms, and derivatives by running these on numbers that carry a slope.

mod christoffel;
mod slopes;
mod storage;

pub(super) use christoffel::coriolis;
pub(super) use slopes::{forward_partials, inverse_partials};
pub(crate) use storage::Storage;
