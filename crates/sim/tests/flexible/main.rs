//! Laws of robots whose links bend, as commands see them.

mod arms;
mod calculator;
mod controllers;
mod equilibria;
mod linear;
mod logs;
mod motion;
mod refusals;

/// Whether two lists agree, relative to the largest entry.
fn assert_close(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size = expected.iter().fold(0.0, |most: f64, x| most.max(x.abs())).max(f64::MIN_POSITIVE);
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance * size, "{what}[{i}]: {a} is not {b}");
    }
}

/// Numbers between −1 and 1 without a pattern, the same ones for the same seed.
fn numbers(seed: u64, n: usize) -> Vec<f64> {
    (0..n).map(|i| ((12.9898 * (seed + 1) as f64 + 78.233 * (i + 1) as f64).sin() * 43758.5453).fract()).collect()
}
