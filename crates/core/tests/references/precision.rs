//! The same motions in single precision.

use crate::common::at;
use gyroflex::control::Real;
use gyroflex::control::reference::{FilteredStep, MinimumTime, PointToPoint, Reference, Sine, Step};

/// Single precision against double, relative to the largest value of each derivative.
fn assert_single(
    name: &str,
    orders: usize,
    tolerance: f64,
    double: &impl Reference<f64>,
    single: &impl Reference<f32>,
) {
    let times: Vec<f64> = (0..40).map(|i| f64::from((0.03 + 0.025 * i as f64) as f32)).collect();
    let all: Vec<_> = times.iter().map(|t| (at(double, *t, orders), at(single, *t as f32, orders))).collect();
    for k in 0..orders {
        let size = all.iter().map(|(d, _)| d[k].abs()).fold(0.0, f64::max);
        let error = all.iter().map(|(d, s)| (d[k] - f64::from(s[k])).abs()).fold(0.0, f64::max);
        assert!(error <= tolerance * size, "{name}, derivative {k}: {error:e} of {size:e}");
    }
}

#[test]
fn single_precision_keeps_its_digits() {
    fn polynomial<T: Real>(m: usize) -> PointToPoint<T> {
        let f = T::from_f64;
        PointToPoint::new(f(0.25), f(1.5), f(0.0), f(1.0), m).unwrap()
    }
    for m in [1, 2, 5, 9] {
        assert_single(&format!("order {m}"), m + 2, 2e-5, &polynomial(m), &polynomial(m));
    }
    fn sine<T: Real>() -> Sine<T> {
        Sine { amplitude: T::from_f64(0.5), frequency: T::from_f64(0.75), phase: T::from_f64(0.25) }
    }
    assert_single("sine", 10, 1e-5, &sine(), &sine());
    fn minimum_time<T: Real>() -> MinimumTime<T, 4> {
        let f = T::from_f64;
        MinimumTime::new(f(0.0), f(0.5), f(0.0), &[1.0, 4.0, 32.0, 512.0].map(f)).unwrap()
    }
    // The last derivative jumps, and when depends on rounding.
    assert_single("minimum time", 4, 1e-5, &minimum_time(), &minimum_time());
    let (double, single) = ([Step { time: 0.0, to: 1.0 }], [Step { time: 0.0, to: 1.0f32 }]);
    let filtered = FilteredStep::new(0.5, &double, 6, 2.0).unwrap();
    assert_single("filtered", 7, 1e-4, &filtered, &FilteredStep::new(0.5, &single, 6, 2.0).unwrap());
}
