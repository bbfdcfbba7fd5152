//! A low-pass filter whose state has the derivatives of what it puts out.

use super::Real;

/// `N` first-order lags in series, critically damped, for set points that arrive while the robot moves: a step goes in, a motion with
/// `N` derivatives comes out.
///
/// ```text
/// ẋ₁ = ω (u − x₁),    ẋᵢ = ω (xᵢ₋₁ − xᵢ),    y = x_N,    y⁽ᵏ⁾ = ωᵏ ∇ᵏ x_N
/// ```
///
/// with the backward differences `∇xᵢ = xᵢ₋₁ − xᵢ`, `x₀ = u`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowPass<T, const N: usize> {
    omega: T,
    lags: [T; N],
}

impl<T: Real, const N: usize> LowPass<T, N> {
    /// A filter that rests at `position` [rad or m]. `cutoff` > 0 [Hz] is where the whole filter's gain is 1/√2 (−3 dB). `None` if a
    /// number makes no sense, or `N` is zero.
    pub fn new(cutoff: T, position: T) -> Option<Self> {
        (N > 0 && cutoff.positive() && position.finite())
            .then(|| Self { omega: corner(cutoff, N), lags: [position; N] })
    }

    /// Rests at `position` [rad or m] from now on.
    pub fn reset(&mut self, position: T) {
        self.lags = [position; N];
    }

    /// Goes on by `step` [s] with `input` [rad or m] held, exactly: with `x = ω step` and deviations `eᵢ = xᵢ − u`,
    /// `eᵢ ← Σ_k e⁻ˣ xᵏ/k! eᵢ₋ₖ`.
    pub fn advance(&mut self, input: T, step: T) {
        let x = self.omega * step;
        let decay = (-x).exp();
        // From the last lag down: those above still have their old values.
        for i in (0..N).rev() {
            let (mut weight, mut sum) = (decay, T::zero());
            for (k, lag) in self.lags.iter().take(i + 1).rev().enumerate() {
                sum += weight * (*lag - input);
                weight = weight * x / T::of(k + 1);
            }
            if let Some(lag) = self.lags.get_mut(i) {
                *lag = input + sum;
            }
        }
    }

    /// Position and derivatives now, `input` being held from now on [rad or m, per s, …], whatever the length of `out`. The
    /// input enters from order `N` on.
    pub fn derivatives(&self, input: T, out: &mut [T]) {
        let (mut lags, mut scale) = (self.lags, T::one());
        // The differences of the held input are zero.
        let mut before = input;
        for slot in out {
            *slot = scale * lags.last().map_or(T::zero(), |x| *x);
            let mut above = before;
            for lag in &mut lags {
                (above, *lag) = (*lag, above - *lag);
            }
            before = T::zero();
            scale = scale * self.omega;
        }
    }

    /// How many derivatives exist and are bounded.
    pub fn smoothness(&self) -> usize {
        N
    }
}

/// `ω = 2π cutoff / √(2^(1/n) − 1)` [rad/s]: `n` lags of it have gain `(1 + (2π f/ω)²)^(−n/2)`, which is 1/√2 at the cutoff.
pub(super) fn corner<T: Real>(cutoff: T, n: usize) -> T {
    // 2^(1/n) − 1 from its series, as the difference would cancel.
    let x = T::from_f64(core::f64::consts::LN_2) / T::of(n);
    let (mut term, mut sum) = (x, x);
    for k in 2..TERMS {
        term = term * x / T::of(k);
        sum += term;
    }
    T::from_f64(core::f64::consts::TAU) * cutoff / sum.sqrt()
}

/// Of the exponential series; at most ln 2 to the twentieth is left out.
const TERMS: usize = 20;
