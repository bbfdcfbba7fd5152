//! Reference trajectories: position, velocity and acceleration of a joint over time.

mod build;
mod csv;
mod spline;

pub use build::references;
pub use spline::Spline;

use crate::scenario::SineTerm;
use std::f64::consts::TAU;

/// A reference at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Position [rad or m].
    pub q: f64,
    /// Velocity [rad/s or m/s].
    pub qd: f64,
    /// Acceleration [rad/s² or m/s²].
    pub qdd: f64,
}

/// The motion one joint is to follow.
#[derive(Clone, Debug)]
pub enum Trajectory {
    /// Stays at a position [rad or m].
    Hold(f64),
    /// `offset + Σ amplitude sin(2π frequency t + phase)`.
    Sines {
        /// Offset [rad or m].
        offset: f64,
        /// The terms of the sum.
        terms: Vec<SineTerm>,
    },
    /// `offset + A² cos ωt + A sin ωt + exp(−A ω t)` (Zhao, Yu, Wang, Tomizuka 2015).
    Zhao {
        /// Offset [rad or m].
        offset: f64,
        /// `A` [–].
        amplitude: f64,
        /// `ω` [rad/s].
        omega: f64,
    },
    /// Fifth degree from rest to rest.
    Quintic {
        /// Position before [rad or m].
        from: f64,
        /// Position after [rad or m].
        to: f64,
        /// When the motion starts [s].
        start: f64,
        /// How long it takes [s].
        duration: f64,
    },
    /// Cubic spline through points.
    Spline(Spline),
}

impl Trajectory {
    /// Position, velocity and acceleration at time `t` [s].
    pub fn at(&self, t: f64) -> Point {
        match self {
            Self::Hold(q) => Point { q: *q, ..Point::default() },
            Self::Sines { offset, terms } => {
                let mut point = Point { q: *offset, ..Point::default() };
                for term in terms {
                    let omega = TAU * term.frequency;
                    let (s, c) = (omega * t + term.phase).sin_cos();
                    point.q += term.amplitude * s;
                    point.qd += term.amplitude * omega * c;
                    point.qdd -= term.amplitude * omega * omega * s;
                }
                point
            }
            Self::Zhao { offset, amplitude: a, omega } => {
                let (s, c) = (omega * t).sin_cos();
                let e = (-a * omega * t).exp();
                Point {
                    q: offset + a * a * c + a * s + e,
                    qd: a * omega * (c - a * s - e),
                    qdd: a * omega * omega * (a * e - a * c - s),
                }
            }
            Self::Quintic { from, to, start, duration } => quintic(*from, *to, (t - start) / duration, *duration),
            Self::Spline(spline) => spline.at(t),
        }
    }
}

/// `from + (to − from)(10 s³ − 15 s⁴ + 6 s⁵)` with `s` from 0 to 1 over `duration`.
fn quintic(from: f64, to: f64, s: f64, duration: f64) -> Point {
    let (s, d) = (s.clamp(0.0, 1.0), to - from);
    Point {
        q: from + d * s * s * s * (10.0 + s * (6.0 * s - 15.0)),
        qd: d / duration * 30.0 * s * s * (1.0 - s) * (1.0 - s),
        qdd: d / (duration * duration) * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
    }
}
