//! The ground as a scenario names it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Level ground under the robot's contact points: it pushes upwards, holds by friction, and never pulls.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ground {
    /// Its height in the world [m].
    #[serde(default)]
    pub height: f64,
    /// Coulomb's coefficient of friction.
    pub friction: f64,
    /// Ratio of the speed of separation to that of approach in an impact: 0 is plastic.
    #[serde(default)]
    pub restitution: f64,
    /// Speed of approach below which an impact is plastic in any case [m/s]: a bouncing point comes to rest.
    #[serde(default = "resting_speed")]
    pub resting_speed: f64,
    /// Whether the robot moves in the plane of x and z alone, so that nothing holds it along y.
    #[serde(default)]
    pub planar: bool,
}

fn resting_speed() -> f64 {
    1e-3
}
