//! Robots, states and calls shared by the benches and the instruction counts.

mod beams;
mod generated;
mod humanoid;
mod lanes;
pub mod peers;
#[cfg(feature = "robots")]
mod robots;
mod workload;

pub use beams::{Beams, FlexibleAlgorithm};
pub use generated::{Shape, generated};
pub use humanoid::{Standing, humanoid};
pub use lanes::Lane;
pub use peers::STATES;
#[cfg(feature = "robots")]
pub use robots::{load, robot};
pub use workload::{Algorithm, Spec, Workload};
