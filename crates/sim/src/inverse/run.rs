//! `gyroflex inverse`: motors and torques along the reference of a scenario.

use super::{OutputInverse, with_least_damping};
use crate::coordinates::Coordinates;
use crate::dynamics::Dynamics;
use crate::error::{Error, Warning};
use crate::loads::Loads;
use crate::record::{Recorder, RunInfo};
use crate::reference::{Point, References};
use crate::robot::Robot;
use crate::scenario::ScenarioFile;
use crate::simulate::{Sampler, StateVec};
use crate::zeros::{InverseOutput, InverseStability, Verdict};
use gyroflex::model::Fidelity;
use gyroflex::spatial::Vec3;
use serde::Serialize;
use std::ops::ControlFlow;
use std::time::Instant;

/// Poses at which the internal dynamics are looked at.
const POSES: usize = 32;

/// The longest step of the deflections of damped transmissions [s].
const LONGEST_STEP: f64 = 1e-4;

/// The longest step of links that swing, in radians of the fastest swing.
const RADIANS_A_STEP: f64 = 0.2;

/// An inverse along a scenario's reference, ready to run.
#[derive(Clone, Debug)]
pub struct InverseRun {
    robot: Robot,
    file: ScenarioFile,
    joints: Coordinates,
    references: References,
    along: OutputInverse,
    /// The inverted model, for what is logged besides.
    dynamics: Dynamics,
    sampler: Sampler,
    stability: InverseStability,
    /// What the user should know.
    pub warnings: Vec<Warning>,
}

/// What came out.
#[derive(Clone, Debug, Serialize)]
pub struct InverseSummary {
    /// The robot.
    pub robot: String,
    /// The inverted model.
    pub model: &'static str,
    /// Time covered [s].
    pub end_time: f64,
    /// Whether the run was stopped.
    pub interrupted: bool,
    /// Samples recorded.
    pub samples: u64,
    /// Mean time of one inverse, of the motors' motion with its references and the step of the links [µs].
    pub time_per_call: f64,
    /// One entry per joint.
    pub joints: Vec<JointInverse>,
    /// What becomes of its internal dynamics, the deflections of damped transmissions or the links behind their motors, over poses within the
    /// joints' limits.
    pub stability: InverseStability,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// The largest values of one joint; torques are reflected.
#[derive(Clone, Debug, Default, Serialize)]
pub struct JointInverse {
    /// Its name.
    pub name: String,
    /// Derivatives of its position that the torques depend on.
    pub derivatives_needed: u8,
    /// Derivatives that its reference has; `None` for all.
    pub derivatives_given: Option<usize>,
    /// Motor torque [N m or N].
    pub peak_torque: f64,
    /// Torque through the transmission [N m or N].
    pub peak_transmission_torque: f64,
    /// Deflection of the transmission [rad or m].
    pub peak_deflection: f64,
    /// Motor speed [rad/s or m/s].
    pub peak_motor_speed: f64,
}

impl InverseRun {
    /// Prepares the inverse of `robot` in the model `fidelity`, else the scenario's or the robot's, with at least `damping` in its
    /// transmissions; the references are those of `output`.
    ///
    /// # Errors
    /// Everything in the scenario that does not fit the robot, and references that are not smooth enough.
    pub fn new(
        robot: &Robot,
        file: &ScenarioFile,
        fidelity: Option<Fidelity>,
        damping: f64,
        output: InverseOutput,
    ) -> Result<Self, Error> {
        let scenario = &file.scenario;
        let mut robot = with_least_damping(robot, damping);
        if let Some(gravity) = scenario.gravity {
            robot.gravity = Vec3::from(gravity);
        }
        robot.fidelity = fidelity.or(scenario.model.map(Into::into)).unwrap_or(robot.fidelity);
        let mut warnings = Vec::new();
        let joints = Coordinates::of(&robot);
        let q0 = joints.spread(&scenario.initial.q, &file.keys, "initial.q")?;
        let references = References::of(file, &robot, &joints, &q0, &mut warnings)?;
        if !scenario.wrenches.is_empty() {
            warnings.push(Warning {
                file: file.keys.locate("wrenches"),
                element: "wrenches".to_owned(),
                message: "they do not act on the inverse".to_owned(),
            });
        }
        let along = OutputInverse::new(&robot, robot.fidelity, output, (&joints, &references), &file.keys)?;
        let dynamics = Dynamics::new(robot.model(robot.fidelity)?);
        let sampler = Sampler::new(&robot, &joints, &dynamics)?;
        let stability = InverseStability::of(&robot, output, POSES)?;
        warnings.extend(warning(&stability, &file.source.name));
        Ok(Self { robot, file: file.clone(), joints, references, along, dynamics, sampler, stability, warnings })
    }

    /// What a recorder must know before the first sample.
    pub fn run_info(&self) -> RunInfo {
        let mut info = RunInfo::new(&self.robot, self.robot.fidelity);
        for source in std::iter::once(&self.file.source).chain(&self.file.csv) {
            info.attachments.push((source.name.clone(), source.text.clone()));
        }
        let scenario = &self.file.scenario;
        for (key, value) in [
            ("gyroflex", env!("CARGO_PKG_VERSION").to_owned()),
            ("kind", "inverse".to_owned()),
            ("robot", self.robot.name.clone()),
            ("scenario", self.file.source.name.clone()),
            ("model", self.robot.fidelity.name().to_owned()),
            ("duration", scenario.duration.to_string()),
            ("log_rate", scenario.log.rate.to_string()),
        ] {
            info.metadata.push((key.to_owned(), value));
        }
        info
    }

    /// Samples of an uninterrupted run.
    pub fn expected_samples(&self) -> u64 {
        (self.file.scenario.duration * self.file.scenario.log.rate * (1.0 + 1e-12)) as u64 + 1
    }

    /// Runs along the reference and records as many samples as the scenario asks for; `progress` is told the time [s] and may stop it. The
    /// recorder is completed in any case.
    ///
    /// # Errors
    /// Torques that are not finite, transmissions that cannot be inverted, a recorder that failed.
    pub fn run(
        &mut self,
        recorder: &mut dyn Recorder,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<InverseSummary, Error> {
        let done = self.samples(recorder, progress);
        let finished = recorder.finish();
        let summary = done?;
        finished?;
        Ok(summary)
    }

    fn samples(
        &mut self,
        recorder: &mut dyn Recorder,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<InverseSummary, Error> {
        let rate = self.file.scenario.log.rate;
        // Links that bend swing by themselves, which takes steps short against a radian of the fastest swing.
        let swing = self.stability.fastest.as_ref().filter(|_| self.stability.bends).map(|at| at.zero.size());
        let longest = swing.map_or(LONGEST_STEP, |size| LONGEST_STEP.min(RADIANS_A_STEP / size));
        let steps = (1.0 / rate / longest).ceil().max(1.0);
        let step = 1.0 / rate / steps;
        let mut loads = Loads::new(&[], &self.robot, &self.file.keys)?;
        let mut points = vec![Point::default(); self.joints.len()];
        let mut summary = self.empty_summary();
        let (mut calls, mut time) = (0_u32, 0.0);
        self.along.start(&self.references)?;
        for sample in 0..self.expected_samples() {
            let t = sample as f64 / rate;
            for i in 0..steps as u32 {
                self.along.look(&self.references, t + f64::from(i) * step);
                let now = t + f64::from(i) * step;
                let mut started = Instant::now();
                self.along.invert(&self.references, now, step)?;
                time += started.elapsed().as_secs_f64();
                calls += 1;
                if i == 0 {
                    self.references.points(t, &mut points);
                    self.take(t, &points, &mut loads)?;
                    recorder.record(&self.sampler.sample)?;
                    self.tally(&mut summary);
                }
                started = Instant::now();
                self.along.advance(&self.references, now, step)?;
                time += started.elapsed().as_secs_f64();
            }
            (summary.end_time, summary.samples) = (t, sample + 1);
            if progress(t).is_break() {
                summary.interrupted = sample + 1 < self.expected_samples();
                break;
            }
        }
        summary.time_per_call = 1e6 * time / f64::from(calls.max(1));
        Ok(summary)
    }

    /// One sample: the state that the inverse says the robot is in, under the torques it says the motors need.
    fn take(&mut self, t: f64, points: &[Point], loads: &mut Loads) -> Result<(), Error> {
        let along = &self.along;
        let state = StateVec {
            q: along.q().to_vec(),
            qd: along.qd().to_vec(),
            theta: along.theta().to_vec(),
            thetad: along.thetad().to_vec(),
        };
        self.sampler.take(t, &mut self.dynamics, state.view(), along.tau(), loads, None, points)
    }

    fn empty_summary(&self) -> InverseSummary {
        let joint = |(i, joint): (usize, &crate::coordinates::Coordinate)| JointInverse {
            name: joint.name.clone(),
            derivatives_needed: self.along.needed(joint.body),
            derivatives_given: self.references.smoothness(i),
            ..JointInverse::default()
        };
        InverseSummary {
            robot: self.robot.name.clone(),
            model: self.robot.fidelity.name(),
            end_time: 0.0,
            interrupted: false,
            samples: 0,
            time_per_call: 0.0,
            joints: self.joints.joints.iter().enumerate().map(joint).collect(),
            stability: self.stability.clone(),
            warnings: self.warnings.iter().map(Warning::to_string).collect(),
        }
    }

    fn tally(&self, summary: &mut InverseSummary) {
        let sample = &self.sampler.sample;
        for (i, joint) in summary.joints.iter_mut().enumerate() {
            joint.peak_torque = joint.peak_torque.max(sample.tau[i].abs());
            joint.peak_transmission_torque = joint.peak_transmission_torque.max(sample.tau_j[i].abs());
            joint.peak_deflection = joint.peak_deflection.max(sample.deflection[i].abs());
            joint.peak_motor_speed = joint.peak_motor_speed.max(sample.thetad[i].abs());
        }
    }
}

/// What the user should know of internal dynamics that do not fade. A transmission without damping is no such case: where the links are given, its
/// inverse has no state.
fn warning(stability: &InverseStability, file: &str) -> Option<Warning> {
    if stability.bends && stability.verdict != Verdict::Stable {
        return Some(Warning {
            file: file.to_owned(),
            element: "flexible_links".to_owned(),
            message: format!("{}; give the links damping", stability.reason),
        });
    }
    let (motion, remedy) = match (stability.output, stability.verdict) {
        (_, Verdict::Stable) | (InverseOutput::Link, Verdict::Undamped) => return None,
        (InverseOutput::Link, Verdict::Unstable) => ("grow", "prescribe the motors (`--prescribe motor`)"),
        (InverseOutput::Motor, Verdict::Undamped) => ("do not fade", "add damping to the inverse (`--damping`)"),
        (InverseOutput::Motor, Verdict::Unstable) => ("grow", "prescribe the links (`--prescribe link`)"),
    };
    Some(Warning {
        file: file.to_owned(),
        element: "reference".to_owned(),
        message: format!("the internal dynamics of its inverse {motion}: {}; {remedy}", stability.reason),
    })
}
