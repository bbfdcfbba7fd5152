//! How equal is equal.

use gyroflex::{Lanes, Scalar};

/// A scalar the laws run in.
pub trait Real: Scalar {
    /// For messages.
    const NAME: &'static str;
    /// The number as the oracles have it.
    fn to_f64(self) -> f64;
    /// The part of a pair of tolerances meant for this scalar.
    fn pick(pair: Tolerance) -> f64;
}

impl Real for f64 {
    const NAME: &'static str = "f64";
    fn to_f64(self) -> f64 {
        self
    }
    fn pick(pair: Tolerance) -> f64 {
        pair.double
    }
}

impl Real for f32 {
    const NAME: &'static str = "f32";
    fn to_f64(self) -> f64 {
        self.into()
    }
    fn pick(pair: Tolerance) -> f64 {
        pair.single
    }
}

/// The same state in all lanes.
impl Real for Lanes<f64, 8> {
    const NAME: &'static str = "8 lanes of f64";
    /// # Panics
    /// If the lanes differ.
    fn to_f64(self) -> f64 {
        let [first, rest @ ..] = self.0;
        assert!(rest.iter().all(|x| x.to_bits() == first.to_bits()), "lanes differ: {:?}", self.0);
        first
    }
    fn pick(pair: Tolerance) -> f64 {
        pair.double
    }
}

/// One relative tolerance per scalar, so that a law is written once and runs in both.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    double: f64,
    single: f64,
}

/// Pairs the tolerances for `f64` and `f32`.
pub const fn tol(double: f64, single: f64) -> Tolerance {
    Tolerance { double, single }
}

/// Largest absolute entry; NaN if any entry is.
pub fn norm(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |m: f64, x| if x.is_nan() || m.is_nan() { f64::NAN } else { m.max(x.abs()) })
}

/// `‖got − want‖ / max(‖want‖, floor)` in the maximum norm over the whole vector. Entries of a joint vector have different
/// units and sizes, but they come out of one linear system, whose rounding spreads over all of them.
pub fn relative_error(got: &[f64], want: &[f64], floor: f64) -> f64 {
    assert_eq!(got.len(), want.len(), "vectors of different lengths");
    let difference: Vec<f64> = got.iter().zip(want).map(|(a, b)| a - b).collect();
    let error = norm(&difference);
    if error == 0.0 { 0.0 } else { error / norm(want).max(floor) }
}

/// Asserts that two vectors agree within a relative tolerance; `context` tells which robot and state it was.
///
/// # Panics
/// If they do not, or if anything is NaN.
#[track_caller]
pub fn assert_close(what: &str, context: &dyn core::fmt::Display, got: &[f64], want: &[f64], tolerance: f64) {
    assert_close_above(what, context, got, want, tolerance, 0.0);
}

/// The same, relative to at least `floor`: for quantities that may vanish beside the terms they are the sum of.
///
/// # Panics
/// If the vectors differ by more, or if anything is NaN.
#[track_caller]
pub fn assert_close_above(
    what: &str,
    context: &dyn core::fmt::Display,
    got: &[f64],
    want: &[f64],
    tolerance: f64,
    floor: f64,
) {
    let error = relative_error(got, want, floor);
    if error <= tolerance {
        return;
    }
    let worst = (0..got.len()).max_by(|&i, &j| {
        let at = |i: usize| (got[i] - want[i]).abs();
        if at(i).is_nan() { core::cmp::Ordering::Greater } else { at(i).total_cmp(&at(j)) }
    });
    let at = worst.map_or(String::new(), |i| format!(" (worst at entry {i}: {:e} for {:e})", got[i], want[i]));
    panic!("{what} is off by {error:e}, tolerance {tolerance:e}{at}; {context}");
}
