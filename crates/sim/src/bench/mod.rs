//! How much of a control period each algorithm takes on the machine at hand.

mod machine;
mod states;
mod text;
mod times;
mod work;

pub use machine::instruction_set;
pub use times::{Times, clock_cost};
pub use work::Algorithm;

use crate::error::Error;
use crate::robot::Robot;
use gyroflex::model::Fidelity;
use serde::Serialize;
use states::{Point, STATES};
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;
use work::Work;

/// The period the times are compared with [µs]: a controller of 1 kHz.
pub const PERIOD: f64 = 1000.0;

/// Calls between two words to the caller.
const CHUNK: usize = 1024;

/// What was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Name of the robot.
    pub robot: String,
    /// Number of its coordinates: length of `qd`.
    pub nv: usize,
    /// What the algorithms ran on.
    pub instruction_set: String,
    /// What reading the clock takes [ns]; taken off every time.
    pub clock_ns: f64,
    /// Calls of each algorithm.
    pub calls: usize,
    /// Random states they walk through.
    pub states: usize,
    /// One entry per model and algorithm, as far as the caller let it go.
    pub rows: Vec<Row>,
}

/// One algorithm in one model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the model.
    pub model: &'static str,
    /// Name of the algorithm.
    pub algorithm: &'static str,
    /// Its times.
    #[serde(flatten)]
    pub times: Times,
}

/// Calls every algorithm in the given models, `calls` times each, at random states inside the robot's limits, and times every
/// call. `progress` is told the share done, between calls, and may end it.
///
/// # Errors
/// A robot whose parameters are not physical.
pub fn bench(
    robot: &Robot,
    models: &[Fidelity],
    calls: usize,
    progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Report, Error> {
    robot.refuse_bending("`bench`", crate::bending::RIGID)?;
    let points = states::random(robot);
    let clock = clock_cost();
    let mut report = Report {
        robot: robot.name.clone(),
        nv: points[0].qd.len(),
        instruction_set: instruction_set(),
        clock_ns: clock as f64,
        calls,
        states: STATES,
        rows: Vec::new(),
    };
    let mut samples = Vec::with_capacity(calls);
    let of = (models.len() * Algorithm::ALL.len()) as f64;
    for fidelity in models {
        let model = robot.model(*fidelity)?;
        let mut work = Work::new(model.view());
        for algorithm in Algorithm::ALL {
            let before = report.rows.len() as f64;
            let mut inform = |calls_done: usize| progress((before + calls_done as f64 / calls as f64) / of);
            if measure(&mut work, algorithm, &points, calls, &mut samples, &mut inform)?.is_break() {
                return Ok(report);
            }
            let times = Times::of(&mut samples, clock);
            report.rows.push(Row { model: fidelity.name(), algorithm: algorithm.name(), times });
        }
    }
    Ok(report)
}

/// Times each of `calls` calls on its own [ns].
fn measure(
    work: &mut Work,
    algorithm: Algorithm,
    points: &[Point],
    calls: usize,
    samples: &mut Vec<u64>,
    inform: &mut dyn FnMut(usize) -> ControlFlow<()>,
) -> Result<ControlFlow<()>, Error> {
    samples.clear();
    for point in points {
        work.prepare(algorithm, point);
        work.call(algorithm, point)?;
    }
    for call in 0..calls {
        if call % CHUNK == 0 && inform(call).is_break() {
            return Ok(ControlFlow::Break(()));
        }
        let point = &points[call % points.len()];
        work.prepare(algorithm, point);
        let before = Instant::now();
        work.call(algorithm, black_box(point))?;
        let after = Instant::now();
        samples.push(u64::try_from((after - before).as_nanos()).unwrap_or(u64::MAX));
    }
    Ok(ControlFlow::Continue(()))
}
