//! What a run amounted to.

use crate::contact::Event;
use crate::controller::Control;
use crate::coordinates::Coordinates;
use crate::modes::Mode;
use crate::record::Sample;
use serde::Serialize;

/// The numbers of a finished run.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The robot's name.
    pub robot: String,
    /// The model: `complete`, `reduced`, `rigid` or `rigid_reflected`.
    pub model: &'static str,
    /// The integration scheme.
    pub integrator: &'static str,
    /// Simulated time asked for [s].
    pub duration: f64,
    /// Simulated time reached [s].
    pub end_time: f64,
    /// Whether the run was stopped from outside before its end.
    pub interrupted: bool,
    /// Number of samples recorded.
    pub samples: u64,
    /// Number of integration steps.
    pub steps: u64,
    /// Time the run took [s].
    pub wall_time: f64,
    /// Simulated time over the time it took [–].
    pub real_time_factor: f64,
    /// The fastest natural mode at the initial pose; absent without elastic transmissions.
    pub fastest_mode: Option<Mode>,
    /// The largest stable step of the scheme, by that mode and the fastest decay [s]; absent for adaptive schemes.
    pub largest_step: Option<f64>,
    /// Largest change of the total energy over the largest kinetic energy [–]; only for runs without motor torques, loads,
    /// friction and damping.
    pub energy_drift: Option<f64>,
    /// What happened to contacts with the ground; empty without.
    pub events: Vec<Event>,
    /// Names of the contacts that the events number.
    pub contacts: Vec<String>,
    /// Largest error of position of all that was held [m or rad]; absent where nothing was.
    pub constraint_drift: Option<f64>,
    /// One entry per joint.
    pub joints: Vec<JointSummary>,
    /// What the user should know about the run.
    pub warnings: Vec<String>,
}

/// The numbers of one joint.
#[derive(Clone, Debug, Serialize)]
pub struct JointSummary {
    /// Its name.
    pub name: String,
    /// Root mean square of reference minus position over the samples [rad or m].
    pub rms_tracking_error: f64,
    /// Largest distance from the reference among the samples [rad or m].
    pub peak_tracking_error: f64,
    /// Largest motor torque, reflected [N m or N].
    pub peak_torque: f64,
    /// Share of the controller's ticks at which it asked for more than the drive can give [–].
    pub saturation: f64,
}

/// Sums over the samples of a run.
#[derive(Clone, Debug)]
pub(super) struct Tally {
    squares: Vec<f64>,
    peaks: Vec<f64>,
    pub(super) samples: u64,
    first_energy: f64,
    drift: f64,
    kinetic: f64,
    conservative: bool,
}

impl Tally {
    pub(super) fn new(joints: usize) -> Self {
        Self {
            squares: vec![0.0; joints],
            peaks: vec![0.0; joints],
            samples: 0,
            first_energy: 0.0,
            drift: 0.0,
            kinetic: 0.0,
            conservative: true,
        }
    }

    pub(super) fn add(&mut self, sample: &Sample) {
        let energy = sample.kinetic_energy + sample.gravity_energy + sample.elastic_energy;
        if self.samples == 0 {
            self.first_energy = energy;
        }
        self.samples += 1;
        self.drift = self.drift.max((energy - self.first_energy).abs());
        self.kinetic = self.kinetic.max(sample.kinetic_energy);
        self.conservative &= sample.power_in == 0.0 && sample.dissipation == 0.0;
        for (i, error) in sample.tracking_error.iter().enumerate() {
            self.squares[i] += error * error;
            self.peaks[i] = self.peaks[i].max(error.abs());
        }
    }

    pub(super) fn energy_drift(&self) -> Option<f64> {
        (self.conservative && self.kinetic > 0.0).then(|| self.drift / self.kinetic)
    }

    pub(super) fn joints(&self, joints: &Coordinates, control: &Control) -> Vec<JointSummary> {
        let share = |part: u64, whole: u64| if whole == 0 { 0.0 } else { part as f64 / whole as f64 };
        let joint = |(i, name): (usize, &str)| JointSummary {
            name: name.to_owned(),
            rms_tracking_error: (self.squares[i] / self.samples.max(1) as f64).sqrt(),
            peak_tracking_error: self.peaks[i],
            peak_torque: control.peak_torque()[i],
            saturation: share(control.saturated()[i], control.ticks()),
        };
        joints.names().enumerate().map(joint).collect()
    }
}
