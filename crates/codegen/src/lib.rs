//! Explicit equations and straight-line code for one robot.
//!
//! The algorithms of [`gyroflex`] run unchanged on a scalar without a value, [`sym::Sym`]; what they leave in their results are
//! expressions of one [`graph::Graph`]. A [`function::Function`] names its arguments and results, [`quantity`] says which there are,
//! [`robot`] makes a robot's records symbols, [`emit`] writes the code. The idea of explicit, symbolic, non-recursive
//! equations is that of Cetinkunt and Book 1988, *Symbolic modeling of flexible manipulators*.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod emit;
pub mod explicit;
pub mod function;
pub mod graph;
pub mod optimise;
pub mod program;
pub mod quantity;
pub mod robot;
pub mod split;
pub mod sym;
pub mod weigh;
