//! The sections of the document.

use super::abbreviations::abbreviate;
use super::constants::{constants, has_friction, table};
use super::lines::{aligned, equation, gathered, width};
use super::terms::{joined, sum};
use super::{symbols, velocities};
use crate::emit::Head;
use crate::explicit::{Coordinate, ExplicitModel, Lump, Sum, VelocityTerm};
use crate::robot::Parameter;
use std::fmt::Write;

/// Widest matrix entry that still stands in a matrix, in tenths of a letter.
const ENTRY: usize = 300;

pub(super) struct Writer<'a> {
    pub(super) model: &'a ExplicitModel,
    /// Entries of inertia that are not zero, by row and column.
    mass: Vec<((usize, usize), String)>,
    coupling: Vec<((usize, usize), String)>,
    /// In the equations of coordinates and of motors.
    velocities: Vec<(usize, String)>,
    motor_velocities: Vec<(usize, String)>,
    gravity: Vec<(usize, String)>,
    abbreviations: Vec<(String, String)>,
}

impl<'a> Writer<'a> {
    /// `lumped` is the model with lumped constants.
    pub(super) fn new(model: &'a ExplicitModel, lumped: &ExplicitModel) -> Self {
        let n = model.nv();
        let entry = |of: &Sum| (!of.is_zero()).then(|| joined(&sum(lumped, of)));
        let all = || (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let forces = |i: usize, terms: &[VelocityTerm]| {
            (!terms.is_empty()).then(|| (i, joined(&velocities::forces(lumped, terms))))
        };
        let mut out = Self {
            model,
            mass: all()
                .filter(|(i, j)| i <= j)
                .filter_map(|(i, j)| Some(((i, j), entry(lumped.mass(i, j))?)))
                .collect(),
            coupling: all().filter_map(|(i, j)| Some(((i, j), entry(lumped.coupling(i, j))?))).collect(),
            velocities: (0..n).filter_map(|i| forces(i, &lumped.velocity_terms(i))).collect(),
            motor_velocities: (0..n).filter_map(|i| forces(i, &lumped.motor_velocity_terms(i))).collect(),
            gravity: (0..n).filter_map(|i| Some((i, entry(&lumped.gravity(i))?))).collect(),
            abbreviations: Vec::new(),
        };
        let Self { mass, coupling, velocities, motor_velocities, gravity, .. } = &mut out;
        let of_pairs = mass.iter_mut().chain(coupling).map(|(_, text)| text);
        let single = velocities.iter_mut().chain(motor_velocities).chain(gravity).map(|(_, text)| text);
        let mut texts: Vec<&mut String> = of_pairs.chain(single).collect();
        out.abbreviations = abbreviate(&mut texts);
        out
    }

    /// Robot, model, version, coordinates.
    pub(super) fn introduction(&self, head: &Head) -> String {
        let model = self.model;
        let (elastic, driven) = (model.is_elastic(), model.joints().iter().any(|joint| joint.drive.is_some()));
        let mut what = vec![if elastic { "elastic joints" } else { "rigid joints" }];
        if model.modes() > 0 {
            what.insert(0, "links that bend");
        }
        if driven {
            let gyroscopic = model.fidelity().is_gyroscopic();
            what.push(if gyroscopic { "rotors with their gyroscopics" } else { "rotors without gyroscopics" });
        }
        let mut out = format!(
            "Model \\emph{{{}}}: {}. SI units, radians. By gyroflex {}: \\texttt{{{}}}\\par\n",
            symbols::escaped(&head.model),
            what.join(", "),
            env!("CARGO_PKG_VERSION"),
            symbols::escaped(&head.command),
        );
        let mut named: Vec<String> = Vec::new();
        for (i, coordinate) in model.coordinates().iter().enumerate() {
            let symbol = symbols::coordinate(model, i, 0);
            named.push(match coordinate {
                Coordinate::Angle(name) => format!("${symbol}$ angle of \\textsf{{{}}}", symbols::escaped(name)),
                Coordinate::Displacement(name) => {
                    format!("${symbol}$ displacement of \\textsf{{{}}}", symbols::escaped(name))
                }
                Coordinate::Modal { link, of, mode: 0 } => {
                    let last = model.coordinates()[i..]
                        .iter()
                        .take_while(|c| matches!(c, Coordinate::Modal { of: other, .. } if other == of))
                        .count();
                    let range = match last {
                        1 => format!("${symbol}$ mode"),
                        2 => format!("${symbol}, {}$ modes", symbols::coordinate(model, i + 1, 0)),
                        _ => format!("${symbol}, \\dots, {}$ modes", symbols::coordinate(model, i + last - 1, 0)),
                    };
                    format!("{range} of \\textsf{{{}}}", symbols::escaped(link))
                }
                Coordinate::Modal { .. } => continue,
            });
        }
        let _ = writeln!(out, "{}.", named.join(", "));
        if model.is_elastic() {
            out += "$\\theta_i = \\theta_{\\mathrm{m},i}/N_i$ motor positions, reflected to the link side, $\\tau$ likewise.\n";
        }
        let circular = |sum: &Sum| sum.terms().iter().any(|(m, _)| m.harmonics(model.layout()).next().is_some());
        if model.mass.iter().chain(&model.coupling).chain([model.potential()]).any(circular) {
            out += "$c_i = \\cos q_i$, $s_i = \\sin q_i$; indices add up: $c_{ij} = \\cos(q_i + q_j)$.\n";
        }
        let kept = &model.options().kept;
        if !kept.is_empty() {
            let say = |p: &Parameter| {
                format!("${}$ \\textsf{{{}}}", symbols::parameter(model, p), symbols::escaped(p.name()))
            };
            let _ = writeln!(out, "Kept: {}.", kept.iter().map(say).collect::<Vec<_>>().join(", "));
        }
        if model.modes() > 0 {
            let degree = model.options().degree;
            let _ = writeln!(
                out,
                "The grouping is that of Cetinkunt and Book 1988, eq.~46; inertia and gravity are kept up to degree {degree} in $\\eta$."
            );
        }
        out
    }

    /// Everything after it.
    pub(super) fn body(&self, lumps: &[Lump]) -> String {
        let mut out = self.equations();
        out += &self.inertia();
        out += &self.velocity();
        out += &self.gravity();
        out += &self.springs();
        out += &table(&constants(self.model, lumps));
        out
    }

    pub(super) fn has_gravity(&self) -> bool {
        !self.model.potential().is_zero()
    }

    pub(super) fn has_velocity(&self) -> bool {
        !self.velocities.is_empty()
    }

    pub(super) fn has_motor_velocity(&self) -> bool {
        !self.motor_velocities.is_empty()
    }

    /// Which joints have friction, on the link side and on the motor side.
    pub(super) fn friction(&self) -> [bool; 2] {
        let joints = self.model.joints();
        [
            joints.iter().any(|joint| has_friction(&joint.friction)),
            joints.iter().filter_map(|joint| joint.drive.as_ref()).any(|drive| has_friction(&drive.friction)),
        ]
    }

    fn inertia(&self) -> String {
        let (n, joints) = (self.model.nv(), self.model.joints().len());
        let at =
            |i: usize, j: usize| self.mass.iter().find(|(place, _)| *place == (i, j)).map(|(_, text)| text.as_str());
        let mut out = "\\section*{Inertia}\n".to_owned();
        let small = n <= 3 && self.mass.iter().all(|(_, text)| width(text) <= ENTRY);
        if small {
            out += "Symmetric and positive definite.\n";
            let text = |i: usize, j: usize| at(i.min(j), i.max(j)).unwrap_or("0").to_owned();
            let row = |i: usize| (0..n).map(|j| text(i, j)).collect::<Vec<_>>().join(" & ");
            let rows: Vec<String> = (0..n).map(row).collect();
            out += &aligned(&[format!("M &= \\begin{{bmatrix}}{}\\end{{bmatrix}}", rows.join("\\\\"))]);
        } else {
            if self.model.modes() > 0 {
                let _ = write!(out, "$q$ has rows and columns 1 to {joints}, $\\eta$ {} to {n}. ", joints + 1);
            }
            out += "$M = M^T$; entries that are not listed are zero.\n";
            // Block by block.
            let block = |(i, j): (usize, usize)| (i >= joints, j >= joints);
            let mut rows = Vec::new();
            for of in [(false, false), (false, true), (true, true)] {
                let entries = self.mass.iter().filter(|(place, _)| block(*place) == of).cloned();
                rows.extend(gathered(&entries.map(|(place, text)| (pair_name("M", place), text)).collect::<Vec<_>>()));
            }
            out += &aligned(&rows);
        }
        if !self.abbreviations.is_empty() {
            out += "Here and below\n";
            out += &aligned(&gathered(&self.abbreviations));
        }
        if !self.coupling.is_empty() {
            out += "\\section*{Coupling of links and rotors}\nRows are coordinates of links, columns motors.\n";
            let named = self.coupling.iter().map(|(place, text)| (pair_name("S", *place), text.clone()));
            out += &aligned(&gathered(&named.collect::<Vec<_>>()));
        }
        out
    }

    fn velocity(&self) -> String {
        let of = |(i, text): &(usize, String)| equation(&format!("h_{{{}}}", i + 1), text);
        let of_motor = |(i, text): &(usize, String)| equation(&format!("h_{{\\theta{}}}", i + 1), text);
        let mut equations: Vec<String> = self.velocities.iter().map(of).collect();
        equations.extend(self.motor_velocities.iter().map(of_motor));
        if equations.is_empty() {
            return String::new();
        }
        let title = "\\section*{Coriolis and centrifugal forces}\n";
        format!("{title}From the Christoffel symbols of the whole inertia matrix.\n{}", aligned(&equations))
    }

    fn gravity(&self) -> String {
        if !self.has_gravity() {
            return String::new();
        }
        let entries = self.gravity.iter().map(|(i, text)| (format!("g_{{{}}}", i + 1), text.clone()));
        let title = "\\section*{Gravity}\n";
        format!("{title}The derivatives of its potential energy.\n{}", aligned(&gathered(&entries.collect::<Vec<_>>())))
    }
}

/// `M_{12}`.
fn pair_name(letter: &str, (i, j): (usize, usize)) -> String {
    format!("{letter}_{{{}}}", symbols::index(&[i + 1, j + 1]))
}
