//! References as a scenario names them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The motion to follow.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct References {
    /// A CSV file, relative to this file: a column `time` [s] and a column per joint [rad or m], at least two rows. Between
    /// rows it is a cubic spline, outside of them it holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub csv: Option<String>,
    /// A reference per joint name; `default` stands for the joints not named, and is `{type: hold}` when absent.
    #[serde(flatten)]
    pub joints: BTreeMap<String, JointReference>,
}

/// The motion one joint is to follow, a function of time with two derivatives.
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
