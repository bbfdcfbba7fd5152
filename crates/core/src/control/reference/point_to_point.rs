//! A polynomial from rest to rest.

use super::{Reference, add_position};
use crate::control::Real;

/// From one position to another along the polynomial of least degree whose first `m` derivatives vanish at both ends: its degree is
/// `2m + 1`; 1 is the cubic, 2 the quintic. It holds before and after.
///
/// With `s` from 0 to 1 over the motion, its velocity is the only polynomial of degree `2m` with `m` zeros at each end, and its
/// integral can be written with positive terms alone, so that nothing cancels:
///
/// ```text
/// σ'(s) = (2m+1)!/(m!)² sᵐ (1−s)ᵐ,    σ(s) = s^(m+1) Σ_{i=0}^{m} C(m+i, i) (1−s)ⁱ.
/// ```
///
/// With `x = 2s − 1` the velocity is `(x² − 1)ᵐ` but for a factor, whose derivatives are those of the Legendre polynomial `P_m`
/// (Rodrigues), on both sides of the `m`-th:
///
/// ```text
/// dᵐ⁺ʲ/dxᵐ⁺ʲ (x²−1)ᵐ = 2ᵐ m! P_m⁽ʲ⁾(x),    dᵐ⁻ʲ/dxᵐ⁻ʲ (x²−1)ᵐ = (m−j)!/(m+j)! (x²−1)ʲ 2ᵐ m! P_m⁽ʲ⁾(x),
/// ```
///
/// and `P_m⁽ʲ⁾ = (2j−1)!! C_{m−j}` with the Gegenbauer polynomials of parameter `j + 1/2`, whose three-term recurrence is
/// stable on [−1, 1] (Abramowitz, Stegun, 22.7 and 22.11).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointToPoint<T> {
    from: T,
    to: T,
    start: T,
    duration: T,
    order: usize,
}

impl<T: Real> PointToPoint<T> {
    /// The largest `m` for which the factorials stay within `f32`.
    pub const MAX_ORDER: usize = 15;

    /// From the position `from` to `to` [rad or m], leaving at `start` [s], over `duration` > 0 [s], with `order` derivatives that vanish at
    /// both ends, from 1 to [`PointToPoint::MAX_ORDER`]. `None` if a number is not finite or out of its range.
    pub fn new(from: T, to: T, start: T, duration: T, order: usize) -> Option<Self> {
        let finite = from.finite() && to.finite() && start.finite() && duration.positive();
        (finite && (1..=Self::MAX_ORDER).contains(&order)).then_some(Self { from, to, start, duration, order })
    }

    /// `σ(s)`, beyond its half from `1 − σ(1−s)`, so that it arrives without rounding beyond its end.
    fn rise(&self, s: T) -> T {
        let left = T::one() - s;
        if left < s { T::one() - self.first_half(left) } else { self.first_half(s) }
    }

    fn first_half(&self, s: T) -> T {
        let (m, left) = (self.order, T::one() - s);
        let (mut sum, mut term, mut power) = (T::one(), T::one(), s);
        for i in 1..=m {
            term = term * left * T::of(m + i) / T::of(i);
            sum += term;
            power = power * s;
        }
        power * sum
    }

    /// `σ⁽ⁿ⁺¹⁾(s)` for `n` up to `2m`, less the factor `(2m+1)!/m! (−1/2)ᵐ 2ⁿ`.
    fn shape(&self, n: usize, s: T) -> T {
        let (m, x) = (self.order, s + s - T::one());
        let j = m.abs_diff(n);
        let (mut before, mut gegenbauer) = (T::zero(), T::one());
        for i in 1..=m - j {
            let next = (T::of(2 * (i + j) - 1) * x * gegenbauer - T::of(i + 2 * j - 1) * before) / T::of(i);
            (before, gegenbauer) = (gegenbauer, next);
        }
        for odd in 1..=j {
            gegenbauer = gegenbauer * T::of(2 * odd - 1);
        }
        if n >= m {
            return gegenbauer;
        }
        // (x² − 1) (m−j)!/(m+j)!, one factor of the first with two of the second.
        let ends = T::from_f64(-4.0) * s * (T::one() - s);
        for i in 1..=j {
            gegenbauer = gegenbauer * ends / (T::of(m + i) * T::of(m + 1 - i));
        }
        gegenbauer
    }
}

impl<T: Real> Reference<T> for PointToPoint<T> {
    fn add_derivatives(&self, t: T, weight: T, out: &mut [T]) {
        let s = (t - self.start) / self.duration;
        if s < T::zero() || s >= T::one() {
            return add_position(weight * if s < T::zero() { self.from } else { self.to }, out);
        }
        let Some((position, derivatives)) = out.split_first_mut() else { return };
        let way = weight * (self.to - self.from);
        *position += weight * self.from + way * self.rise(s);
        let mut factor = way / self.duration;
        for i in self.order + 1..=2 * self.order + 1 {
            factor = factor * T::of(i);
        }
        for _ in 0..self.order {
            factor = factor * T::from_f64(-0.5);
        }
        for (n, slot) in derivatives.iter_mut().enumerate().take(2 * self.order + 1) {
            *slot += factor * self.shape(n, s);
            factor = factor * T::from_f64(2.0) / self.duration;
        }
    }

    fn smoothness(&self) -> Option<usize> {
        Some(self.order + 1)
    }
}
