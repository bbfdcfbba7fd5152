//! What a gait is described by, and what can be wrong with it.

use super::Leg;
use super::path::LANDING_AT_MIDDLE;
use crate::error::Error;
use crate::load::yaml::Keys;
use crate::scenario::fault;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The walk of a planar biped on level ground, step by step the same: a time on one foot, a time on both. SI units, radians.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gait {
    /// From one footprint to the next, which is the other foot's [m].
    pub step_length: f64,
    /// Mean speed [m/s].
    pub speed: f64,
    /// Time on both feet in each step [s], below `step_length / speed`.
    pub double_support: f64,
    /// Height of the swing foot at the middle of its way [m].
    pub clearance: f64,
    /// Speed with which the swing foot comes down on the ground [m/s]; default: 0, which needs no impact, but does not find a ground that
    /// is lower than expected.
    #[serde(default)]
    pub touchdown_speed: f64,
    /// The path of the hip.
    #[serde(default)]
    pub hip: HipPath,
    /// How far the trunk leans forward, all the time [rad].
    #[serde(default)]
    pub trunk_pitch: f64,
    /// The legs, both alike.
    pub leg: LegLengths,
}

/// Lengths of the links of a leg.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LegLengths {
    /// From hip to knee [m].
    pub thigh: f64,
    /// From knee to the point that is on the ground [m].
    pub shank: f64,
}

/// The path of the hip: forward with the mean speed, and a harmonic of the step in each direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HipPath {
    /// Mean height [m]; default: as high as the leg lengths allow with knees bent a little.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// How far above its mean height the hip is in the middle of the time on one foot [m]; it is lowest on both feet.
    #[serde(default)]
    pub rise: f64,
    /// Amplitude of the hip about its uniform motion [m]: where positive it is slowest in the middle of the time on one foot.
    #[serde(default)]
    pub surge: f64,
    /// How far the hip is ahead of the foot on the ground in the middle of the time on one foot [m].
    #[serde(default)]
    pub lead: f64,
}

impl Gait {
    /// The leg of these lengths.
    pub fn leg(&self) -> Leg {
        Leg { thigh: self.leg.thigh, shank: self.leg.shank }
    }

    /// Checks every number by itself and against those it depends on, but for the reach of the legs. `keys` are the places of a file's keys,
    /// `at` is what comes before their names there.
    pub(super) fn check(&self, keys: &Keys, at: &str) -> Result<(), Error> {
        let fail = |key: &str, problem: String, remedy: &str| Err(fault(keys, &format!("{at}{key}"), problem, remedy));
        let positive = [
            ("step_length", self.step_length),
            ("speed", self.speed),
            ("double_support", self.double_support),
            ("clearance", self.clearance),
            ("leg.thigh", self.leg.thigh),
            ("leg.shank", self.leg.shank),
            ("hip.height", self.hip.height.unwrap_or(1.0)),
        ];
        for (key, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return fail(key, format!("{value} is not a positive number"), "give a number above zero");
            }
        }
        let finite = [
            ("hip.rise", self.hip.rise),
            ("hip.surge", self.hip.surge),
            ("hip.lead", self.hip.lead),
            ("trunk_pitch", self.trunk_pitch),
        ];
        for (key, value) in finite {
            if !value.is_finite() {
                return fail(key, format!("{value} is not a finite number"), "give a finite number");
            }
        }
        let (step, single) = (self.step_time(), self.single_support());
        if single <= 0.0 {
            let problem =
                format!("{} s on both feet leave none of the {step} s of a step for a swing", self.double_support);
            return fail("double_support", problem, "give less than `step_length / speed`");
        }
        let fastest = self.clearance / (LANDING_AT_MIDDLE * single);
        if !(0.0..=fastest).contains(&self.touchdown_speed) {
            let problem = format!("{} m/s is not between 0 and {fastest} m/s", self.touchdown_speed);
            return fail("touchdown_speed", problem, "lower it, or raise `clearance`");
        }
        let most = self.step_length / TAU;
        if self.hip.surge.abs() >= most {
            let problem = format!("with an amplitude of {} m the hip would go backward in every step", self.hip.surge);
            return fail("hip.surge", problem, &format!("give less than {most} m, which is `step_length / 2π`"));
        }
        Ok(())
    }
}
