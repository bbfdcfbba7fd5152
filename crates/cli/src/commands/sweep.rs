//! `gyroflex sweep`: a scenario and values in, a table out.

use super::logs;
use crate::args::Sweep;
use crate::failure::{Failure, print, say};
use crate::progress::{STEPS, progress_bar, stop_flag};
use gyroflex_sim::sweep::{Grid, Outcome, Table, measure, run_in_order};
use serde_json::json;
use std::ops::ControlFlow;
use std::sync::atomic::Ordering;
use std::time::Instant;

pub fn run(args: &Sweep, quiet: bool) -> Result<(), Failure> {
    let grid = Grid { axes: args.set.clone() };
    let output = logs::path(args.output.as_deref(), &args.scenario, "sweep.csv");
    logs::spare_the_input(&output, args.output.as_deref(), None, Some(&args.scenario))?;
    let stop = stop_flag(quiet, "keep the runs that are done");
    let one = |run: usize| -> Option<Outcome> {
        let mut go_on =
            |_| if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        if go_on(0.0).is_break() {
            return None;
        }
        measure(&args.scenario, &grid.overrides(run), &mut go_on).transpose()
    };

    let started = Instant::now();
    let mut table = Table::open(&output, grid.clone())?;
    let (runs, kept) = (grid.len(), table.rows());
    if kept > 0 {
        if let Some(outcome) = one(kept - 1) {
            table.check_last(outcome)?;
        }
        if !quiet {
            say(&format!("{kept} of {runs} runs are in {} already", output.display()));
        }
    }
    let threads =
        args.jobs.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), |jobs| jobs as usize);
    let bar = progress_bar(quiet, "sweeping");
    let (mut done, mut failed) = (kept, 0);
    let result = run_in_order(kept..runs, threads, &one, &mut |run, outcome| {
        failed += usize::from(outcome.is_err());
        table.push(run, outcome)?;
        done = run + 1;
        bar.set_position(done as u64 * STEPS / runs as u64);
        Ok(())
    });
    bar.finish_and_clear();
    result?;
    if done < runs {
        say(&format!("interrupted after {done} of {runs} runs; the same command goes on from there"));
        return Err(Failure::Interrupted);
    }
    table.finish()?;
    let (ran, wall_time) = (done - kept, started.elapsed().as_secs_f64());
    if args.json {
        let file = output.display().to_string();
        return print(
            &json!({ "output": file, "runs": runs, "ran": ran, "failed": failed, "wall_time": wall_time }).to_string(),
        );
    }
    print(&format!("{ran} runs in {wall_time:.2} s, {failed} of them failed: {}", output.display()))
}
