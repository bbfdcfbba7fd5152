//! Piecewise polynomials.

use super::{Reference, add_position};
use crate::control::Real;

/// Polynomials between knots in time, in storage of the caller's; it holds before the first knot and after the last, which
/// still belongs to the last piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piecewise<'a, T> {
    /// Where pieces begin, and where the last one ends, increasing [s].
    pub knots: &'a [T],
    /// Piece by piece the Taylor coefficients about its beginning: `degree + 1` entries `c_k` of `Σ c_k (t − knot)ᵏ` [rad/sᵏ or m/sᵏ].
    pub coefficients: &'a [T],
    /// How many derivatives exist and are bounded, which only its maker knows.
    pub smoothness: Option<usize>,
}

impl<'a, T: Real> Piecewise<'a, T> {
    /// Checks that the knots increase and every piece has equally many coefficients; `None` if not.
    pub fn new(knots: &'a [T], coefficients: &'a [T], smoothness: Option<usize>) -> Option<Self> {
        let pieces = knots.len().checked_sub(1).filter(|n| *n > 0)?;
        let increasing = knots.windows(2).all(|w| w[0] < w[1]);
        let shared = !coefficients.is_empty() && coefficients.len().is_multiple_of(pieces);
        let finite = knots.iter().chain(coefficients).all(|x| x.finite());
        (increasing && shared && finite).then_some(Self { knots, coefficients, smoothness })
    }
}

impl<T: Real> Reference<T> for Piecewise<'_, T> {
    fn add_derivatives(&self, t: T, weight: T, out: &mut [T]) {
        let Some(pieces) = self.knots.len().checked_sub(1).filter(|n| *n > 0) else { return };
        let (Some(first), Some(last)) = (self.knots.first(), self.knots.last()) else { return };
        let piece = self.knots.partition_point(|knot| *knot <= t).clamp(1, pieces) - 1;
        let count = self.coefficients.len() / pieces;
        let Some(c) = self.coefficients.get(piece * count..(piece + 1) * count) else { return };
        let begin = self.knots.get(piece).map_or(T::zero(), |k| *k);
        if t < *first || t > *last {
            let at = if t < *first { *first } else { *last };
            return add_position(weight * derivative(c, 0, at - begin), out);
        }
        for (k, slot) in out.iter_mut().enumerate().take(count) {
            *slot += weight * derivative(c, k, t - begin);
        }
    }

    fn smoothness(&self) -> Option<usize> {
        self.smoothness
    }
}

/// `Σ_j c_j j!/(j−k)! xʲ⁻ᵏ` by Horner's rule.
fn derivative<T: Real>(c: &[T], k: usize, x: T) -> T {
    let mut sum = T::zero();
    for (j, c) in c.iter().enumerate().skip(k).rev() {
        let mut falling = T::one();
        for i in j - k + 1..=j {
            falling = falling * T::of(i);
        }
        sum = sum.mul_add(x, *c * falling);
    }
    sum
}
