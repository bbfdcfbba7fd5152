//! When do the rotors matter? The torque error that the reduced model (Spong 1987) makes beside the complete one (Zhao, Yu, Wang,
//! Tomizuka 2015), joint by joint, over a robot's workspace or along one motion; the significance ratio (Zhao eq. 12); bounds of
//! the matrices over the joint limits.
//!
//! The error is the difference of inverse dynamics of the two models for the same motion: `S θ̈ + C₁ θ̇` in `τ_J` (Zhao eq. 10a
//! less 11a), `Sᵀ q̈ + C₂ q̇` on top of it in `τ` (10b less 11b). It is quadratic: a motion run through `k` times as fast has
//! `k²` times the error. Its speed limit follows exactly from its value at one speed.

mod bounds;
mod error;
mod motion;
mod recorded;
mod report;
mod search;
mod significance;
mod text;
mod workspace;

pub use bounds::{Bound, Bounds, bounds, coriolis_norm};
pub use motion::Motion;
pub(crate) use recorded::{Simulated, simulated};
pub use recorded::{of_log, of_scenario};
pub use report::{JointReport, Report, Side, SignificanceRange};
pub use significance::{Significance, significance};
pub use workspace::{Range, motions, ranges};

use crate::error::{Error, ErrorKind};
use crate::robot::Robot;

/// What to analyse, and by what measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Motions drawn from the workspace, and points the search for bounds starts with.
    pub samples: usize,
    /// Where the quasi-random sequence begins: another seed, other samples.
    pub seed: u64,
    /// Top speed of all turning joints [rad/s]; `None`: each joint's own limit.
    pub speed: Option<f64>,
    /// Time in which a joint comes from rest to its top speed [s]: sets the largest acceleration of the workspace's motions.
    pub rise: f64,
    /// Share of a joint's peak torque that the error of a model that is enough stays below [%].
    pub threshold: f64,
    /// Whether to search for the bounds of `M`, `C` and `g`.
    pub bounds: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { samples: 2000, seed: 0, speed: None, rise: 0.25, threshold: 1.0, bounds: false }
    }
}

impl Options {
    /// Refuses numbers that mean nothing.
    fn check(&self) -> Result<(), Error> {
        let positive = [("speed", self.speed.unwrap_or(1.0)), ("rise", self.rise), ("threshold", self.threshold)];
        if let Some((name, value)) = positive.into_iter().find(|(_, x)| !(x.is_finite() && *x > 0.0)) {
            return Err(fault(name, format!("{value} is not above zero and finite"), "give a number above zero"));
        }
        if self.samples == 0 {
            return Err(fault("samples", "there must be at least one".to_owned(), "give a number of at least 1"));
        }
        Ok(())
    }
}

/// Analyses quasi-random motions within the limits of the joints.
///
/// # Errors
/// Options that mean nothing, a robot that is not physical in either model, or numbers that leave the finite ones.
pub fn of_workspace(robot: &Robot, options: &Options) -> Result<Report, Error> {
    options.check()?;
    let ranges = ranges(robot, options);
    let mut report = error::compare(robot, &motions(robot, &ranges, options), options)?;
    report.of = "workspace".to_owned();
    report.seed = Some(options.seed);
    report.rise = Some(options.rise);
    report.notes.splice(0..0, workspace::notes(robot, &ranges, options));
    Ok(report)
}

/// An error about an option or the thing asked for.
fn fault(element: &str, problem: String, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Shape,
        file: String::new(),
        element: element.to_owned(),
        problem,
        remedy: remedy.to_owned(),
    }
}
