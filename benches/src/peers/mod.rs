//! The side of the peer comparison that every Rust program in it shares: robots as `peers/stages/models.py` writes them, and
//! the conversation with `peers/run`. The crate `peers/rust` includes these files too.

mod coordinates;
mod tree;
mod worker;

pub use coordinates::{Coordinates, Point};
pub use tree::{Body, STATES, Spring, Tree, add_springs, error, numbers};
pub use worker::Worker;
