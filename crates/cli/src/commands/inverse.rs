//! `gyroflex inverse`: a scenario's reference in, motor motions and torques out.

use super::logs;
use crate::args::Inverse;
use crate::failure::{Failure, print, say, warn};
use crate::progress::{STEPS, progress_bar, stop_flag};
use gyroflex_sim::ScenarioFile;
use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::inverse::{InverseRun, InverseSummary};
use gyroflex_sim::load::{Disk, LoadOptions};
use gyroflex_sim::record::{CsvRecorder, McapRecorder, TeeRecorder};
use gyroflex_sim::zeros::{AtPose, InverseOutput, Verdict};
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::Ordering;

pub fn run(args: &Inverse, quiet: bool) -> Result<(), Failure> {
    let mut file = ScenarioFile::load_with(&Disk, &args.scenario, &args.set.overrides())?;
    if let Some(duration) = args.duration {
        file.scenario.duration = duration;
    }
    let robot = file.load_robot(&Disk, &LoadOptions::default())?;
    warn(&robot.warnings, quiet);
    let model = args.model.map(Into::into);
    let mut inverse = InverseRun::new(&robot, &file, model, args.damping, args.prescribe.into())?;
    warn(&inverse.warnings, quiet);

    let log = logs::path(args.output.as_deref(), &args.scenario, "inverse.mcap");
    logs::spare_the_input(&log, args.output.as_deref(), args.csv.as_deref(), Some(&args.scenario))?;
    let stop = stop_flag(quiet, "complete the log");
    let info = inverse.run_info();
    let mut recorder = TeeRecorder::new().with(McapRecorder::create(&log, info.clone())?);
    if let Some(csv) = &args.csv {
        recorder = recorder.with(CsvRecorder::create(csv, info)?);
    }
    let bar = progress_bar(quiet, "inverting");
    let result = inverse.run(&mut recorder, &mut |t| {
        bar.set_position((t / file.scenario.duration * STEPS as f64) as u64);
        if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    bar.finish_and_clear();
    let summary = result.inspect_err(|e| {
        if e.kind == ErrorKind::Diverged {
            say(&format!("log up to there: {}", log.display()));
        }
    })?;
    print(&if args.json {
        json(&summary, &log, args.csv.as_deref())?
    } else {
        text(&summary, &log, args.csv.as_deref())
    })?;
    if summary.interrupted {
        say(&format!("interrupted at t = {} s; the log is complete up to there", summary.end_time));
        return Err(Failure::Interrupted);
    }
    Ok(())
}

fn json(summary: &InverseSummary, log: &Path, csv: Option<&Path>) -> Result<String, Error> {
    let mut json = serde_json::to_value(summary)?;
    json["log"] = log.display().to_string().into();
    json["csv"] = csv.map(|p| p.display().to_string()).into();
    Ok(serde_json::to_string_pretty(&json)?)
}

fn text(s: &InverseSummary, log: &Path, csv: Option<&Path>) -> String {
    let mut out =
        format!("{}, inverse of the {} model: {} s, {:.1} us a call\n", s.robot, s.model, s.end_time, s.time_per_call);
    let widest = s.joints.iter().map(|j| j.name.chars().count()).max().unwrap_or(0).max("joint".len());
    let mut line = |cells: [&str; 6]| {
        let [name, derivatives, motor, joint, deflection, speed] = cells;
        let text =
            format!("  {name:<widest$}  {derivatives:>11}  {motor:>11}  {joint:>12}  {deflection:>11}  {speed:>11}");
        out.push_str(text.trim_end());
        out.push('\n');
    };
    line(["joint", "derivatives", "motor", "transmission", "deflection", "motor speed"]);
    for j in &s.joints {
        let given = j.derivatives_given.map_or_else(|| "any".to_owned(), |n| n.to_string());
        let [motor, joint, deflection, speed] =
            [j.peak_torque, j.peak_transmission_torque, j.peak_deflection, j.peak_motor_speed]
                .map(|x| format!("{x:.4e}"));
        let derivatives = format!("{} of {given}", j.derivatives_needed);
        line([&j.name, &derivatives, &motor, &joint, &deflection, &speed]);
    }
    out.push_str(
        "  (derivatives needed and given; largest torques in N m, deflections in rad, speeds in rad/s, link side)\n",
    );
    let _ = writeln!(out, "internal dynamics: {}", internal(s));
    let _ = write!(out, "log: {} ({} samples)", log.display(), s.samples);
    if let Some(csv) = csv {
        let _ = write!(out, "\ncsv: {}", csv.display());
    }
    out
}

/// What becomes of what moves inside the inverse.
fn internal(s: &InverseSummary) -> String {
    let stability = &s.stability;
    let verdict = match stability.verdict {
        Verdict::Stable => "stable",
        Verdict::Undamped => "undamped",
        Verdict::Unstable => "unstable",
    };
    if stability.bends {
        return format!("{verdict}, of links that bend: {}", stability.reason);
    }
    let needed = s.joints.iter().map(|j| j.derivatives_needed).max().unwrap_or(0);
    let Some(AtPose { zero, q }) = &stability.slowest else {
        return match (stability.output, stability.verdict) {
            (InverseOutput::Link, Verdict::Undamped) => format!(
                "none, {needed} derivatives of the reference in their place: no transmission is damped (`--damping` and `--prescribe motor` \
                 need fewer)"
            ),
            _ => "none".to_owned(),
        };
    };
    let rate = zero.value[0];
    let slowest = if rate > 0.0 { format!("grows by {rate:.4e} 1/s") } else { format!("fades by {:.4e} 1/s", -rate) };
    let pose: Vec<String> = q.iter().map(|q| format!("{q:.3}")).collect();
    let slowest = format!("{verdict}, the slowest, of joint `{}`, {slowest} at q = [{}]", zero.joint, pose.join(", "));
    match (stability.output, stability.verdict) {
        (_, Verdict::Stable) => slowest,
        (InverseOutput::Link, _) => {
            format!("{slowest}; {} (`--damping` and `--prescribe motor` need fewer)", stability.reason)
        }
        (InverseOutput::Motor, Verdict::Undamped) => {
            format!("{verdict}, {} (`--damping` adds damping to the inverse)", stability.reason)
        }
        (InverseOutput::Motor, Verdict::Unstable) => {
            format!("{slowest} (`--prescribe link` leads the links themselves)")
        }
    }
}
