//! Motions of one coordinate as functions of time, with their derivatives; one kind a file. Nothing allocates.

mod filtered_step;
mod minimum_time;
mod piecewise;
mod point_to_point;
mod sines;

pub use filtered_step::{FilteredStep, Step};
pub use minimum_time::MinimumTime;
pub use piecewise::Piecewise;
pub use point_to_point::PointToPoint;
pub use sines::{Sine, Sines};

use super::Real;

/// The motion of one coordinate [rad or m] over time [s].
pub trait Reference<T: Real> {
    /// Adds `weight` times the `k`-th time derivative at `t` to `out[k]`, the position first, for as many as `out` has entries.
    /// Where a derivative jumps it is the one after `t`, up to the rounding of `t`; where it does not exist, the impulse at the jump is
    /// left out.
    fn add_derivatives(&self, t: T, weight: T, out: &mut [T]);

    /// How many derivatives exist and are bounded, the last of which may jump; `None` for all.
    fn smoothness(&self) -> Option<usize>;

    /// Writes position and derivatives at `t` [rad or m, per s, per s², …] to `out`, whatever its length.
    fn derivatives(&self, t: T, out: &mut [T]) {
        out.fill(T::zero());
        self.add_derivatives(t, T::one(), out);
    }
}

/// Adds a position that stays.
#[inline]
fn add_position<T: Real>(position: T, out: &mut [T]) {
    if let Some(first) = out.first_mut() {
        *first += position;
    }
}
