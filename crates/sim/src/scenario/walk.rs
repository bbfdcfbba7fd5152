//! The walking controller as a scenario names it.

use crate::gait::Gait;
use crate::walk::Sliding;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A planar biped walks under sliding mode control (Mu & Wu 2004), from the middle of a step on. The robot has the joints `hip_x`, `hip_z`,
/// `trunk_pitch`, `left_hip`, `left_knee`, `right_hip` and `right_knee`; feet have no mass, and the ankle of the leg that stands or is in front exerts a
/// torque. The scenario needs `ground`, and starts on the gait unless it says where.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Walk {
    /// Ticks a second [Hz].
    #[serde(default = "rate")]
    pub rate: f64,
    /// The gait to follow.
    pub gait: Gait,
    /// Names of the contact points of the left and the right foot.
    #[serde(default = "feet")]
    pub feet: [String; 2],
    /// The law on one foot, for the angles of all joints.
    pub single: Sliding,
    /// The law on both feet, for hip and trunk.
    pub double: Sliding,
    /// Part of the robot's weight that the law on both feet would leave to the rear foot, at the beginning and at the end of that time.
    #[serde(default = "rear_share")]
    pub rear_share: [f64; 2],
    /// What the controller takes the robot for.
    #[serde(default)]
    pub believes: Believes,
    /// Damping of elastic transmissions by their motors, `−damping (θ̇ − q̇)` [N m s/rad].
    #[serde(default)]
    pub damping: f64,
}

/// What a controller takes a robot for: factors on the parameters of its file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Believes {
    /// On masses and moments of inertia.
    #[serde(default = "one")]
    pub mass: f64,
    /// On lengths and places of centres of mass.
    #[serde(default = "one")]
    pub length: f64,
    /// Whether it knows of the reflected inertias of the rotors.
    #[serde(default = "yes")]
    pub rotors: bool,
}

impl Default for Believes {
    fn default() -> Self {
        Self { mass: 1.0, length: 1.0, rotors: true }
    }
}

fn rate() -> f64 {
    1000.0
}

fn feet() -> [String; 2] {
    ["left_foot".to_owned(), "right_foot".to_owned()]
}

fn rear_share() -> [f64; 2] {
    [0.5, 0.1]
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}
