//! The table of values.

use super::lines::{LINE, width};
use super::symbols;
use super::terms::number;
use crate::explicit::{ExplicitModel, Lump, Sum, Unit};
use gyroflex::model::Friction;

/// A constant with its value and unit, as text.
pub(super) struct Constant {
    name: String,
    value: f64,
    unit: String,
}

/// Units by the kind of a coordinate.
struct Units {
    inertia: &'static str,
    stiffness: &'static str,
    cubic: &'static str,
    damping: &'static str,
    ratio: &'static str,
}

const ANGLE: Units =
    Units { inertia: "kg\\,m^2", stiffness: "N\\,m/rad", cubic: "N\\,m/rad^3", damping: "N\\,m\\,s/rad", ratio: "" };
const LENGTH: Units = Units { inertia: "kg", stiffness: "N/m", cubic: "N/m^3", damping: "N\\,s/m", ratio: "rad/m" };

/// All that have no symbol of their own and a value.
pub(super) fn constants(model: &ExplicitModel, lumps: &[Lump]) -> Vec<Constant> {
    let mut out: Vec<Constant> = lumps
        .iter()
        .enumerate()
        .map(|(k, lump)| Constant { name: format!("p_{{{}}}", k + 1), value: lump.value, unit: unit(lump.unit) })
        .collect();
    let mut add = |name: String, sum: &Sum, unit: &str| {
        if let Some(value) = plain(sum).filter(|value| *value != 0.0) {
            out.push(Constant { name, value, unit: unit.to_owned() });
        }
    };
    for (i, joint) in model.joints().iter().enumerate() {
        let units = if symbols::is_angle(model, i) { ANGLE } else { LENGTH };
        let k = i + 1;
        if let Some(drive) = &joint.drive {
            if let Some(t) = &drive.transmission {
                add(format!("B_{{{k}}}"), &drive.reflected_inertia, units.inertia);
                add(format!("K_{{{k}}}"), &t.stiffness, units.stiffness);
                add(format!("K_{{3,{k}}}"), &t.cubic, units.cubic);
                add(format!("D_{{{k}}}"), &t.damping, units.damping);
            }
            if has_friction(&drive.friction) {
                add(format!("N_{{{k}}}"), &drive.gear_ratio, units.ratio);
                of_friction(&format!("{k}\\mathrm{{m}}"), &drive.friction, &ANGLE, &mut add);
            }
        }
        of_friction(&k.to_string(), &joint.friction, &units, &mut add);
    }
    for j in 0..model.modes() {
        for k in j..model.modes() {
            let of = modal_index(model, j, k);
            for (letter, value, unit) in
                [("k", model.modal_stiffness(j, k), "N/m"), ("d", model.modal_damping(j, k), "N\\,s/m")]
            {
                if value != 0.0 {
                    out.push(Constant { name: format!("{letter}_{{{of}}}"), value, unit: unit.to_owned() });
                }
            }
        }
    }
    out
}

/// Constants of one shaft's friction.
fn of_friction(index: &str, friction: &Friction<Sum>, units: &Units, add: &mut impl FnMut(String, &Sum, &str)) {
    let (torque, speed) = if units.ratio.is_empty() { ("N\\,m", "rad/s") } else { ("N", "m/s") };
    add(format!("b_{{{index}}}"), &friction.viscous, units.damping);
    if friction.dry {
        add(format!("F_{{{index}}}"), &friction.coulomb, torque);
        add(format!("v_{{{index}}}"), &friction.smoothing_velocity, speed);
        add(format!("\\Delta F_{{{index}}}"), &friction.stribeck, torque);
        add(format!("w_{{{index}}}"), &friction.stribeck_velocity, speed);
    }
}

/// Whether there is any.
pub(super) fn has_friction(friction: &Friction<Sum>) -> bool {
    friction.dry || !friction.viscous.is_zero()
}

/// `11` for the stiffness of a mode, `11,12` for that between two.
pub(super) fn modal_index(model: &ExplicitModel, j: usize, k: usize) -> String {
    let first = model.joints().len();
    let of = |j: usize| {
        let name = symbols::coordinate(model, first + j, 0);
        name.trim_start_matches("\\eta_{").trim_end_matches('}').to_owned()
    };
    if j == k { of(j) } else { format!("{},{}", of(j), of(k)) }
}

/// The number that a sum is; none if it depends on something.
pub(super) fn plain(sum: &Sum) -> Option<f64> {
    match sum.terms() {
        [] => Some(0.0),
        [(m, c)] if m.is_one() => Some(*c),
        _ => None,
    }
}

/// Powers of units, with newtons where they fit; those below the line behind a stroke.
fn unit(of: Unit) -> String {
    let [kilograms, metres, seconds] = of.0;
    let powers = if (kilograms, seconds) == (1, -2) {
        [("N", 1), ("m", metres - 1), ("s", 0)]
    } else {
        [("kg", kilograms), ("m", metres), ("s", seconds)]
    };
    let side = |sign: i32| -> Vec<String> {
        let some = powers.iter().filter(|(_, power)| power * sign > 0);
        some.map(
            |(name, power)| if power.abs() == 1 { (*name).to_owned() } else { format!("{name}^{{{}}}", power.abs()) },
        )
        .collect()
    };
    let (above, below) = (side(1).join("\\,"), side(-1).join("\\,"));
    match (above.is_empty(), below.is_empty()) {
        (_, true) => above,
        (true, false) => format!("1/{below}"),
        (false, false) => format!("{above}/{below}"),
    }
}

/// The section of the table, in as many columns as fit.
pub(super) fn table(constants: &[Constant]) -> String {
    if constants.is_empty() {
        return String::new();
    }
    let texts: Vec<String> = constants
        .iter()
        .map(|c| {
            let unit = if c.unit.is_empty() { String::new() } else { format!("\\ \\mathrm{{{}}}", c.unit) };
            format!("{} = {}{unit}", c.name, number(c.value))
        })
        .collect();
    // Many of them are many short lines; sizes are seven and eight points beside nine.
    let (size, points) = if texts.len() > 30 { ("scriptsize", 7) } else { ("footnotesize", 8) };
    let widest = texts.iter().map(|text| width(text)).max().unwrap_or(1) + 20;
    let columns = (LINE * 9 / points / widest).clamp(2, 6);
    let rows: Vec<String> = texts.iter().map(|text| format!("\\mbox{{${text}$}}")).collect();
    format!(
        "\\begin{{multicols}}{{{columns}}}[\\section*{{Constants}}]\\{size}\\raggedright\n{}\n\\end{{multicols}}\n",
        rows.join("\\\\\n")
    )
}
