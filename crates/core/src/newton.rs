//! Roots of increasing functions in a fixed number of steps, without a branch on values.

use crate::Scalar;

/// The root between `low` and `high` of an increasing function, given by `f` with its slope: Newton's method, which where it would
/// leave the bracket first tries its end, and later halves it.
///
/// `STEPS` steps are taken. Not a number unless the value is below `near` two steps before the last; those two are Newton's, and square
/// what is left.
#[inline(always)]
pub(crate) fn increasing_root<F: Scalar, const STEPS: usize>(
    (mut low, mut high): (F, F),
    start: F,
    near: F,
    f: impl Fn(F) -> (F, F),
) -> F {
    let (zero, half) = (F::zero(), F::from_f64(0.5));
    let mut x = start.select_less(low, low, high.select_less(start, high, start));
    let mut found = F::from_f64(f64::NAN);
    for step in 0..STEPS {
        let (value, slope) = f(x);
        low = value.select_less(zero, x, low);
        high = zero.select_less(value, x, high);
        let newton = x - value / slope;
        let middle = (low + high) * half;
        // Once an end has been tried, a step from it is as good as it is near.
        let (left, right) = if step < 2 { (low, high) } else { (middle, middle) };
        x = if step + 2 < STEPS {
            newton.select_less(low, left, high.select_less(newton, right, newton))
        } else {
            newton
        };
        if step + 2 == STEPS {
            found = (value * value).select_less(near * near, zero, found);
        }
    }
    x + found
}
