//! What a controller of elastic joints is fed with: motions with as many derivatives as its inverse dynamics asks for, and
//! ways to make set points so smooth.

mod low_pass;
mod real;
pub mod reference;

pub use low_pass::LowPass;
pub use real::Real;
