//! Reference trajectories: position of a joint over time, with its derivatives.

mod build;
mod csv;
mod references;
mod shaping;
mod smooth_spline;
mod spline;

pub use gyroflex::control::reference::Reference;
pub use references::References;
pub use smooth_spline::{Ends, SmoothSpline};
pub use spline::Spline;

use crate::scenario::SineTerm;
use gyroflex::control::reference::{FilteredStep, MinimumTime, PointToPoint, Sine, Step};

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

/// The most derivatives that can be bounded.
pub const MAX_LIMITS: usize = 16;

/// The motion one joint is to follow; its derivatives of any order are those of a [`Reference`].
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
    /// A polynomial from rest to rest.
    Polynomial(PointToPoint<f64>),
    /// A step behind a low-pass filter.
    FilteredStep {
        /// Position before [rad or m].
        from: f64,
        /// The step.
        step: Step<f64>,
        /// Number of first-order lags.
        order: usize,
        /// Where the whole filter is 3 dB down [Hz].
        cutoff: f64,
    },
    /// From rest to rest as fast as bounds allow.
    MinimumTime(Box<MinimumTime<f64, MAX_LIMITS>>),
    /// Cubic spline through points.
    Spline(Spline),
    /// Spline of higher degree through points.
    SmoothSpline(SmoothSpline),
}

impl Trajectory {
    /// Position, velocity and acceleration at time `t` [s].
    pub fn at(&self, t: f64) -> Point {
        let mut out = [0.0; 3];
        self.derivatives(t, &mut out);
        Point::from(out)
    }
}

impl From<[f64; 3]> for Point {
    fn from([q, qd, qdd]: [f64; 3]) -> Self {
        Self { q, qd, qdd }
    }
}

impl Reference<f64> for Trajectory {
    fn add_derivatives(&self, t: f64, weight: f64, out: &mut [f64]) {
        let mut add_position = |q: f64| {
            if let Some(first) = out.first_mut() {
                *first += weight * q;
            }
        };
        match self {
            Self::Hold(q) => add_position(*q),
            Self::Sines { offset, terms } => {
                add_position(*offset);
                for &SineTerm { amplitude, frequency, phase } in terms {
                    Sine { amplitude, frequency, phase }.add_derivatives(t, weight, out);
                }
            }
            Self::Zhao { offset, amplitude: a, omega } => {
                add_position(*offset);
                let (s, c) = (omega * t).sin_cos();
                let (mut power, mut decay) = (weight, weight * (-a * omega * t).exp());
                // A derivative is a quarter of a turn ahead.
                for (slot, [s, c]) in out.iter_mut().zip([[s, c], [c, -s], [-s, -c], [-c, s]].into_iter().cycle()) {
                    *slot += power * a * (a * c + s) + decay;
                    (power, decay) = (power * omega, -decay * a * omega);
                }
            }
            Self::Polynomial(polynomial) => polynomial.add_derivatives(t, weight, out),
            Self::FilteredStep { from, step, order, cutoff } => {
                if let Some(reference) = FilteredStep::new(*from, std::slice::from_ref(step), *order, *cutoff) {
                    reference.add_derivatives(t, weight, out);
                }
            }
            Self::MinimumTime(plan) => plan.add_derivatives(t, weight, out),
            Self::Spline(spline) => spline.add_derivatives(t, weight, out),
            Self::SmoothSpline(spline) => spline.add_derivatives(t, weight, out),
        }
    }

    fn smoothness(&self) -> Option<usize> {
        match self {
            Self::Hold(_) | Self::Sines { .. } | Self::Zhao { .. } => None,
            Self::Polynomial(polynomial) => polynomial.smoothness(),
            Self::FilteredStep { order, .. } => Some(*order),
            Self::MinimumTime(plan) => plan.smoothness(),
            Self::Spline(spline) => spline.smoothness(),
            Self::SmoothSpline(spline) => spline.smoothness(),
        }
    }
}
