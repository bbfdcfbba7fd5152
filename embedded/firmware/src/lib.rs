//! What the programs in `main.rs` and `bin/` share: the arm, its controller, random states, and the laws.
#![no_std]
#![forbid(unsafe_code)]

pub mod arm;
pub mod controller;
pub mod elastic;
pub mod held;
pub mod laws;
pub mod observer;
pub mod orders;
pub mod plant;
pub mod random;
pub mod reference;
pub mod scratch;
