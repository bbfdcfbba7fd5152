//! `gyroflex compare`: scenarios in, one table out.

use crate::args::Compare;
use crate::failure::{Failure, print, warn};
use crate::progress::{STEPS, progress_bar};
use gyroflex_sim::ScenarioFile;
use gyroflex_sim::compare::{Compared, Variation, compare};
use gyroflex_sim::load::{Disk, LoadOptions};
use serde_json::json;

/// A scenario and its runs, the plant as it is first.
struct Row {
    name: String,
    controller: &'static str,
    shaped: bool,
    runs: Vec<Compared>,
}

pub fn run(args: &Compare, quiet: bool) -> Result<(), Failure> {
    let plants = Variation::all(&args.stiffness, &args.payload);
    let bar = progress_bar(quiet, "comparing");
    let mut rows = Vec::with_capacity(args.scenarios.len());
    for (i, path) in args.scenarios.iter().enumerate() {
        let file = ScenarioFile::load_with(&Disk, path, &args.set.overrides())?;
        let robot = file.load_robot(&Disk, &LoadOptions::default())?;
        warn(&robot.warnings, quiet);
        rows.push(Row {
            name: path.file_stem().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned()),
            controller: file.scenario.controller.name(),
            shaped: file.scenario.shaper.is_some(),
            runs: compare(&robot, &file, args.tip.as_deref(), &plants)?,
        });
        bar.set_position((i + 1) as u64 * STEPS / args.scenarios.len() as u64);
    }
    bar.finish_and_clear();
    if args.json {
        let rows: Vec<_> = rows
            .iter()
            .map(|r| json!({"scenario": r.name, "controller": r.controller, "shaped": r.shaped, "runs": r.runs}))
            .collect();
        return print(&serde_json::to_string_pretty(&rows).map_err(gyroflex_sim::error::Error::from)?);
    }
    print(&text(&rows, plants.len()))
}

fn text(rows: &[Row], plants: usize) -> String {
    let widest = rows.iter().map(|r| r.name.chars().count()).max().unwrap_or(0).max("scenario".len());
    let mut out = String::new();
    let mut line = |name: &str, cells: &[String]| {
        let cells: Vec<_> = cells.iter().map(|c| format!("{c:>11}")).collect();
        out.push_str(format!("{name:<widest$}  {}", cells.join("  ")).trim_end());
        out.push('\n');
    };
    let head = ["rms error", "peak error", "residual", "peak torque"].map(str::to_owned);
    let mut titles = head.to_vec();
    if plants > 1 {
        titles.extend(["worst rms", "worst peak", "worst resid.", "worst torque"].map(str::to_owned));
    }
    line("scenario", &titles);
    let mut notes = Vec::new();
    for row in rows {
        let numbers = |c: &Compared| [c.rms_error * 1e3, c.peak_error * 1e3, c.residual_vibration * 1e3, c.peak_torque];
        let Some(nominal) = row.runs.first() else { continue };
        let mut cells = numbers(nominal).to_vec();
        if plants > 1 {
            let worst =
                row.runs.iter().map(numbers).fold([0.0_f64; 4], |a, b| std::array::from_fn(|i| worse(a[i], b[i])));
            cells.extend(worst);
        }
        line(&row.name, &cells.iter().map(|x| format!("{x:.4}")).collect::<Vec<_>>());
        for run in &row.runs {
            if let Some(why) = &run.diverged {
                let Variation { stiffness, payload } = run.plant;
                notes.push(format!("{} (stiffness × {stiffness}, payload × {payload}): {why}", row.name));
            }
        }
        let saturated = row.runs.iter().map(|run| run.saturated).fold(0.0, f64::max);
        if saturated > 0.0 {
            notes.push(format!(
                "{}: torques cut off at up to {:.2} % of the ticks of a run",
                row.name,
                100.0 * saturated
            ));
        }
    }
    out.push_str("(tip errors and residual vibration in mm, torques in N m on the link side");
    if plants > 1 {
        out.push_str(&format!("; worst of {plants} plants"));
    }
    out.push(')');
    for note in notes {
        out.push_str(&format!("\n{note}"));
    }
    out
}

/// What is not a number is worst.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
