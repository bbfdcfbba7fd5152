//! What can be generated: one quantity a file, each the core's algorithm on symbols.

mod forward;
mod inverse;
mod tracing;

use crate::function::Function;
use crate::robot::Robot;

/// Something to generate a function for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// Accelerations from state and motor torques.
    Forward,
    /// Torques from motion.
    Inverse,
}

impl Quantity {
    /// All of them.
    pub const ALL: &[Self] = &[Self::Forward, Self::Inverse];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Inverse => "inverse",
        }
    }
}

/// The function that computes a quantity of a robot.
///
/// # Errors
/// Why there is none for this robot.
pub fn function(robot: &Robot, quantity: Quantity) -> Result<Function, Unavailable> {
    match quantity {
        Quantity::Forward => Ok(forward::forward(robot)),
        Quantity::Inverse => Ok(inverse::inverse(robot)),
    }
}

/// A quantity that a robot does not have, or for which there is no algorithm.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unavailable {
    /// The quantity.
    pub quantity: Quantity,
    /// Why.
    pub reason: String,
}

impl core::fmt::Display for Unavailable {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "no `{}`: {}", self.quantity.name(), self.reason)
    }
}

impl core::error::Error for Unavailable {}
