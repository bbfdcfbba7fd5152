//! `gyroflex frf`: frequency response of a joint.

use super::{output, pose};
use crate::args::Frf;
use crate::failure::{Failure, print, say};
use crate::json;
use crate::plot;
use gyroflex_sim::error::Error;
use gyroflex_sim::linearize::{Extreme, Response, Sweep, bode, frequency_response};
use serde_json::json as value;
use std::fmt::Write;

pub fn run(args: &Frf, quiet: bool) -> Result<(), Failure> {
    let mut linearizer = pose::linearizer(&args.pose, quiet)?;
    let point = pose::equilibrium(&mut linearizer, &args.pose, quiet)?;
    let sweep = Sweep { from: args.from, to: args.to, points: Some(args.points as usize) };
    let response = frequency_response(&linearizer, &point, &args.joint, sweep)
        .map_err(|e| if e.element == "joint" { Error { element: "--joint".to_owned(), ..e } } else { e })?;
    let robot = linearizer.robot();
    let sliding = robot.joints.iter().any(|j| j.name == args.joint && j.urdf_type == "prismatic");
    let unit = if sliding { "m/N" } else { "rad/(N m)" };
    let title = format!("{}, {} model: {}", robot.name, robot.fidelity.name(), args.joint);

    let mut written = Vec::new();
    if let Some(path) = &args.csv {
        output::write(path, csv(&response).as_bytes(), &args.pose.robot)?;
        written.push(path.display().to_string());
    }
    if let Some(path) = &args.plot {
        output::write(path, &plot::response(path, &title, unit, &response)?, &args.pose.robot)?;
        written.push(path.display().to_string());
    }
    if !(written.is_empty() || quiet) {
        say(&format!("written: {}", written.join(", ")));
    }
    if args.json {
        let ([motor, motor_phase], [link, link_phase]) = (bode(&response.motor), bode(&response.link));
        let all = value!({
            "robot": robot.name, "model": robot.fidelity.name(), "joint": response.joint, "unit": unit,
            "q": point.state.q, "resonances": response.resonances, "antiresonances": response.antiresonances,
            "frequency": response.frequency,
            "motor": {"magnitude": motor, "phase": motor_phase},
            "link": {"magnitude": link, "phase": link_phase},
        });
        return print(&json::text(&all));
    }
    print(&text(&title, unit, &response))
}

fn csv(response: &Response) -> String {
    let mut out = "frequency,motor_magnitude,motor_phase,link_magnitude,link_phase\n".to_owned();
    let ([motor, motor_phase], [link, link_phase]) = (bode(&response.motor), bode(&response.link));
    for (i, f) in response.frequency.iter().enumerate() {
        let _ = writeln!(out, "{f:?},{:?},{:?},{:?},{:?}", motor[i], motor_phase[i], link[i], link_phase[i]);
    }
    out
}

fn text(title: &str, unit: &str, response: &Response) -> String {
    let (first, last) = (response.frequency.first().copied(), response.frequency.last().copied());
    let range = [first, last].map(|f| plot::digits(f.unwrap_or(0.0)));
    let mut out = format!("{title}, {} frequencies from {} to {} Hz\n", response.frequency.len(), range[0], range[1]);
    let mut rows: Vec<(&str, &Extreme)> = response.resonances.iter().map(|e| ("resonance", e)).collect();
    rows.extend(response.antiresonances.iter().map(|e| ("antiresonance", e)));
    rows.sort_by(|a, b| a.1.frequency.total_cmp(&b.1.frequency));
    if rows.is_empty() {
        return out + "the motor's response has neither resonance nor antiresonance in this range";
    }
    let _ = writeln!(out, "  {:<13}  {:>14}  {:>22}", "motor's", "frequency [Hz]", format!("magnitude [{unit}]"));
    for (name, extreme) in rows {
        let size = extreme.magnitude.map_or("undamped".to_owned(), |m| format!("{m:.4e}"));
        let _ = writeln!(out, "  {name:<13}  {:>14}  {size:>22}", plot::digits(extreme.frequency));
    }
    out.trim_end().to_owned()
}
