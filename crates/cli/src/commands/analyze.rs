//! `gyroflex analyze`: when do the rotors matter.

use super::output;
use crate::args::Analyze;
use crate::failure::{Failure, print, say};
use crate::progress::{STEPS, progress_bar, stop_flag};
use crate::{json, plot};
use gyroflex_sim::analyze::{self, Options, Report};
use gyroflex_sim::error::Error;
use gyroflex_sim::load::Disk;
use gyroflex_sim::{Robot, ScenarioFile};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::Ordering;

pub fn run(args: &Analyze, quiet: bool) -> Result<(), Failure> {
    let robot = super::load(&args.robot, args.floating, &args.set, quiet)?;
    let defaults = Options::default();
    let options = Options {
        samples: args.samples.map_or(defaults.samples, |n| n as usize),
        seed: args.seed,
        speed: args.speed.map(f64::to_radians),
        rise: args.rise.unwrap_or(defaults.rise),
        threshold: args.threshold,
        bounds: args.bounds,
    };
    let (report, interrupted) = match (&args.scenario, &args.log) {
        (Some(scenario), _) => along(&robot, scenario, &options, quiet)?,
        (None, Some(log)) => (analyze::of_log(&robot, log, &options)?, false),
        (None, None) => (analyze::of_workspace(&robot, &options)?, false),
    };
    if let Some(path) = &args.plot {
        output::write(path, &plot::analysis(path, &report)?, &args.robot)?;
        if !quiet {
            say(&format!("written: {}", path.display()));
        }
    }
    if args.json {
        let value = serde_json::to_value(&report).map_err(Error::from)?;
        print(&json::text(&value))?;
    } else {
        print(&report.to_string())?;
    }
    if interrupted { Err(Failure::Interrupted) } else { Ok(()) }
}

/// Analyses a scenario; the second says whether it was interrupted.
fn along(robot: &Robot, scenario: &Path, options: &Options, quiet: bool) -> Result<(Report, bool), Failure> {
    let file = ScenarioFile::load(&Disk, scenario)?;
    let stop = stop_flag(quiet, "end the simulation");
    let bar = progress_bar(quiet, "simulating");
    let report = analyze::of_scenario(robot, &file, options, &mut |t| {
        bar.set_position((t / file.scenario.duration * STEPS as f64) as u64);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    Ok((report?, stop.load(Ordering::Relaxed)))
}
