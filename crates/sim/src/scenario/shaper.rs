//! Input shapers as a scenario names them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A shaper that all references pass: each becomes a sum of its delayed shares, which leaves the modes named here without vibration.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InputShaper {
    /// Which shaper.
    #[serde(rename = "type")]
    pub kind: ShaperType,
    /// The modes: a list, or `linearized` for the slowest oscillations of the robot's linear model, without dry friction, in equilibrium
    /// where the references are at the end of the run.
    pub modes: ShaperModes,
    /// What the motors do in these oscillations of `linearized`; default: `held`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motors: Option<Motors>,
    /// How many modes `linearized` takes; default: 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<usize>,
    /// For `ei`: vibration left at the mode's frequency, a share of that without shaping [–], between 0 and 1; default: 0.05.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
}

impl InputShaper {
    /// The tolerance where none is given [–].
    pub const TOLERANCE: f64 = 0.05;
    /// The most modes.
    pub const MAX_MODES: usize = 4;
}

/// Which shaper, from the shortest to the most robust one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ShaperType {
    /// Zero vibration: two impulses over half a period of the mode.
    Zv,
    /// Zero vibration and derivative: three impulses over a period, no vibration nearby to first order either.
    Zvd,
    /// Extra insensitive: three impulses over a period, vibration below `tolerance` over a wide band.
    Ei,
}

/// The modes of a shaper.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "`linearized`, or a list of modes with `frequency` and `damping_ratio`")]
pub enum ShaperModes {
    /// By name.
    Of(ModesOf),
    /// As numbers.
    Given(Vec<ShaperMode>),
}

/// Where modes come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ModesOf {
    /// The robot's linear model.
    Linearized,
}

/// What the motors do while the links vibrate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Motors {
    /// They stand still, as behind a stiff position loop; undriven joints are free.
    #[default]
    Held,
    /// They move under constant torques, as `gyroflex modes` has it: behind a controller of torques alone.
    Free,
}

/// One mode.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShaperMode {
    /// Natural frequency of the undamped mode, as `gyroflex modes` prints it [Hz].
    pub frequency: f64,
    /// Damping ratio [–], from 0 to below 1.
    #[serde(default)]
    pub damping_ratio: f64,
}
