//! `gyroflex modes`: how a robot swings by itself.

use super::{output, pose};
use crate::args::Modes;
use crate::failure::{Failure, print, say};
use crate::json;
use crate::plot;
use gyroflex_sim::linearize::{ModeKind, NaturalMode, Output, natural_modes};
use serde_json::json as value;
use std::fmt::Write;

pub fn run(args: &Modes, quiet: bool) -> Result<(), Failure> {
    let mut linearizer = pose::linearizer(&args.pose, quiet)?;
    let point = pose::equilibrium(&mut linearizer, &args.pose, quiet)?;
    let linear = linearizer.linearize(&point, &Output::defaults())?;
    let modes = natural_modes(&linear)?;
    let robot = linearizer.robot();
    let positions = &linear.states[..linear.states.len() / 2];
    if let Some(path) = &args.plot {
        let title = format!("{}, {} model", robot.name, robot.fidelity.name());
        output::write(path, &plot::modes(path, &title, positions, &modes)?, &args.pose.robot)?;
        if !quiet {
            say(&format!("written: {}", path.display()));
        }
    }
    if args.json {
        let all = value!({
            "robot": robot.name, "model": robot.fidelity.name(), "q": point.state.q, "theta": point.state.theta,
            "tau": point.tau, "positions": positions, "modes": modes,
        });
        return print(&json::text(&all));
    }
    let mut out = format!("{}, {} model\n", robot.name, robot.fidelity.name());
    if modes.is_empty() {
        return print(&(out + "it has no joints, and no modes"));
    }
    let widest = modes.iter().map(|m| m.moves_most.chars().count()).max().unwrap_or(0).max("moves most".len());
    let line = |cells: [&str; 4], shape: &str| {
        let [kind, frequency, damping, most] = cells;
        format!("  {kind:<11}  {frequency:>14}  {damping:>13}  {most:<widest$}  {shape}").trim_end().to_owned() + "\n"
    };
    out += &line(["kind", "frequency [Hz]", "damping ratio", "moves most"], "shape");
    for mode in &modes {
        let frequency = if mode.kind == ModeKind::Rigid { "0".to_owned() } else { plot::digits(mode.frequency) };
        let damping = mode.damping_ratio.map_or("-".to_owned(), ratio);
        out += &line([kind(mode.kind), &frequency, &damping, &mode.moves_most], &shape(mode, positions));
    }
    out.push_str("  (frequencies are |λ|/2π; shapes are relative to what moves most, links q and motors θ seen from the link side)");
    print(&out)
}

fn kind(kind: ModeKind) -> &'static str {
    match kind {
        ModeKind::Oscillation => "oscillation",
        ModeKind::Decay => "decay",
        ModeKind::Growth => "growth",
        ModeKind::Rigid => "rigid",
    }
}

/// Four digits, rounding of an undamped mode without its sign.
fn ratio(z: f64) -> String {
    if z.abs() < 5e-5 { "0.0000".to_owned() } else { format!("{z:.4}") }
}

/// What else moves: the largest entries but the first, with the sign of their real part.
fn shape(mode: &NaturalMode, positions: &[String]) -> String {
    let size = |i: usize| mode.shape[i][0].hypot(mode.shape[i][1]);
    let mut order: Vec<usize> = (0..positions.len()).filter(|i| size(*i) >= 0.05).collect();
    order.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    let mut text = String::new();
    for &i in order.iter().filter(|i| positions[**i] != mode.moves_most).take(4) {
        let sign = if mode.shape[i][0] < 0.0 { "-" } else { "" };
        let _ = write!(text, "{}{} {sign}{:.2}", if text.is_empty() { "" } else { ", " }, positions[i], size(i));
    }
    text
}
