//! Gauss–Legendre quadrature, piece by piece.

use std::f64::consts::PI;

/// Nodes and weights of the rule with `n` points on `[-1, 1]`, exact for polynomials of degree `2n − 1`.
pub fn gauss_legendre(n: usize) -> Vec<[f64; 2]> {
    let size = n as f64;
    let node = |i: usize| {
        // Tricomi's estimate, and Newton's method on the Legendre polynomial.
        let mut x = (PI * (i as f64 + 0.75) / (size + 0.5)).cos();
        for _ in 0..100 {
            let (p, slope) = legendre(n, x);
            let step = p / slope;
            x -= step;
            if step.abs() <= f64::EPSILON {
                break;
            }
        }
        let (_, slope) = legendre(n, x);
        [x, 2.0 / ((1.0 - x * x) * slope * slope)]
    };
    (0..n).rev().map(node).collect()
}

/// Points and weights of the `n`-point rule on each of the pieces between `breaks`, which ascend.
pub fn composite(breaks: &[f64], n: usize) -> Vec<[f64; 2]> {
    let rule = gauss_legendre(n);
    let pieces = breaks.windows(2).filter(|b| b[1] > b[0]);
    pieces
        .flat_map(|b| {
            let (middle, half) = (0.5 * (b[0] + b[1]), 0.5 * (b[1] - b[0]));
            rule.iter().map(move |[x, w]| [middle + half * x, half * w])
        })
        .collect()
}

/// The Legendre polynomial of degree `n` and its slope at `x`, `|x| < 1`.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut p) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k);
    }
    (p, n as f64 * (x * p - before) / (x * x - 1.0))
}
