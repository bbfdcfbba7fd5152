//! Integration schemes as a scenario names them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The integration scheme. Steps end exactly at the ticks of controller and log and where a wrench starts or ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "method", rename_all = "snake_case", deny_unknown_fields)]
pub enum Integrator {
    /// Velocities first, then positions with the new velocities: first order, one evaluation a step.
    SemiImplicitEuler {
        /// Largest step [s].
        step: f64,
    },
    /// The classical Runge-Kutta scheme: fourth order, four evaluations a step.
    Rk4 {
        /// Largest step [s].
        step: f64,
    },
    /// Dormand and Prince 5(4): explicit, adaptive.
    Dopri5 {
        /// Relative tolerance of a step.
        #[serde(default = "default_rtol")]
        rtol: f64,
        /// Absolute tolerance of a step [rad, m, rad/s, m/s].
        #[serde(default = "default_atol")]
        atol: f64,
    },
    /// Dormand and Prince 8(5,3): explicit, adaptive, for tight tolerances.
    Dop853 {
        /// Relative tolerance of a step.
        #[serde(default = "default_rtol")]
        rtol: f64,
        /// Absolute tolerance of a step [rad, m, rad/s, m/s].
        #[serde(default = "default_atol")]
        atol: f64,
    },
    /// Kværnø 5(4), seven stages: implicit, L-stable, adaptive, for very stiff transmissions and friction.
    Kvaerno5 {
        /// Relative tolerance of a step.
        #[serde(default = "default_rtol")]
        rtol: f64,
        /// Absolute tolerance of a step [rad, m, rad/s, m/s].
        #[serde(default = "default_atol")]
        atol: f64,
    },
}

impl Default for Integrator {
    fn default() -> Self {
        Self::Rk4 { step: 1e-4 }
    }
}

impl Integrator {
    /// The name used in files.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::SemiImplicitEuler { .. } => "semi_implicit_euler",
            Self::Rk4 { .. } => "rk4",
            Self::Dopri5 { .. } => "dopri5",
            Self::Dop853 { .. } => "dop853",
            Self::Kvaerno5 { .. } => "kvaerno5",
        }
    }

    /// The largest step of a fixed-step scheme [s].
    pub const fn fixed_step(&self) -> Option<f64> {
        match *self {
            Self::SemiImplicitEuler { step } | Self::Rk4 { step } => Some(step),
            _ => None,
        }
    }
}

fn default_rtol() -> f64 {
    1e-8
}

fn default_atol() -> f64 {
    1e-10
}
