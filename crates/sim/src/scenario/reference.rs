//! References as a scenario names them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The motion to follow.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct References {
    /// A CSV file, relative to this file: a column `time` [s] and a column per joint [rad or m], at least two rows. Between
    /// rows it is a spline, outside of them it holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub csv: Option<String>,
    /// Degree of the spline through the rows of the CSV file, odd, from 3 to 15; it has as many derivatives, the last of which jumps.
    /// Default: 3.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub degree: Option<usize>,
    /// A reference per joint name; `default` stands for the joints not named, and is `{type: hold}` when absent.
    #[serde(flatten)]
    pub joints: BTreeMap<String, JointReference>,
}

/// The motion one joint is to follow, a function of time with derivatives.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum JointReference {
    /// Stays where it is.
    Hold {
        /// Position [rad or m]; default: the initial position, or 0.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<f64>,
    },
    /// `offset + amplitude sin(2π frequency t + phase)`.
    Sine {
        /// Amplitude [rad or m].
        amplitude: f64,
        /// Frequency [Hz].
        frequency: f64,
        /// Phase [rad].
        #[serde(default)]
        phase: f64,
        /// Offset [rad or m].
        #[serde(default)]
        offset: f64,
    },
    /// `offset + Σ amplitude sin(2π frequency t + phase)`.
    Sines {
        /// Offset [rad or m].
        #[serde(default)]
        offset: f64,
        /// The terms of the sum.
        terms: Vec<SineTerm>,
    },
    /// The trajectory of Zhao, Yu, Wang and Tomizuka: `offset + A² cos ωt + A sin ωt + exp(−A ω t)`, which starts with
    /// neither velocity nor acceleration, at `offset + A² + 1`.
    Zhao {
        /// `A` [–], > 0.
        amplitude: f64,
        /// `ω` [rad/s].
        omega: f64,
        /// Offset [rad or m].
        #[serde(default)]
        offset: f64,
    },
    /// From one position to another along a polynomial of fifth degree, at rest and without acceleration at both ends.
    Quintic {
        /// Position before [rad or m].
        from: f64,
        /// Position after [rad or m].
        to: f64,
        /// When the motion starts [s].
        #[serde(default)]
        start: f64,
        /// How long it takes [s].
        duration: f64,
    },
    /// From one position to another along the polynomial of degree `2 order + 1` whose first `order` derivatives vanish at both ends.
    Polynomial {
        /// Position before [rad or m].
        from: f64,
        /// Position after [rad or m].
        to: f64,
        /// When the motion starts [s].
        #[serde(default)]
        start: f64,
        /// How long it takes [s].
        duration: f64,
        /// How many derivatives vanish at the ends, from 1 to 15; 2 is the quintic.
        order: usize,
    },
    /// A step behind a low-pass filter of equal first-order lags, which has as many derivatives as lags.
    FilteredStep {
        /// Position before [rad or m].
        from: f64,
        /// Position after [rad or m].
        to: f64,
        /// When the step comes [s].
        #[serde(default)]
        start: f64,
        /// Number of lags, from 1 to 32.
        order: usize,
        /// Where the whole filter is 3 dB down [Hz].
        cutoff: f64,
    },
    /// From one position to another as fast as bounds on the derivatives allow.
    MinimumTime {
        /// Position before [rad or m].
        from: f64,
        /// Position after [rad or m].
        to: f64,
        /// When the motion starts [s].
        #[serde(default)]
        start: f64,
        /// Bounds of velocity, acceleration, jerk, … [rad/s, rad/s², rad/s³, … or m/s, …], from 1 to 16 of them.
        limits: Vec<f64>,
    },
    /// A spline through points, at rest at both ends in all derivatives that are continuous; it holds before and after.
    Waypoints {
        /// When the points are passed, increasing [s].
        times: Vec<f64>,
        /// The points [rad or m].
        positions: Vec<f64>,
        /// Degree of the spline, odd, from 3 to 15; it has as many derivatives, the last of which jumps.
        #[serde(default = "default_degree")]
        degree: usize,
    },
}

fn default_degree() -> usize {
    5
}

/// One term of a sum of sines.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SineTerm {
    /// Amplitude [rad or m].
    pub amplitude: f64,
    /// Frequency [Hz].
    pub frequency: f64,
    /// Phase [rad].
    #[serde(default)]
    pub phase: f64,
}
