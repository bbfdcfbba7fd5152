//! The motion along which terms are weighed.

use super::Simplify;
use crate::analyze::{Motion, Options, Simulated, motions, ranges, simulated};
use crate::error::{Error, ErrorKind};
use crate::robot::Robot;
use crate::scenario::ModelName;
use gyroflex::model::Fidelity;
use gyroflex_codegen::weigh;
use std::ops::ControlFlow;

/// Tolerances that a table shows beside the one asked for.
pub(super) const TOLERANCES: [f64; 7] = [0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6, 0.0];

/// Samples of a motion that are weighed at most: more of them say the same.
const SAMPLES: usize = 250;

/// States and accelerations: of a scenario, or all over the workspace. `None` if `progress` ended the simulation.
pub(super) fn of(
    robot: &Robot,
    fidelity: Fidelity,
    simplify: &Simplify,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Vec<weigh::Motion>>, Error> {
    let bends = !robot.flexible.is_empty();
    let Some(file) = &simplify.along else {
        if bends {
            let problem = "links bend, and how far they do follows from a motion only".to_owned();
            return Err(refused(robot, problem, "give a scenario with --along"));
        }
        let options = Options { samples: SAMPLES, ..Options::default() };
        return Ok(Some(thinned(&motions(robot, &ranges(robot, &options), &options))));
    };
    let mut going_on = true;
    let mut told = |_: f64| {
        going_on = progress(0.0);
        if going_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let Simulated { motions, .. } = simulated(robot, file, named(fidelity), &mut told)?;
    Ok(going_on.then(|| thinned(&motions)))
}

fn named(fidelity: Fidelity) -> ModelName {
    match fidelity {
        Fidelity::Complete => ModelName::Complete,
        Fidelity::Reduced => ModelName::Reduced,
        Fidelity::Rigid => ModelName::Rigid,
        Fidelity::RigidReflected => ModelName::RigidReflected,
    }
}

/// Evenly spaced ones of all samples.
fn thinned(motions: &[Motion]) -> Vec<weigh::Motion> {
    let step = motions.len().div_ceil(SAMPLES).max(1);
    let motion = |m: &Motion| weigh::Motion {
        q: m.q.clone(),
        qd: m.qd.clone(),
        theta: m.theta.clone(),
        thetad: m.thetad.clone(),
        qdd: m.qdd.clone(),
        thetadd: m.thetadd.clone(),
    };
    motions.iter().step_by(step).map(motion).collect()
}

fn refused(robot: &Robot, problem: String, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Scenario,
        file: robot.sources.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(", "),
        element: "--simplify-to".to_owned(),
        problem,
        remedy: remedy.to_owned(),
    }
}
