//! Controllers side by side: how far the tip of a robot strays, and how it vibrates when it should stand still.

use crate::dynamics::Dynamics;
use crate::error::{Error, ErrorKind};
use crate::link_frame::LinkFrame;
use crate::load::nearest::nearest;
use crate::record::{Recorder, Sample};
use crate::robot::Robot;
use crate::scenario::{Factors, Plant, ScenarioFile};
use crate::simulate::Simulation;
use gyroflex::spatial::{Transform, Vec3};
use serde::Serialize;
use std::ops::ControlFlow;

/// A plant that the controller does not know: the scenario's own, with further factors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Variation {
    /// Factor on all springs of transmissions [–].
    pub stiffness: f64,
    /// Factor on the load that the robot carries [–].
    pub payload: f64,
}

impl Variation {
    /// The plant as the scenario has it.
    pub const NONE: Self = Self { stiffness: 1.0, payload: 1.0 };

    /// All pairs of these factors, the scenario's plant first.
    pub fn all(stiffness: &[f64], payload: &[f64]) -> Vec<Self> {
        let with_one = |factors: &[f64]| -> Vec<f64> {
            std::iter::once(1.0).chain(factors.iter().copied().filter(|f| *f != 1.0)).collect()
        };
        let (stiffness, payload) = (with_one(stiffness), with_one(payload));
        stiffness.iter().flat_map(|s| payload.iter().map(|p| Self { stiffness: *s, payload: *p })).collect()
    }

    fn apply(self, plant: &mut Option<Plant>) -> Result<(), Error> {
        if self == Self::NONE {
            return Ok(());
        }
        let plant = plant.get_or_insert_default();
        if plant.stiffness.is_some() && self.stiffness != 1.0 || plant.payload_factor.is_some() && self.payload != 1.0 {
            return Err(error("plant", "the scenario has such a factor already", "take it out of the scenario"));
        }
        if self.stiffness != 1.0 {
            plant.stiffness = Some(Factors::All(self.stiffness));
        }
        if self.payload != 1.0 {
            plant.payload_factor = Some(self.payload);
        }
        Ok(())
    }
}

/// One run.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    /// The plant.
    pub plant: Variation,
    /// Root mean square of the distance of the tip from where the reference has it [m].
    pub rms_error: f64,
    /// Largest distance [m].
    pub peak_error: f64,
    /// Largest distance of the tip from its mean place after the references have come to rest [m]; zero if they never do.
    pub residual_vibration: f64,
    /// Largest motor torque of any joint, reflected [N m or N].
    pub peak_torque: f64,
    /// Share of all ticks and joints at which a torque was cut off [–].
    pub saturated: f64,
    /// Why it ended early, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diverged: Option<String>,
}

/// Runs a scenario once for each plant; `tip` is a link of the robot, by default its last.
///
/// # Errors
/// Everything that is wrong with the scenario, and an unknown link. A run that diverges is no error: it is said in its row.
pub fn compare(
    robot: &Robot,
    file: &ScenarioFile,
    tip: Option<&str>,
    plants: &[Variation],
) -> Result<Vec<Compared>, Error> {
    plants.iter().map(|plant| run(robot, file, tip, *plant)).collect()
}

fn run(robot: &Robot, file: &ScenarioFile, tip: Option<&str>, plant: Variation) -> Result<Compared, Error> {
    let mut file = file.clone();
    plant.apply(&mut file.scenario.plant)?;
    let mut simulation = Simulation::new(robot, &file)?;
    let mut tips = Tips::new(simulation.nominal(), tip)?;
    let mut row = Compared {
        plant,
        rms_error: f64::NAN,
        peak_error: f64::NAN,
        residual_vibration: f64::NAN,
        peak_torque: f64::NAN,
        saturated: f64::NAN,
        diverged: None,
    };
    match simulation.run(&mut tips, &mut |_| ControlFlow::Continue(())) {
        Ok(summary) => {
            row.peak_torque = summary.joints.iter().fold(0.0, |most, j| j.peak_torque.max(most));
            row.saturated =
                summary.joints.iter().map(|j| j.saturation).sum::<f64>() / summary.joints.len().max(1) as f64;
            (row.rms_error, row.peak_error) = tips.errors();
            row.residual_vibration = tips.residual();
        }
        Err(e) if e.kind == ErrorKind::Diverged => row.diverged = Some(e.problem),
        Err(e) => return Err(e),
    }
    Ok(row)
}

/// Places of the tip, as it is and as the reference has it.
struct Tips {
    dynamics: Dynamics,
    link: LinkFrame,
    poses: Vec<Transform<f64>>,
    last_reference: Vec<f64>,
    actual: Vec<Vec3<f64>>,
    wanted: Vec<Vec3<f64>>,
    /// Samples up to the last at which the reference moved.
    moving: usize,
}

/// How far a reference may move between samples and count as standing still [rad or m].
const STILL: f64 = 1e-7;

impl Tips {
    fn new(robot: &Robot, tip: Option<&str>) -> Result<Self, Error> {
        if robot.is_floating() {
            return Err(error("robot", "its root floats, and a reference says nothing of it", "fix the root"));
        }
        let names = || robot.links.iter().map(|l| l.name.as_str());
        let index = match tip {
            None => robot.links.len().checked_sub(1),
            Some(name) => robot.links.iter().position(|l| l.name == name),
        };
        let index = index.ok_or_else(|| {
            let near = nearest(tip.unwrap_or_default(), names()).unwrap_or("none");
            let problem = format!("the robot has no link `{}`", tip.unwrap_or_default());
            error("tip", &problem, &format!("the nearest known one is `{near}`"))
        })?;
        Ok(Self {
            dynamics: Dynamics::new(robot.model(robot.fidelity)?),
            link: LinkFrame::new(robot, index),
            poses: vec![Transform::identity(); robot.bodies.len()],
            last_reference: Vec::new(),
            actual: Vec::new(),
            wanted: Vec::new(),
            moving: 0,
        })
    }

    /// The tip with the joints at `q` and the modes of links that bend at `eta`.
    fn place(&mut self, q: &[f64], eta: &[f64]) -> Result<Vec3<f64>, Error> {
        self.dynamics.placements(&[q, eta].concat(), &mut self.poses)?;
        Ok(self.link.pose(&self.poses, eta).pos)
    }

    fn errors(&self) -> (f64, f64) {
        let distances = self.actual.iter().zip(&self.wanted).map(|(a, b)| (*a - *b).norm());
        let (mut sum, mut peak) = (0.0, 0.0_f64);
        for d in distances {
            sum += d * d;
            peak = peak.max(d);
        }
        ((sum / self.actual.len().max(1) as f64).sqrt(), peak)
    }

    fn residual(&self) -> f64 {
        let after = &self.actual[self.moving.min(self.actual.len())..];
        let mut mean = Vec3::zero();
        for p in after {
            mean += p.scale(1.0 / after.len() as f64);
        }
        after.iter().map(|p| (*p - mean).norm()).fold(0.0, f64::max)
    }
}

impl Recorder for Tips {
    fn record(&mut self, sample: &Sample) -> Result<(), Error> {
        let moved = |(a, b): (&f64, &f64)| (a - b).abs() > STILL;
        if self.last_reference.iter().zip(&sample.reference).any(moved) {
            self.moving = self.actual.len() + 1;
        }
        self.last_reference.clone_from(&sample.reference);
        let (actual, wanted) =
            (self.place(&sample.q, &sample.eta)?, self.place(&sample.reference, &vec![0.0; sample.eta.len()])?);
        self.actual.push(actual);
        self.wanted.push(wanted);
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        Ok(())
    }
}

fn error(element: &str, problem: &str, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Scenario,
        file: String::new(),
        element: element.to_owned(),
        problem: problem.to_owned(),
        remedy: remedy.to_owned(),
    }
}
