//! Sums of sines.

use super::{Reference, add_position};
use crate::control::Real;

/// `amplitude sin(2π frequency t + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine<T> {
    /// Amplitude [rad or m].
    pub amplitude: T,
    /// Frequency [Hz].
    pub frequency: T,
    /// Phase [rad].
    pub phase: T,
}

impl<T: Real> Reference<T> for Sine<T> {
    fn add_derivatives(&self, t: T, weight: T, out: &mut [T]) {
        let omega = T::from_f64(core::f64::consts::TAU) * self.frequency;
        let (sin, cos) = omega.mul_add(t, self.phase).sin_cos();
        let mut size = weight * self.amplitude;
        // A derivative is a quarter of a turn ahead.
        for (slot, turned) in out.iter_mut().zip([sin, cos, -sin, -cos].into_iter().cycle()) {
            *slot += size * turned;
            size = size * omega;
        }
    }

    fn smoothness(&self) -> Option<usize> {
        None
    }
}

/// `offset + Σ amplitude sin(2π frequency t + phase)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sines<'a, T> {
    /// Offset [rad or m].
    pub offset: T,
    /// The terms of the sum.
    pub terms: &'a [Sine<T>],
}

impl<T: Real> Reference<T> for Sines<'_, T> {
    fn add_derivatives(&self, t: T, weight: T, out: &mut [T]) {
        add_position(weight * self.offset, out);
        for term in self.terms {
            term.add_derivatives(t, weight, out);
        }
    }

    fn smoothness(&self) -> Option<usize> {
        None
    }
}
