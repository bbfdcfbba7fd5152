//! Motions that were simulated: of a scenario, or of a log.

use super::{Motion, Options, Report, error, fault};
use crate::coordinates::Coordinates;
use crate::error::{Error, ErrorKind};
use crate::record::{MemoryRecorder, Table, read_states};
use crate::robot::Robot;
use crate::scenario::{ModelName, ScenarioFile};
use crate::simulate::Simulation;
use std::ops::ControlFlow;
use std::path::Path;

/// Simulates a scenario with the complete model and analyses the motion. `progress` is told the simulated time [s] now and then
/// and may end the run; the motion up to there is analysed.
///
/// # Errors
/// Options that mean nothing, a floating root, and what can go wrong in a simulation.
pub fn of_scenario(
    robot: &Robot,
    file: &ScenarioFile,
    options: &Options,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Report, Error> {
    options.check()?;
    let asked = file.scenario.model.filter(|m| *m != ModelName::Complete);
    let Simulated { robot, motions, notes, interrupted_at } = simulated(robot, file, ModelName::Complete, progress)?;
    let mut report = error::compare(&robot, &motions, options)?;
    report.of = "scenario".to_owned();
    report.file = Some(file.path.display().to_string());
    if asked.is_some() {
        report.notes.push("the scenario asks for another model; it was simulated with the complete one".to_owned());
    }
    if let Some(end) = interrupted_at {
        report.notes.push(format!("interrupted: only the first {end} s were simulated"));
    }
    report.notes.extend(notes);
    Ok(report)
}

/// The motion of a run.
pub(crate) struct Simulated {
    /// The robot that was simulated, with the scenario's changes.
    pub(crate) robot: Robot,
    /// One per sample of the log.
    pub(crate) motions: Vec<Motion>,
    /// Warnings of the run.
    pub(crate) notes: Vec<String>,
    /// When it ended too early [s], if it did.
    pub(crate) interrupted_at: Option<f64>,
}

/// Simulates a scenario with a model of the caller's choice, and keeps its motion.
pub(crate) fn simulated(
    robot: &Robot,
    file: &ScenarioFile,
    model: ModelName,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Simulated, Error> {
    refuse_floating(robot)?;
    let mut file = file.clone();
    file.scenario.model = Some(model);
    let mut simulation = Simulation::new(robot, &file)?;
    let mut memory = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut memory, progress)?;
    let robot = simulation.robot().clone();
    let motions = motions(&robot, &memory.table(), "")?;
    let notes = simulation.warnings().iter().map(ToString::to_string).collect();
    Ok(Simulated { robot, motions, notes, interrupted_at: summary.interrupted.then_some(summary.end_time) })
}

/// Analyses the motion in a log that `gyroflex simulate` has written.
///
/// # Errors
/// Options that mean nothing, a floating root, a file that is no log of ours, or the log of another robot.
pub fn of_log(robot: &Robot, path: &Path, options: &Options) -> Result<Report, Error> {
    options.check()?;
    refuse_floating(robot)?;
    let log = read_states(path)?;
    let name = path.display().to_string();
    let mut report = error::compare(robot, &motions(robot, &log.table, &name)?, options)?;
    report.of = "log".to_owned();
    report.file = Some(name);
    if !log.complete {
        report.notes.push("the log was cut short; what reached the file is analysed".to_owned());
    }
    Ok(report)
}

fn refuse_floating(robot: &Robot) -> Result<(), Error> {
    if !robot.is_floating() {
        return Ok(());
    }
    let problem = "the robot has a floating root, whose acceleration is not recorded".to_owned();
    Err(fault(&robot.name, problem, "analyse its workspace, or load it with a fixed root"))
}

/// The motions in a table of states.
fn motions(robot: &Robot, table: &Table, file: &str) -> Result<Vec<Motion>, Error> {
    let joints = Coordinates::of(robot);
    let wrong = |element: String, problem: String| Error {
        kind: ErrorKind::Shape,
        file: file.to_owned(),
        element,
        problem,
        remedy: "give the log of a run of this robot".to_owned(),
    };
    let recorded = table.columns.iter().filter_map(|c| c.name.strip_prefix("q.")).collect::<Vec<_>>();
    if let Some(other) = recorded.iter().find(|name| !joints.names().any(|n| n == **name)) {
        return Err(wrong(format!("joint `{other}`"), format!("it is not a joint of `{}`", robot.name)));
    }
    let columns = |quantity: &str| -> Result<Vec<&[f64]>, Error> {
        let column = |name: &str| {
            let missing = || wrong(format!("joint `{name}`"), format!("there is no `{quantity}` of it"));
            table.get(&format!("{quantity}.{name}")).ok_or_else(missing)
        };
        joints.names().map(column).collect()
    };
    let quantities = ["q", "qd", "qdd", "theta", "thetad", "thetadd", "tau_j", "tau"];
    let all = quantities.into_iter().map(columns).collect::<Result<Vec<_>, _>>()?;
    let times = table.get("time").unwrap_or_default();
    if times.is_empty() {
        return Err(wrong(String::new(), "there is not one sample".to_owned()));
    }
    let motion = |(row, t): (usize, &f64)| {
        let at = |quantity: usize| all[quantity].iter().map(|column| column[row]).collect::<Vec<f64>>();
        Motion {
            t: *t,
            q: at(0),
            qd: at(1),
            qdd: at(2),
            theta: at(3),
            thetad: at(4),
            thetadd: at(5),
            torques: Some([at(6), at(7)]),
        }
    };
    Ok(times.iter().enumerate().map(motion).collect())
}
