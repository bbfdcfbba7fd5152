//! Steps behind a low-pass filter, in closed form.

use super::{Reference, add_position};
use crate::control::Real;
use crate::control::low_pass::corner;

/// A new set point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<T> {
    /// When it comes [s].
    pub time: T,
    /// The position asked for from then on [rad or m].
    pub to: T,
}

/// What a [`LowPass`](crate::control::LowPass) of some order makes of steps: with `x = ω (t − time)` each of them rises as
///
/// ```text
/// g(x) = 1 − e⁻ˣ Σ_{k<n} xᵏ/k!,    g' = ω wₙ₋₁,    wₖ' = ω (wₖ₋₁ − wₖ),    wₖ = e⁻ˣ xᵏ/k!.
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilteredStep<'a, T> {
    from: T,
    steps: &'a [Step<T>],
    order: usize,
    omega: T,
}

impl<'a, T: Real> FilteredStep<'a, T> {
    /// Rests at `from` [rad or m] until the first of `steps`, whatever their order in time: each one leads away from where the one before
    /// it in the slice leads to. `order` ≥ 1 and `cutoff` > 0 [Hz] are those of the filter. `None` if a number makes no sense.
    pub fn new(from: T, steps: &'a [Step<T>], order: usize, cutoff: T) -> Option<Self> {
        let finite = from.finite() && steps.iter().all(|s| s.time.finite() && s.to.finite());
        (finite && order > 0 && cutoff.positive()).then(|| Self { from, steps, order, omega: corner(cutoff, order) })
    }

    /// `g(x)`; near the start from the tail of the series, where the sum cancels.
    fn rise(&self, x: T) -> T {
        let (mut weight, mut sum) = ((-x).exp(), T::zero());
        if x < T::of(self.order) {
            for k in 1..self.order {
                weight = weight * x / T::of(k);
            }
            for k in self.order.. {
                weight = weight * x / T::of(k);
                let more = sum + weight;
                if more == sum {
                    break;
                }
                sum = more;
            }
            return sum;
        }
        for k in 0..self.order {
            sum += weight;
            weight = weight * x / T::of(k + 1);
        }
        T::one() - sum
    }

    /// `∇ʲ wₙ₋₁ = Σ_i (−1)^(j−i) C(j, i) w_{n−1−i}`, the derivative `g⁽ʲ⁺¹⁾ / ωʲ⁺¹`; weights of negative number are zero.
    fn difference(&self, j: usize, x: T) -> T {
        let last = self.order - 1;
        let deepest = j.min(last);
        let mut choose = T::one();
        for i in 1..=deepest {
            choose = choose * T::of(j + 1 - i) / T::of(i);
        }
        let (mut weight, mut sum) = ((-x).exp(), T::zero());
        for k in 0..=last {
            // How many weights below the last; of those deeper than the binomials reach there is none.
            let i = last - k;
            if i <= deepest {
                sum += if (j - i).is_multiple_of(2) { choose * weight } else { -(choose * weight) };
                choose = choose * T::of(i) / T::of(j + 1 - i);
            }
            weight = weight * x / T::of(k + 1);
        }
        sum
    }
}

impl<T: Real> Reference<T> for FilteredStep<'_, T> {
    fn add_derivatives(&self, t: T, weight: T, out: &mut [T]) {
        add_position(weight * self.from, out);
        let mut from = self.from;
        for step in self.steps {
            let (x, way) = (self.omega * (t - step.time), weight * (step.to - from));
            from = step.to;
            if x < T::zero() {
                continue;
            }
            let Some((position, derivatives)) = out.split_first_mut() else { return };
            *position += way * self.rise(x);
            let mut scale = way * self.omega;
            for (j, slot) in derivatives.iter_mut().enumerate() {
                *slot += scale * self.difference(j, x);
                scale = scale * self.omega;
            }
        }
    }

    fn smoothness(&self) -> Option<usize> {
        Some(self.order)
    }
}
