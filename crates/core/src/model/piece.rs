//! One piece of a spring's law, and its inverse.

use crate::Scalar;
use crate::newton::increasing_root;

/// The cubic that a spring's torque is over some range: `c₀ + c₁ x + c₂ x² + c₃ x³` with `x = δ − start`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Piece<F> {
    pub(crate) start: F,
    pub(crate) c: [F; 4],
}

/// Steps of the search for a deflection. Newton's method on a cubic far beyond its straight part gains a third a step.
const STEPS: usize = 20;
/// How near the search must come before its last steps, as part of the torque [–].
const NEAR: f64 = 1e-4;

impl<F: Scalar> Piece<F> {
    #[inline(always)]
    pub(super) fn select_less(x: F, threshold: F, less: Self, otherwise: Self) -> Self {
        let pick = |a: F, b: F| x.select_less(threshold, a, b);
        let (a, b) = (less.c, otherwise.c);
        let c = [pick(a[0], b[0]), pick(a[1], b[1]), pick(a[2], b[2]), pick(a[3], b[3])];
        Self { start: pick(less.start, otherwise.start), c }
    }

    /// `k` and `k'` at `x`.
    #[inline(always)]
    pub(crate) fn value_and_slope(&self, x: F) -> (F, F) {
        let [c0, c1, c2, c3] = self.c;
        let (two, three) = (F::from_f64(2.0), F::from_f64(3.0));
        (c0 + x * (c1 + x * (c2 + x * c3)), c1 + x * (two * c2 + x * three * c3))
    }

    /// `x` between `low` and `high` with `k(x) = torque`.
    #[inline(always)]
    pub(super) fn solve(&self, torque: F, low: F, high: F) -> F {
        let start = (torque - self.c[0]) / self.c[1];
        // Of the size of the torques, and a little where there are none.
        let size = (torque * torque + self.c[0] * self.c[0]).sqrt() + F::from_f64(1e-12);
        increasing_root::<F, STEPS>((low, high), start, size * F::from_f64(NEAR), |x| {
            let (value, slope) = self.value_and_slope(x);
            (value - torque, slope)
        })
    }
}
