//! Eigenfunctions of the uniform rod in torsion and extension.
//!
//! `φ'' = −β² φ`, with `β² = ω² ρI_p / GJ` in torsion and `β² = ω² μ / EA` in extension: `φ = sin β x` for a clamped root.

use super::bending::bisect;
use super::boundary::Boundary;
use std::f64::consts::PI;

/// An eigenfunction of amplitude one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// Length `L` [m].
    pub length: f64,
    /// `λ = β L`, the eigenvalue.
    pub eigenvalue: f64,
}

impl Rod {
    /// The first `count` eigenfunctions. `tip` is the body at the tip divided by the rod, inertia by inertia in torsion and mass by
    /// mass in extension; only a boundary with a body reads it. `None` where the boundary says nothing of a rod.
    pub fn first(boundary: Boundary, length: f64, tip: f64, count: usize) -> Option<Vec<Self>> {
        let eigenvalue = |k: usize| {
            let (from, to) = ((k as f64 - 1.0) * PI, (k as f64 - 0.5) * PI);
            match boundary {
                Boundary::ClampedFree => Some(to),
                Boundary::ClampedClamped => Some(k as f64 * PI),
                // cos λ = r λ sin λ
                Boundary::ClampedMass(_) => Some(bisect(|x| x.cos() - tip * x * x.sin(), from, to)),
                Boundary::ClampedPinned | Boundary::PinnedPinned => None,
            }
        };
        (1..=count).map(|k| eigenvalue(k).map(|eigenvalue| Self { length, eigenvalue })).collect()
    }

    /// The derivative of order `k` by `x` [1/mᵏ].
    pub fn derivative(&self, x: f64, k: usize) -> f64 {
        let beta = self.eigenvalue / self.length;
        let (sin, cos) = (beta * x).sin_cos();
        let wave = [sin, cos, -sin, -cos][k % 4];
        beta.powi(k as i32) * wave
    }
}
