//! What a sweep writes down of a run.

use crate::error::Error;
use crate::load::{Disk, LoadOptions, Overrides};
use crate::record::TeeRecorder;
use crate::simulate::Summary;
use crate::{ScenarioFile, Simulation};
use std::ops::ControlFlow;
use std::path::Path;

/// Numbers of a run by name; NaN where a run has none.
pub type Measures = Vec<(String, f64)>;

/// Runs a scenario with other values of some keys: of each joint the root mean square and the largest error of tracking, the largest
/// torque and the share of ticks at its limit; the fastest mode [Hz], the drifts of energy and of what is held, and integration steps.
/// `None` if `progress`, told the simulated time, stopped it.
///
/// # Errors
/// Everything that is wrong with the files or the keys, and a run that diverged.
pub fn measure(
    scenario: &Path,
    overrides: &Overrides,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Option<Measures>, Error> {
    let file = ScenarioFile::load_with(&Disk, scenario, overrides)?;
    let robot = file.load_robot(&Disk, &LoadOptions::default())?;
    let mut simulation = Simulation::new(&robot, &file)?;
    let summary = simulation.run(&mut TeeRecorder::new(), progress)?;
    Ok((!summary.interrupted).then(|| measures(&summary)))
}

fn measures(summary: &Summary) -> Measures {
    let mut all = Measures::new();
    for (name, of) in [
        ("rms_tracking_error", (|j| j.rms_tracking_error) as fn(&crate::simulate::JointSummary) -> f64),
        ("peak_tracking_error", |j| j.peak_tracking_error),
        ("peak_torque", |j| j.peak_torque),
        ("saturation", |j| j.saturation),
    ] {
        all.extend(summary.joints.iter().map(|joint| (format!("{name}.{}", joint.name), of(joint))));
    }
    let or_none = |x: Option<f64>| x.unwrap_or(f64::NAN);
    all.push(("fastest_mode".to_owned(), or_none(summary.fastest_mode.as_ref().map(|mode| mode.frequency))));
    all.push(("energy_drift".to_owned(), or_none(summary.energy_drift)));
    all.push(("constraint_drift".to_owned(), or_none(summary.constraint_drift)));
    all.push(("steps".to_owned(), summary.steps as f64));
    all
}
