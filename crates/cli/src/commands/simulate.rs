//! `gyroflex simulate`: a scenario in, a log and a summary out.

use super::logs;
use crate::args::Simulate;
use crate::builtin;
use crate::failure::{Failure, print, say, warn};
use crate::progress::{STEPS, progress_bar, stop_flag};
use crate::report::Report;
use gyroflex_sim::error::ErrorKind;
use gyroflex_sim::load::{Disk, FileSource, LoadOptions};
use gyroflex_sim::record::{CsvRecorder, McapRecorder, TeeRecorder};
use gyroflex_sim::{ScenarioFile, Simulation};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

pub fn run(args: &Simulate, quiet: bool) -> Result<(), Failure> {
    let (mut simulation, duration) = prepare(args, quiet)?;
    let log = match &args.scenario {
        Some(scenario) => logs::path(args.output.as_deref(), scenario, "mcap"),
        None => args.output.clone().unwrap_or_else(|| PathBuf::from(builtin::LOG)),
    };
    logs::spare_the_input(&log, args.output.as_deref(), args.csv.as_deref(), args.scenario.as_deref())?;
    let stop = stop_flag(quiet, "complete the log");
    let info = simulation.run_info();
    let mut recorder = TeeRecorder::new().with(McapRecorder::create(&log, info.clone())?);
    if let Some(csv) = &args.csv {
        recorder = recorder.with(CsvRecorder::create(csv, info)?);
    }

    let known = simulation.warnings().len();
    let bar = progress_bar(quiet, "simulating");
    let result = simulation.run(&mut recorder, &mut |t| {
        bar.set_position((t / duration * STEPS as f64) as u64);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    warn(&simulation.warnings()[known..], quiet);
    let summary = result.inspect_err(|e| {
        if e.kind == ErrorKind::Diverged {
            say(&format!("log up to there: {}", log.display()));
        }
    })?;

    let interrupted = summary.interrupted;
    let report = Report { summary: &summary, log: &log, csv: args.csv.as_deref() };
    print(&if args.json { report.json()? } else { report.text() })?;
    if interrupted {
        say(&format!("interrupted at t = {} s; the log is complete up to there", summary.end_time));
        return Err(Failure::Interrupted);
    }
    if !quiet {
        say(&format!("next: open {} in Foxglove (https://app.foxglove.dev), Rerun or PlotJuggler", log.display()));
    }
    Ok(())
}

/// Everything up to the first step.
fn prepare(args: &Simulate, quiet: bool) -> Result<(Simulation, f64), Failure> {
    let (files, path): (&dyn FileSource, &Path) = match &args.scenario {
        Some(path) => (&Disk, path),
        None => (&builtin::FILES, Path::new(builtin::SCENARIO)),
    };
    let mut file = ScenarioFile::load_with(files, path, &args.set.overrides())?;
    if let Some(duration) = args.duration {
        file.scenario.duration = duration;
    }
    let mut options = LoadOptions::default();
    if let Some(model) = args.model {
        options.model = Some(model.into());
        file.scenario.model = None;
    }
    let robot = file.load_robot(files, &options)?;
    warn(&robot.warnings, quiet);
    let simulation = Simulation::new(&robot, &file)?;
    warn(simulation.warnings(), quiet);
    Ok((simulation, file.scenario.duration))
}
