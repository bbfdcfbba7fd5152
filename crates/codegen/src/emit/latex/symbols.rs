//! What is called how.

use crate::explicit::{Coordinate, ExplicitModel, Harmonic, Input, Layout, Speed};
use crate::robot::Parameter;

/// A text with the characters that LaTeX gives a meaning as they are.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '\\' => out.push_str("\\textbackslash{}"),
            '_' | '&' | '%' | '$' | '#' | '{' | '}' => {
                out.push('\\');
                out.push(c);
            }
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            _ => out.push(c),
        }
    }
    out
}

/// `q_1`, or `η_{12}` of the second mode of the first link that bends; `dots` says how often it is derived.
pub(super) fn coordinate(model: &ExplicitModel, i: usize, dots: usize) -> String {
    let dot = ["", "\\dot ", "\\ddot "][dots];
    match &model.coordinates()[i] {
        Coordinate::Modal { of, mode, .. } => format!("{dot}\\eta_{{{}}}", index(&[of + 1, mode + 1])),
        _ => format!("{dot}q_{{{}}}", i + 1),
    }
}

pub(super) fn speed(model: &ExplicitModel, speed: Speed) -> String {
    match speed {
        Speed::Link(i) => coordinate(model, i, 1),
        Speed::Motor(i) => format!("\\dot\\theta_{{{}}}", i + 1),
    }
}

/// Indices side by side, with commas where one has two digits.
pub(super) fn index(of: &[usize]) -> String {
    let separator = if of.iter().any(|i| *i > 9) { "," } else { "" };
    of.iter().map(ToString::to_string).collect::<Vec<_>>().join(separator)
}

/// `c_{12}` for `cos(q₁ + q₂)`, `c_{223}` for `cos(2 q₂ + q₃)`: indices add up, as in Armstrong, Khatib and Burdick 1986. Differences are
/// written out.
pub(super) fn harmonic(layout: &Layout, h: &Harmonic) -> String {
    let angles = &layout.angles[layout.groups[h.group].clone()];
    if h.multiples.iter().all(|k| (0..=3).contains(k)) {
        let repeated = |(q, k): (&usize, &i8)| core::iter::repeat_n(q + 1, usize::from(k.unsigned_abs()));
        let of: Vec<usize> = angles.iter().zip(h.multiples).flat_map(repeated).collect();
        return format!("{}_{{{}}}", if h.sine { "s" } else { "c" }, index(&of));
    }
    let mut angle = String::new();
    for (q, k) in angles.iter().zip(h.multiples).filter(|(_, k)| **k != 0) {
        let sign = if *k < 0 {
            "{-}"
        } else if angle.is_empty() {
            ""
        } else {
            "{+}"
        };
        let times = if k.abs() == 1 { String::new() } else { k.abs().to_string() };
        angle += &format!("{sign}{times}q_{{{}}}", q + 1);
    }
    format!("{}({angle})", if h.sine { "\\sin" } else { "\\cos" })
}

/// A variable of a term: a position, a kept parameter or a lumped constant.
pub(super) fn variable(model: &ExplicitModel, v: usize) -> String {
    let (n, input) = (model.nv(), model.layout().variables[v]);
    let kept = &model.options().kept;
    match input.checked_sub(n) {
        None => coordinate(model, input, 0),
        Some(k) => kept.get(k).map_or_else(|| format!("p_{{{}}}", k - kept.len() + 1), |p| parameter(model, p)),
    }
}

/// `m_2` for the mass of the second link, `K_1` for the stiffness of the first joint, …
pub(super) fn parameter(model: &ExplicitModel, of: &Parameter) -> String {
    let name = of.name();
    match name {
        "gravity" => return "g".to_owned(),
        "payload.mass" => return "m_{\\mathrm{load}}".to_owned(),
        _ => {}
    }
    let Some((owner, what)) = name.rsplit_once('.') else { return format!("\\mathit{{{}}}", escaped(name)) };
    let joint = |c: &Coordinate| matches!(c, Coordinate::Angle(n) | Coordinate::Displacement(n) if n == owner);
    let place = match what {
        "mass" => model.links().iter().position(|link| link == owner),
        _ => model.coordinates().iter().position(joint),
    };
    let place = place.map_or_else(|| format!("\\mathrm{{{}}}", escaped(owner)), |i| (i + 1).to_string());
    let (letter, index) = match what {
        "mass" => ("m", place),
        "stiffness" => ("K", place),
        "damping" => ("D", place),
        "viscous" => ("b", place),
        "motor_viscous" => ("b", format!("{place}\\mathrm{{m}}")),
        "gear_ratio" => ("N", place),
        "rotor_inertia" => ("J", place),
        _ => return format!("\\mathit{{{}}}", escaped(name)),
    };
    format!("{letter}_{{{index}}}")
}

/// Of the unit of a coordinate: whether it is an angle.
pub(super) fn is_angle(model: &ExplicitModel, i: usize) -> bool {
    matches!(model.layout().inputs[i], Input::Angle(_))
}
