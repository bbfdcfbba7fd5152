//! The scenario file: which robot, from where, following what, driven how, for how long.

mod controller;
mod ground;
mod integrator;
mod motion;
mod plant;
mod read;
mod reference;
mod shaper;
mod validate;
mod walk;

pub use controller::{Controller, Gains, InverseOf, LqrDeviations, RigidModel};
pub use ground::Ground;
pub use integrator::Integrator;
pub use plant::{Factors, Plant};
pub use read::ScenarioFile;
pub use reference::{JointReference, References, SineTerm};
pub use shaper::{InputShaper, ModesOf, Motors, ShaperMode, ShaperModes, ShaperType};
pub use walk::{Believes, Walk};

use crate::error::{Error, ErrorKind};
use crate::load::yaml::Keys;
use gyroflex::model::Fidelity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A scenario: a robot, a motion for it to follow, and how to simulate it. SI units, radians; torques and motor positions are
/// on the link side of the gears.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// The robot: a robot YAML or a URDF, relative to this file.
    pub robot: String,
    /// Which physics of the motors to keep; default: the robot's own choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<ModelName>,
    /// Acceleration of gravity in world axes [m/s²]; default: the robot's own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<[f64; 3]>,
    /// Simulated time [s].
    pub duration: f64,
    /// State at time 0.
    #[serde(default)]
    pub initial: Initial,
    /// The motion to follow: a reference per joint name, `default` for joints not named, or `csv` for a file with all of them.
    #[serde(default)]
    pub reference: References,
    /// A shaper that all references pass, so that they leave no vibration behind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shaper: Option<InputShaper>,
    /// What drives the motors.
    #[serde(default)]
    pub controller: Controller,
    /// What the simulated robot has that its controller does not know; default: nothing, both are the robot of the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plant: Option<Plant>,
    /// The ground, which the robot's contact points may touch; default: there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ground: Option<Ground>,
    /// External loads on links.
    #[serde(default)]
    pub wrenches: Vec<Wrench>,
    /// The integration scheme.
    #[serde(default)]
    pub integrator: Integrator,
    /// What is written down.
    #[serde(default)]
    pub log: Log,
}

/// Which physics of the motors a model keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModelName {
    /// Elastic transmissions, every rotor a body of its own.
    Complete,
    /// Elastic transmissions, a rotor's energy that of its own spin alone.
    Reduced,
    /// Rigid gears with the full gyroscopics of the rotors.
    Rigid,
    /// Rigid gears, reflected rotor inertia on the diagonal only.
    RigidReflected,
}

impl From<ModelName> for Fidelity {
    fn from(name: ModelName) -> Self {
        match name {
            ModelName::Complete => Self::Complete,
            ModelName::Reduced => Self::Reduced,
            ModelName::Rigid => Self::Rigid,
            ModelName::RigidReflected => Self::RigidReflected,
        }
    }
}

/// State at time 0; whatever is not given starts on the reference, with the transmissions in static equilibrium.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Link positions [rad or m]; default: the reference at time 0.
    #[serde(default)]
    pub q: JointValues,
    /// Link velocities [rad/s or m/s]; default: those of the reference at time 0.
    #[serde(default)]
    pub qd: JointValues,
    /// Motor positions reflected through the gears [rad or m]; default: static equilibrium of the transmissions under gravity
    /// and the wrenches at time 0.
    #[serde(default)]
    pub theta: JointValues,
    /// Reflected motor velocities [rad/s or m/s]; default: the link velocities.
    #[serde(default)]
    pub thetad: JointValues,
    /// Modal coordinates of links that bend, by the names of the modes [m, in torsion rad]; default: static equilibrium of the links
    /// under gravity and the wrenches at time 0.
    #[serde(default, skip_serializing_if = "JointValues::is_empty")]
    pub eta: JointValues,
    /// Rates of the modal coordinates [m/s, in torsion rad/s]; default: 0.
    #[serde(default, skip_serializing_if = "JointValues::is_empty")]
    pub etad: JointValues,
    /// Pose and twist of a floating root; default: at the world's origin, at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub base: Option<Base>,
}

/// Pose and twist of a floating root.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Base {
    /// Position in the world [m].
    #[serde(default)]
    pub xyz: [f64; 3],
    /// Roll, pitch and yaw about the world's axes, as in URDF [rad].
    #[serde(default)]
    pub rpy: [f64; 3],
    /// Twist in the root link's own axes, angular part first [rad/s, m/s].
    #[serde(default)]
    pub twist: [f64; 6],
}

/// A number per joint: a map from joint names, or a list over all joints in coordinate order.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a map from joint names to numbers, or a list of numbers in coordinate order")]
pub enum JointValues {
    /// By name; joints not named keep their default.
    Named(BTreeMap<String, f64>),
    /// In coordinate order.
    Ordered(Vec<f64>),
}

impl JointValues {
    /// Whether nothing is given.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Named(map) => map.is_empty(),
            Self::Ordered(list) => list.is_empty(),
        }
    }
}

impl Default for JointValues {
    fn default() -> Self {
        Self::Named(BTreeMap::new())
    }
}

/// A load on a link over a span of time.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wrench {
    /// Name of the link.
    pub link: String,
    /// Force [N].
    #[serde(default)]
    pub force: [f64; 3],
    /// Couple, the moment about `point` [N m].
    #[serde(default)]
    pub torque: [f64; 3],
    /// Axes in which force and torque are given.
    #[serde(default)]
    pub frame: WrenchFrame,
    /// Where the force acts, in the link's frame [m]; default: its origin.
    #[serde(default)]
    pub point: [f64; 3],
    /// When it starts [s].
    #[serde(default)]
    pub start: f64,
    /// When it ends [s]; default: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end: Option<f64>,
}

/// Axes of a wrench.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WrenchFrame {
    /// The world's.
    #[default]
    World,
    /// The link's.
    Link,
}

/// What is written down.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Log {
    /// Samples a second [Hz].
    pub rate: f64,
}

impl Default for Log {
    fn default() -> Self {
        Self { rate: 1000.0 }
    }
}

/// The JSON Schema of the scenario file.
pub fn scenario_schema() -> serde_json::Value {
    schemars::schema_for!(Scenario).to_value()
}

/// An error about the value of a scenario's key.
pub(crate) fn fault(keys: &Keys, key: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
    Error { kind: ErrorKind::Scenario, ..keys.error(key, problem, remedy) }
}
