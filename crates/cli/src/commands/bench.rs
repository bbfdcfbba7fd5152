//! `gyroflex bench`: what the algorithms take of a control period here.

use super::load;
use crate::args::Bench;
use crate::failure::{Failure, print, say};
use crate::progress::{STEPS, progress_bar, show, stop_flag};
use gyroflex_sim::bench::{self, Algorithm};
use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::{Fidelity, Robot};
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Whoever waits no longer than this needs no bar.
const PATIENCE: Duration = Duration::from_secs(2);

pub fn run(args: &Bench, quiet: bool) -> Result<(), Failure> {
    let robot = load(&args.robot, args.floating, &args.set, quiet)?;
    let models = models(&robot, args.model.map(Into::into));
    let stop = stop_flag(quiet, "print what has been finished");
    let bar = progress_bar(true, "measuring");
    let start = Instant::now();
    let report = bench::bench(&robot, &models, args.calls as usize, &mut |share| {
        if !quiet && bar.is_hidden() && start.elapsed() > PATIENCE {
            show(&bar);
        }
        bar.set_position((share * STEPS as f64) as u64);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    let report = report?;
    let text = if args.json { serde_json::to_string_pretty(&report).map_err(unprintable)? } else { report.to_string() };
    print(&text)?;
    if report.rows.len() < models.len() * Algorithm::ALL.len() {
        say("interrupted; the table has what was finished");
        return Err(Failure::Interrupted);
    }
    Ok(())
}

/// The model asked for, or all that differ.
fn models(robot: &Robot, asked: Option<Fidelity>) -> Vec<Fidelity> {
    match asked {
        Some(fidelity) => vec![fidelity],
        None if robot.bodies.iter().all(|b| b.drive.is_none()) => vec![robot.fidelity],
        None => Fidelity::ALL.to_vec(),
    }
}

fn unprintable(e: serde_json::Error) -> Error {
    Error {
        kind: ErrorKind::Io,
        file: "standard output".to_owned(),
        element: String::new(),
        problem: format!("the table cannot be written as JSON: {e}"),
        remedy: "leave out --json".to_owned(),
    }
}
