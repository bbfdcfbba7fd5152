//! Controllers as a scenario names them.

use super::{ModelName, Walk};
use crate::zeros::InverseOutput;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What drives the motors. Torques are held between the ticks of the controller and limited to each drive's `max_torque`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum Controller {
    /// Nothing: motor torques are zero.
    None {},
    /// PD on the motor side, on `theta`: `tau = g(q_ref) + kp (theta_ref − theta) + kd (thetad_ref − thetad)` with
    /// `theta_ref = q_ref + K⁻¹ g(q_ref)`.
    Pd {
        /// Ticks a second [Hz].
        #[serde(default = "default_rate")]
        rate: f64,
        /// Position gains [N m/rad or N/m].
        kp: Gains,
        /// Velocity gains [N m s/rad or N s/m].
        kd: Gains,
        /// Whether gravity at the reference is fed forward, as torque and as deflection; without it `theta_ref = q_ref`.
        #[serde(default = "yes")]
        gravity_compensation: bool,
    },
    /// Inverse dynamics of the rigid robot, fed with motor positions less the static deflection:
    /// `tau = M (qdd_ref + kp (theta_ref − theta) + kd (thetad_ref − thetad)) + C + g + friction`.
    ComputedTorque {
        /// Ticks a second [Hz].
        #[serde(default = "default_rate")]
        rate: f64,
        /// Position gains [1/s²].
        kp: Gains,
        /// Velocity gains [1/s].
        kd: Gains,
        /// The model the controller inverts.
        #[serde(default)]
        model: RigidModel,
    },
    /// The inverse of the elastic robot, and PD on the motors around the motion that it finds (Thümmel, Otter & Bals):
    /// `tau = tau_inverse + kp (theta_inverse − theta) + kd (thetad_inverse − thetad)`. References must be smooth enough for the inverse.
    TwoDegreeOfFreedom {
        /// Ticks a second [Hz].
        #[serde(default = "default_rate")]
        rate: f64,
        /// Position gains [N m/rad or N/m].
        kp: Gains,
        /// Velocity gains [N m s/rad or N s/m].
        kd: Gains,
        /// What is inverted.
        #[serde(default)]
        inverse: InverseOf,
    },
    /// The inverse of the elastic robot, and feedback of the whole state around the motion that it finds, with the gain of a linear-quadratic
    /// regulator for the robot in equilibrium where the references are at the end of the run.
    Lqr {
        /// Ticks a second [Hz].
        #[serde(default = "default_rate")]
        rate: f64,
        /// Deviations that count the same in its cost.
        deviations: LqrDeviations,
        /// What is inverted.
        #[serde(default)]
        inverse: InverseOf,
    },
    /// Feedback linearization of the reduced model, with the whole state measured: every joint becomes `(s + bandwidth)^r`, `r` being 3 with
    /// damped transmissions and 4 with undamped ones. All joints must be elastic.
    FeedbackLinearization {
        /// Ticks a second [Hz].
        #[serde(default = "default_rate")]
        rate: f64,
        /// Bandwidths of the closed loops [rad/s].
        bandwidth: Gains,
    },
    /// The walk of a planar biped.
    Walk(Box<Walk>),
}

/// The deviations that a linear-quadratic regulator weighs against each other, by Bryson's rule: each costs as much as the others when it is
/// this large.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LqrDeviations {
    /// Of link positions [rad or m].
    pub link_position: f64,
    /// Of link velocities [rad/s or m/s].
    pub link_velocity: f64,
    /// Of motor positions, reflected [rad or m].
    pub motor_position: f64,
    /// Of motor velocities, reflected [rad/s or m/s].
    pub motor_velocity: f64,
    /// Of motor torques, reflected [N m or N].
    pub torque: f64,
}

/// Which inverse a controller feeds forward.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InverseOf {
    /// The model that is inverted; default: the one that the scenario or the robot names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<ModelName>,
    /// Least damping of the transmissions in the inverse [N m s/rad or N s/m]: undamped joints need fewer derivatives with it.
    #[serde(default)]
    pub damping: f64,
    /// What follows the reference: the links, or the motors around which they swing. For the motors two derivatives of it are enough.
    #[serde(default)]
    pub output: InverseOutput,
}

impl Default for Controller {
    fn default() -> Self {
        Self::None {}
    }
}

impl Controller {
    /// Its name in files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::None {} => "none",
            Self::Pd { gravity_compensation: false, .. } => "pd",
            Self::Pd { .. } => "pd with gravity",
            Self::ComputedTorque { .. } => "computed_torque",
            Self::TwoDegreeOfFreedom { .. } => "two_degree_of_freedom",
            Self::Lqr { .. } => "lqr",
            Self::FeedbackLinearization { .. } => "feedback_linearization",
            Self::Walk(_) => "walk",
        }
    }

    /// Ticks a second [Hz]; `None` without a controller.
    pub fn rate(&self) -> Option<f64> {
        match self {
            Self::None {} => None,
            Self::Pd { rate, .. }
            | Self::ComputedTorque { rate, .. }
            | Self::TwoDegreeOfFreedom { rate, .. }
            | Self::Lqr { rate, .. }
            | Self::FeedbackLinearization { rate, .. } => Some(*rate),
            Self::Walk(walk) => Some(walk.rate),
        }
    }
}

/// A gain: one number for all joints, or a map from joint names, where `default` stands for the joints not named.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or a map from joint names (and `default`) to numbers")]
pub enum Gains {
    /// The same for all joints.
    All(f64),
    /// By joint name.
    Named(BTreeMap<String, f64>),
}

/// The rigid model that a computed torque controller inverts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RigidModel {
    /// With the full gyroscopics of the rotors.
    #[default]
    Rigid,
    /// With reflected rotor inertia on the diagonal only.
    RigidReflected,
}

fn default_rate() -> f64 {
    1000.0
}

fn yes() -> bool {
    true
}
