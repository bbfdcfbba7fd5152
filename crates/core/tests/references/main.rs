//! Laws of references and of the low-pass filter.

mod common;
mod filtered;
mod minimum_time;
mod polynomials;
mod precision;
