//! What an analysis found.

use super::bounds::Bounds;
use crate::error::Error;
use serde::Serialize;

/// What an analysis found. SI units, angles in radians; torques of sliding joints are forces [N].
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Name of the robot.
    pub robot: String,
    /// What was analysed: `workspace`, `scenario` or `log`.
    pub of: String,
    /// The scenario or log, by its path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Instants looked at.
    pub samples: usize,
    /// Seed of the samples of a workspace.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Time from rest to top speed of the motions in a workspace [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rise: Option<f64>,
    /// What the error of a model that is enough stays below [% of a joint's peak torque].
    pub threshold_percent: f64,
    /// One entry per joint of one degree of freedom, in coordinate order.
    pub joints: Vec<JointReport>,
    /// The significance ratio.
    pub significance: SignificanceRange,
    /// Whether the reduced model is enough at all speeds analysed.
    pub reduced_is_enough: bool,
    /// Share of the speeds analysed up to which it is enough, at most 1; errors grow with its square.
    pub enough_up_to: f64,
    /// The same in words.
    pub verdict: String,
    /// Bounds over the joint limits, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounds: Option<Bounds>,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// One joint.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct JointReport {
    /// Name of the joint.
    pub name: String,
    /// Whether it slides: m and N instead of rad and N m.
    pub slides: bool,
    /// Its largest speed in the analysis [rad/s or m/s].
    pub top_speed: f64,
    /// Torque through the transmission, `τ_J`.
    pub tau_j: Side,
    /// Motor torque `τ`, reflected.
    pub tau: Side,
    /// Speed of this joint from which on the error passes the threshold, with the whole motion run through faster or
    /// slower [rad/s or m/s]; `None` where it does not up to `top_speed`.
    pub threshold_speed: Option<f64>,
    /// Whether the reduced model is enough, in words.
    pub verdict: String,
}

/// Torque and torque error on one side of a transmission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Side {
    /// Largest torque [N m or N].
    pub peak: f64,
    /// Root mean square of the torque.
    pub rms: f64,
    /// Largest error of the reduced model [N m or N].
    pub error_max: f64,
    /// Root mean square of the error.
    pub error_rms: f64,
    /// Largest error [% of the peak torque].
    pub error_max_percent: f64,
    /// Root mean square of the error [% of the peak torque].
    pub error_rms_percent: f64,
}

/// The significance ratio `r_s` (Zhao et al. 2015, eq. 12) over all instants.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct SignificanceRange {
    /// Smallest `r_s` met.
    pub r_s_lowest: f64,
    /// Largest `r_s` met.
    pub r_s_highest: f64,
    /// Smallest `r_s` of any velocity at the poses met.
    pub r_s_min: f64,
    /// Largest `r_s` of any velocity at the poses met.
    pub r_s_max: f64,
    /// The pose where the largest `|r_s|` of any velocity is, `nq` entries.
    pub at: Vec<f64>,
    /// Largest of the bounds `2 σ_max(S) / σ_min(M_l)` met.
    pub bound_singular_values: f64,
}

impl Report {
    /// The report as indented JSON.
    ///
    /// # Errors
    /// None that a report can have; the type is that of the library beneath.
    pub fn to_json(&self) -> Result<String, Error> {
        Ok(serde_json::to_string_pretty(self)?)
    }
}

impl JointReport {
    /// The larger error of both sides [%].
    pub fn worst_percent(&self) -> f64 {
        self.tau_j.error_max_percent.max(self.tau.error_max_percent)
    }

    /// A speed of this joint as people read it.
    pub fn speed_text(&self, speed: f64) -> String {
        if self.slides { format!("{speed:.3} m/s") } else { format!("{:.1} deg/s", speed.to_degrees()) }
    }
}
