//! The simulated robot where it differs from the one its controller knows, as a scenario names it.

use crate::load::PayloadFile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What the simulated robot has that its controller does not know. What is left out is as in the robot's file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plant {
    /// Factors > 0 on the springs of the transmissions: on `stiffness` and `cubic`, or on the torques of a `table` [–].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<Factors>,
    /// Factors >= 0 on the damping of the transmissions [–].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<Factors>,
    /// Factors > 0 on mass and inertia of what a joint moves by itself: its link with all links fused to it, not the payload and not
    /// rotors with a mass of their own [–].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<Factors>,
    /// A factor > 0 on mass and inertia of the load it carries [–].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub payload_factor: Option<f64>,
    /// The load it carries, in place of the one in the robot's file; a `mass` of 0 takes that one off.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub payload: Option<PayloadFile>,
}

/// A factor: one number for all joints, or a map from joint names; `default` stands for the joints not named, and is 1 when absent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or a map from joint names (and `default`) to numbers")]
pub enum Factors {
    /// The same for all joints.
    All(f64),
    /// By joint name.
    Named(BTreeMap<String, f64>),
}

impl Factors {
    /// Every number with its key below `key`.
    pub(crate) fn numbers(&self, key: &str) -> Vec<(String, f64)> {
        match self {
            Self::All(factor) => vec![(key.to_owned(), *factor)],
            Self::Named(map) => map.iter().map(|(name, factor)| (format!("{key}.{name}"), *factor)).collect(),
        }
    }

    /// The factor of a joint, and whether it is named.
    pub(crate) fn of(&self, joint: &str) -> (f64, bool) {
        match self {
            Self::All(factor) => (*factor, false),
            Self::Named(map) => match map.get(joint) {
                Some(factor) => (*factor, true),
                None => (map.get("default").copied().unwrap_or(1.0), false),
            },
        }
    }
}
