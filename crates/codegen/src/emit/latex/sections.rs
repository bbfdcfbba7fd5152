//! The sections of the document.

use super::abbreviations::abbreviate;
use super::constants::{constants, has_friction, modal_index, plain, table};
use super::lines::{aligned, equation, gathered, width};
use super::terms::{joined, sum};
use super::{symbols, velocities};
use crate::emit::Head;
use crate::explicit::{Coordinate, ExplicitModel, Lump, Sum, VelocityTerm};
use std::fmt::Write;

/// Widest matrix entry that still stands in a matrix, in tenths of a letter.
const ENTRY: usize = 300;

pub(super) struct Writer<'a> {
    model: &'a ExplicitModel,
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
        let constants = constants(self.model, lumps);
        if !constants.is_empty() {
            out += "\\section*{Constants}\n";
            out += &table(&constants);
        }
        out
    }

    fn has_gravity(&self) -> bool {
        !self.model.potential().is_zero()
    }

    fn has_velocity(&self) -> bool {
        !self.velocities.is_empty()
    }

    fn has_motor_velocity(&self) -> bool {
        !self.motor_velocities.is_empty()
    }

    /// Which joints have friction, on the link side and on the motor side.
    fn friction(&self) -> [bool; 2] {
        let joints = self.model.joints();
        [
            joints.iter().any(|joint| has_friction(&joint.friction)),
            joints.iter().filter_map(|joint| joint.drive.as_ref()).any(|drive| has_friction(&drive.friction)),
        ]
    }

    /// The matrix form.
    fn equations(&self) -> String {
        let model = self.model;
        let (elastic, coupled, bends) = (model.is_elastic(), model.is_coupled(), model.modes() > 0);
        let [link_friction, motor_friction] = self.friction();
        let pair = |a: &str, b: &str| {
            if bends { format!("\\begin{{bmatrix}}{a}\\\\{b}\\end{{bmatrix}}") } else { a.to_owned() }
        };
        let mut left = if bends {
            "\\begin{bmatrix}M_{rr}&M_{rf}\\\\M_{rf}^T&M_{ff}\\end{bmatrix}\\begin{bmatrix}\\ddot q\\\\\\ddot\\eta\\end{bmatrix}".to_owned()
        } else {
            "M(q)\\,\\ddot q".to_owned()
        };
        if coupled {
            let s = if bends { pair("S_r", "S_f") } else { "S".to_owned() };
            let _ = write!(left, " + {s}{}\\ddot\\theta", if bends { "" } else { "(q)\\," });
        }
        if self.has_velocity() {
            let arguments = if coupled { "(q,\\dot q,\\dot\\theta)" } else { "(q,\\dot q)" };
            let _ = write!(left, " + {}", if bends { pair("h_r", "h_f") } else { format!("h{arguments}") });
        }
        if self.has_gravity() {
            let _ = write!(left, " + {}", if bends { pair("g_r", "g_f") } else { "g(q)".to_owned() });
        }
        if bends {
            let damped = model.modal_damping.iter().any(|d| *d != 0.0);
            let dampers = if damped {
                " + \\begin{bmatrix}0&0\\\\0&D_f\\end{bmatrix}\\begin{bmatrix}\\dot q\\\\\\dot\\eta\\end{bmatrix}"
            } else {
                ""
            };
            let _ = write!(
                left,
                " + \\begin{{bmatrix}}0&0\\\\0&K_f\\end{{bmatrix}}\\begin{{bmatrix}}q\\\\\\eta\\end{{bmatrix}}{dampers}"
            );
        }
        let mut torque = if elastic { "\\tau_J" } else { "\\tau" }.to_owned();
        if link_friction {
            torque += " - f(\\dot q)";
        }
        if motor_friction && !elastic {
            torque += " - f_\\mathrm{m}(\\dot q)";
        }
        let mut lines = vec![format!("{left} &= {}", pair(&torque, "0"))];
        if elastic {
            let transposed = match (coupled, bends) {
                (false, _) => String::new(),
                (true, false) => "S^T(q)\\,\\ddot q + ".to_owned(),
                (true, true) => {
                    "\\begin{bmatrix}S_r^T&S_f^T\\end{bmatrix}\\begin{bmatrix}\\ddot q\\\\\\ddot\\eta\\end{bmatrix} + "
                        .to_owned()
                }
            };
            let h = if self.has_motor_velocity() { " + h_\\theta(q,\\dot q)" } else { "" };
            let f = if motor_friction { " - f_\\mathrm{m}(\\dot\\theta)" } else { "" };
            lines.push(format!("{transposed}B\\,\\ddot\\theta{h} &= \\tau - \\tau_J{f}"));
            lines.push(format!("\\tau_J &= {}", self.transmitted()));
        }
        aligned(&lines)
    }

    /// The law of the transmissions.
    fn transmitted(&self) -> String {
        let all = || (0..self.model.joints().len()).filter_map(|i| self.model.transmission(i));
        let mut law = "K\\,(\\theta - q)".to_owned();
        if all().any(|t| !t.cubic.is_zero()) {
            law += " + K_3\\,(\\theta - q)^3";
        }
        if all().any(|t| !t.damping.is_zero()) {
            law += " + D\\,(\\dot\\theta - \\dot q)";
        }
        law
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
        format!("{title}By the Christoffel symbols of the whole inertia matrix.\n{}", aligned(&equations))
    }

    fn gravity(&self) -> String {
        if !self.has_gravity() {
            return String::new();
        }
        let entries = self.gravity.iter().map(|(i, text)| (format!("g_{{{}}}", i + 1), text.clone()));
        let title = "\\section*{Gravity}\n";
        format!("{title}The derivatives of its potential energy.\n{}", aligned(&gathered(&entries.collect::<Vec<_>>())))
    }

    /// Stiffness, damping, friction, reflected inertia.
    fn springs(&self) -> String {
        let model = self.model;
        let named = |letter: &str, of: &dyn Fn(usize) -> Option<Sum>| {
            let joints = 0..model.joints().len();
            let entries: Vec<String> = joints
                .map(|i| match of(i) {
                    Some(sum) if !sum.is_zero() => match plain(&sum) {
                        Some(_) => format!("{letter}{}}}", i + 1),
                        None => joined(&super::terms::sum(model, &sum)),
                    },
                    _ => "0".to_owned(),
                })
                .collect();
            (entries.iter().any(|e| e != "0")).then(|| format!("\\operatorname{{diag}}({})", entries.join(", ")))
        };
        let transmission = |of: fn(&crate::explicit::TransmissionLaw) -> &Sum| {
            move |i: usize| model.transmission(i).map(|t| of(t).clone())
        };
        let mut diagonals = Vec::new();
        for (name, diagonal) in [
            ("B", named("B_{", &|i| model.reflected_inertia(i).cloned())),
            ("K", named("K_{", &transmission(|t| &t.stiffness))),
            ("K_3", named("K_{3,", &transmission(|t| &t.cubic))),
            ("D", named("D_{", &transmission(|t| &t.damping))),
        ] {
            diagonals.extend(diagonal.map(|d| (name.to_owned(), d)));
        }
        for (name, letter, matrix) in [("K_f", "k", &model.modal_stiffness), ("D_f", "d", &model.modal_damping)] {
            diagonals.extend(self.modal(matrix, letter).map(|d| (name.to_owned(), d)));
        }
        let mut rows = gathered(&diagonals);
        rows.extend(self.friction_laws());
        if rows.is_empty() {
            return String::new();
        }
        let (title, said) = match (model.is_elastic(), model.modes() > 0) {
            (true, _) => ("Rotors, stiffness and damping", "On the link side of the gears."),
            (false, true) => ("Stiffness and damping", "Of the modes, each on its own where they are eigenfunctions."),
            (false, false) => ("Friction", "Against the motion."),
        };
        format!("\\section*{{{title}}}\n{said}\n{}", aligned(&rows))
    }

    fn modal(&self, matrix: &[f64], letter: &str) -> Option<String> {
        let n = self.model.modes();
        if matrix.iter().all(|x| *x == 0.0) {
            return None;
        }
        let entry = |j: usize, k: usize| {
            let (j, k) = (j.min(k), j.max(k));
            if matrix[j * n + k] == 0.0 {
                "0".to_owned()
            } else {
                format!("{letter}_{{{}}}", modal_index(self.model, j, k))
            }
        };
        let diagonal = (0..n).all(|j| (0..n).all(|k| j == k || matrix[j * n + k] == 0.0));
        if diagonal {
            let entries: Vec<String> = (0..n).map(|j| entry(j, j)).collect();
            return Some(format!("\\operatorname{{diag}}({})", entries.join(", ")));
        }
        let rows: Vec<String> = (0..n).map(|j| (0..n).map(|k| entry(j, k)).collect::<Vec<_>>().join(" & ")).collect();
        Some(format!("\\begin{{bmatrix}}{}\\end{{bmatrix}}", rows.join("\\\\")))
    }

    fn friction_laws(&self) -> Vec<String> {
        let [link, motor] = self.friction();
        let dry = |friction: &gyroflex::model::Friction<Sum>| friction.dry;
        let joints = self.model.joints();
        let any_dry = joints.iter().any(|j| dry(&j.friction) || j.drive.as_ref().is_some_and(|d| dry(&d.friction)));
        let law = |v: &str, i: &str| {
            if any_dry {
                format!(
                    "b_{{{i}}}{v} + \\bigl(F_{{{i}}} + \\Delta F_{{{i}}}\\,e^{{-({v}/w_{{{i}}})^2}}\\bigr)\\tanh({v}/v_{{{i}}})"
                )
            } else {
                format!("b_{{{i}}}{v}")
            }
        };
        let mut lines = Vec::new();
        if link {
            lines.push(("f_i".to_owned(), law("\\dot q_i", "i")));
        }
        if motor {
            let speed = if self.model.is_elastic() { "\\dot\\theta_i" } else { "\\dot q_i" };
            lines.push((
                "f_{\\mathrm{m},i}".to_owned(),
                format!("N_i\\bigl({}\\bigr),\\quad v = N_i{speed}", law("v", "i\\mathrm{m}")),
            ));
        }
        gathered(&lines)
    }
}

/// `M_{12}`.
fn pair_name(letter: &str, (i, j): (usize, usize)) -> String {
    format!("{letter}_{{{}}}", symbols::index(&[i + 1, j + 1]))
}
