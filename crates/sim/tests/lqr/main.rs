//! Laws of linear-quadratic regulators: of their equation, and of the robots they hold.

#[path = "../arm/mod.rs"]
mod arm;
mod equation;
mod robots;

use nalgebra::DMatrix;

/// Numbers between −1 and 1 without a pattern, the same ones for the same seed.
fn numbers(seed: u64, n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| (12.9898 * (seed + 1) as f64 + 78.233 * (i + 1) as f64).sin() * 43758.5453)
        .map(|x| 2.0 * x.fract() - x.signum())
        .collect()
}

/// How far two matrices are apart, relative to the second.
fn apart(x: &DMatrix<f64>, y: &DMatrix<f64>) -> f64 {
    (x - y).norm() / y.norm()
}

fn radius(a: &DMatrix<f64>) -> f64 {
    a.complex_eigenvalues().iter().fold(0.0, |most: f64, l| most.max(l.norm()))
}
