//! Derivatives of anything, without its own formulas.

use gyroflex::control::Real;
use gyroflex::control::reference::Reference;

/// Position and derivatives at `t`, `n` numbers.
pub fn at<T: Real>(reference: &impl Reference<T>, t: T, n: usize) -> Vec<T> {
    // Full of nonsense: it must be overwritten.
    let mut out = vec![T::from_f64(f64::NAN); n];
    reference.derivatives(t, &mut out);
    out
}

/// Derivative at `t` from values over `±h`, extrapolated twice (Richardson): an error of order h⁶.
pub fn slope(f: impl Fn(f64) -> f64, t: f64, h: f64) -> f64 {
    let central = |h: f64| (f(t + h) - f(t - h)) / (2.0 * h);
    let [a, b, c] = [central(h), central(h / 2.0), central(h / 4.0)];
    let [d, e] = [b + (b - a) / 3.0, c + (c - b) / 3.0];
    e + (e - d) / 15.0
}

/// Each derivative is the slope of the one before it: at `times`, up to derivative `orders`, relative to the largest values there.
pub fn assert_consistent(name: &str, reference: &impl Reference<f64>, times: &[f64], orders: usize, h: f64) {
    for k in 1..=orders {
        let value = |t: f64, k: usize| at(reference, t, k + 1)[k];
        let size = times.iter().map(|t| value(*t, k).abs()).fold(value(times[0], k - 1).abs() * 1e-3, f64::max);
        for &t in times {
            let (own, slope) = (value(t, k), slope(|t| value(t, k - 1), t, h));
            assert!((own - slope).abs() <= 1e-7 * size, "{name}: derivative {k} at {t} is {own}, the slope {slope}");
        }
    }
}

/// Numbers from 0 to 1 that look random.
pub fn scattered(i: usize) -> f64 {
    ((i as f64 + 0.5) * 0.618_033_988_749_895).fract()
}

pub fn choose(n: u32, k: u32) -> i128 {
    (0..k).fold(1, |c, i| c * i128::from(n - i) / i128::from(i + 1))
}
