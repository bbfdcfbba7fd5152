//! Eigenfunctions of the uniform Euler–Bernoulli beam in bending.
//!
//! `φ'''' = β⁴ φ` with `β⁴ = ω² μ / EI`. A solution is `c cos ξ + s sin ξ + p e^{−ξ} + q e^{−(λ−ξ)}` with `ξ = β x`, `λ = β L`: the
//! exponentials never exceed one, so that high modes lose no digits, as they do in hyperbolic functions. A clamped root leaves
//! `p` and `q`, the conditions at the tip are two equations for them, and `λ` makes their determinant vanish.

use super::boundary::{Boundary, TipBody};
use std::f64::consts::PI;

/// An eigenfunction, not normalised but positive just beyond the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bending {
    /// Length `L` [m].
    pub length: f64,
    /// `λ = β L`, the eigenvalue: `ω = (λ/L)² √(EI/μ)`.
    pub eigenvalue: f64,
    /// `c, s, p, q`.
    coefficients: [f64; 4],
}

impl Bending {
    /// The first `count` eigenfunctions of a beam with `mass_per_length` [kg/m], which matters beside a body at the tip only.
    pub fn first(boundary: Boundary, length: f64, mass_per_length: f64, count: usize) -> Vec<Self> {
        if boundary == Boundary::PinnedPinned {
            let pinned = |k: usize| Self { length, eigenvalue: k as f64 * PI, coefficients: [0.0, 1.0, 0.0, 0.0] };
            return (1..=count).map(pinned).collect();
        }
        let tip = Tip::new(boundary, length, mass_per_length);
        let eigenvalues = roots(|lambda| tip.determinant(lambda), count);
        eigenvalues
            .into_iter()
            .map(|eigenvalue| Self { length, eigenvalue, coefficients: tip.null(eigenvalue) })
            .collect()
    }

    /// The derivative of order `k` by `x` [1/mᵏ]: 0 the deflection, 1 the slope, 2 the curvature.
    pub fn derivative(&self, x: f64, k: usize) -> f64 {
        let beta = self.eigenvalue / self.length;
        let [c, s, p, q] = self.coefficients;
        let (cos, sin) = circular(beta * x, k);
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let decaying = sign * p * (-beta * x).exp() + q * (-beta * (self.length - x)).exp();
        beta.powi(k as i32) * (c * cos + s * sin + decaying)
    }
}

/// The conditions at the tip of a beam with a clamped root, each divided by the power of `β` of its derivative.
struct Tip {
    boundary: Boundary,
    /// The body at the tip per mass, moment of mass and inertia of the beam: divided by `μ L`, `μ L²` and `μ L³`.
    body: TipBody,
}

impl Tip {
    fn new(boundary: Boundary, length: f64, mass_per_length: f64) -> Self {
        let (tip, beam) = (boundary.tip(), mass_per_length * length);
        let body = TipBody {
            mass: tip.mass / beam,
            inertia: tip.inertia / (beam * length * length),
            first_moment: tip.first_moment / (beam * length),
        };
        Self { boundary, body }
    }

    /// The two conditions as rows over `p` and `q`, of length one.
    fn rows(&self, lambda: f64) -> [[f64; 2]; 2] {
        let end = (-lambda).exp();
        // Derivative k of e^{−ξ} − cos ξ + sin ξ and of e^{−(λ−ξ)} − e^{−λ} (cos ξ + sin ξ), which meet the clamped root.
        let g = |k: usize| {
            let (cos, sin) = circular(lambda, k);
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            [sign * end - cos + sin, 1.0 - end * (cos + sin)]
        };
        let TipBody { mass, inertia, first_moment } = self.body;
        let sum = |k: usize, terms: [(f64, usize); 2]| {
            let mut row = g(k);
            for (factor, k) in terms {
                let [p, q] = g(k);
                row = [row[0] + factor * p, row[1] + factor * q];
            }
            row
        };
        let rows = match self.boundary {
            Boundary::ClampedClamped => [g(0), g(1)],
            Boundary::ClampedPinned | Boundary::PinnedPinned => [g(0), g(2)],
            // EI φ'' = ω² (J φ' + S φ),  EI φ''' = −ω² (M φ + S φ')
            Boundary::ClampedFree | Boundary::ClampedMass(_) => [
                sum(2, [(-inertia * lambda.powi(3), 1), (-first_moment * lambda.powi(2), 0)]),
                sum(3, [(mass * lambda, 0), (first_moment * lambda.powi(2), 1)]),
            ],
        };
        rows.map(|[p, q]| {
            let size = p.hypot(q);
            [p / size, q / size]
        })
    }

    fn determinant(&self, lambda: f64) -> f64 {
        let [[a, b], [c, d]] = self.rows(lambda);
        a * d - b * c
    }

    /// `c, s, p, q` of the eigenfunction, the curvature at the root positive.
    fn null(&self, lambda: f64) -> [f64; 4] {
        // Both rows are of length one, and so equally good at an eigenvalue.
        let [[a, b], _] = self.rows(lambda);
        let end = (-lambda).exp();
        let (p, q) = if -b + a * end >= 0.0 { (-b, a) } else { (b, -a) };
        [-p - q * end, p - q * end, p, q]
    }
}

/// Derivative `k` of cosine and sine.
fn circular(xi: f64, k: usize) -> (f64, f64) {
    let (sin, cos) = xi.sin_cos();
    match k % 4 {
        0 => (cos, sin),
        1 => (-sin, cos),
        2 => (-cos, -sin),
        _ => (sin, -cos),
    }
}

/// The first `count` positive roots of a function that changes its sign there.
///
/// Eigenvalues are some π apart; those of a heavy body at the tip, which may be far below one, differ by a factor of nearly two.
fn roots(f: impl Fn(f64) -> f64, count: usize) -> Vec<f64> {
    const FIRST: f64 = 1e-3;
    let mut found = Vec::with_capacity(count);
    let (mut low, mut at_low) = (FIRST, f(FIRST));
    while found.len() < count {
        let high = low + (0.02 * low).min(0.02);
        let at_high = f(high);
        if at_low * at_high <= 0.0 && at_low != 0.0 {
            found.push(bisect(&f, low, high));
        }
        (low, at_low) = (high, at_high);
    }
    found
}

/// The root between two points where `f` has different signs, to the last digit.
pub(crate) fn bisect(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let positive = f(low) > 0.0;
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if (f(middle) > 0.0) == positive { low = middle } else { high = middle }
    }
}
