//! The sections of the document.

use super::constants::{constants, has_friction, modal_index, plain, table};
use super::lines::{aligned, equation, gathered, width};
use super::terms::{joined, sum};
use super::{symbols, velocities};
use crate::emit::Head;
use crate::explicit::{Coordinate, ExplicitModel, Lump, Sum, VelocityTerm};
use gyroflex::model::Fidelity;
use std::fmt::Write;

/// Widest matrix entry that still stands in a matrix, in letters.
const ENTRY: usize = 30;

pub(super) struct Writer<'a> {
    model: &'a ExplicitModel,
    /// With lumped constants.
    lumped: &'a ExplicitModel,
    /// In the equation of every coordinate.
    velocities: Vec<Vec<VelocityTerm>>,
    motor_velocities: Vec<Vec<VelocityTerm>>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(model: &'a ExplicitModel, lumped: &'a ExplicitModel) -> Self {
        let n = model.nv();
        Self {
            model,
            lumped,
            velocities: (0..n).map(|i| lumped.velocity_terms(i)).collect(),
            motor_velocities: (0..n).map(|i| lumped.motor_velocity_terms(i)).collect(),
        }
    }

    /// Robot, model, version, coordinates.
    pub(super) fn introduction(&self, head: &Head) -> String {
        let model = self.model;
        let what = match model.fidelity() {
            Fidelity::Complete => "elastic joints and the gyroscopics of rotors",
            Fidelity::Reduced => "elastic joints, rotors without gyroscopics (Spong 1987)",
            Fidelity::Rigid => "rigid joints and the gyroscopics of rotors",
            Fidelity::RigidReflected => "rigid joints, rotors as inertia of their joints",
        };
        let mut out = format!(
            "Model \\emph{{{}}}: {what}. SI units, radians. gyroflex {}, \\texttt{{{}}}.\\par\n",
            symbols::escaped(&head.model),
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
            out += "$c_i = \\cos q_i$, $s_i = \\sin q_i$, $c_{ij} = \\cos(q_i + q_j)$, $s_{ij} = \\sin(q_i + q_j)$.\n";
        }
        if model.modes() > 0 {
            let degree = model.options().degree;
            let _ = writeln!(out, "Inertia and gravity up to degree {degree} in $\\eta$.");
        }
        out
    }

    /// Everything after it.
    pub(super) fn body(&mut self, lumps: &[Lump]) -> String {
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
        self.velocities.iter().any(|terms| !terms.is_empty())
    }

    fn has_motor_velocity(&self) -> bool {
        self.motor_velocities.iter().any(|terms| !terms.is_empty())
    }

    /// Which joints have friction, on the link side and on the motor side.
    fn friction(&self) -> [bool; 2] {
        let joints = self.model.joints();
        [
            joints.iter().any(|joint| has_friction(self.model, &joint.friction)),
            joints
                .iter()
                .filter_map(|joint| joint.drive.as_ref())
                .any(|drive| has_friction(self.model, &drive.friction)),
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
            let s = pair("S_r", "S_f");
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
        let text = |i: usize, j: usize| joined(&sum(self.lumped, self.lumped.mass(i, j)));
        let mut out = "\\section*{Inertia}\n".to_owned();
        let small = n <= 3 && (0..n).all(|i| (0..n).all(|j| width(&text(i, j)) <= ENTRY));
        if small {
            let row = |i: usize| {
                (0..n).map(|j| if j < i { "\\cdot".to_owned() } else { text(i, j) }).collect::<Vec<_>>().join(" & ")
            };
            let rows: Vec<String> = (0..n).map(row).collect();
            let _ = writeln!(out, "\\[M = \\begin{{bmatrix}}{}\\end{{bmatrix}}, \\qquad M = M^T\\]", rows.join("\\\\"));
        } else {
            let mut entries = Vec::new();
            for (rows, columns) in [(0..joints, 0..joints), (0..joints, joints..n), (joints..n, joints..n)] {
                for i in rows {
                    for j in columns.clone().filter(|j| *j >= i) {
                        if !self.model.mass(i, j).is_zero() {
                            entries.push((format!("M_{{{}}}", symbols::index(&[i + 1, j + 1])), text(i, j)));
                        }
                    }
                }
            }
            let order = if self.model.modes() > 0 {
                let modes: Vec<String> = (joints..n).map(|i| symbols::coordinate(self.model, i, 0)).collect();
                format!("Rows and columns {} to {n} are those of ${}$. ", joints + 1, modes.join(", "))
            } else {
                String::new()
            };
            let _ = write!(out, "{order}$M = M^T$; entries that are not listed are zero.\n{}", gathered(&entries));
        }
        if self.model.is_coupled() {
            let mut entries = Vec::new();
            for i in 0..n {
                for j in 0..n {
                    if !self.model.coupling(i, j).is_zero() {
                        let entry = joined(&sum(self.lumped, self.lumped.coupling(i, j)));
                        entries.push((format!("S_{{{}}}", symbols::index(&[i + 1, j + 1])), entry));
                    }
                }
            }
            let _ = write!(out, "\\section*{{Coupling of links and rotors}}\n{}", gathered(&entries));
        }
        out
    }

    fn velocity(&self) -> String {
        let mut equations = self.forces("h", &self.velocities);
        equations.extend(self.forces("h_{\\theta", &self.motor_velocities));
        if equations.is_empty() {
            return String::new();
        }
        format!("\\section*{{Coriolis and centrifugal forces}}\n{}", aligned(&equations))
    }

    fn forces(&self, name: &str, of: &[Vec<VelocityTerm>]) -> Vec<String> {
        let name = |i: usize| match name.split_once('{') {
            Some((letter, index)) => format!("{letter}{{{index},{}}}", i + 1),
            None => format!("{name}_{{{}}}", i + 1),
        };
        let some = of.iter().enumerate().filter(|(_, terms)| !terms.is_empty());
        some.map(|(i, terms)| equation(&name(i), &joined(&velocities::forces(self.lumped, terms)))).collect()
    }

    fn gravity(&self) -> String {
        if !self.has_gravity() {
            return String::new();
        }
        let mut entries = Vec::new();
        for i in 0..self.model.nv() {
            let g = self.lumped.gravity(i);
            if !g.is_zero() {
                entries.push((format!("g_{{{}}}", i + 1), joined(&sum(self.lumped, &g))));
            }
        }
        format!("\\section*{{Gravity}}\n{}", gathered(&entries))
    }

    /// Stiffness, damping, friction, reflected inertia.
    fn springs(&self) -> String {
        let (model, mut lines) = (self.model, Vec::new());
        let named = |letter: &str, of: &dyn Fn(usize) -> Option<Sum>| {
            let joints = 0..model.joints().len();
            let entries: Vec<String> = joints
                .map(|i| match of(i) {
                    Some(sum) if !sum.is_zero() => match plain(model, &sum) {
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
        for (name, letter, diagonal) in [
            ("B", "B_{", named("B_{", &|i| model.reflected_inertia(i).cloned())),
            ("K", "K_{", named("K_{", &transmission(|t| &t.stiffness))),
            ("K_3", "K_{3,", named("K_{3,", &transmission(|t| &t.cubic))),
            ("D", "D_{", named("D_{", &transmission(|t| &t.damping))),
        ] {
            let _ = letter;
            diagonals.extend(diagonal.map(|d| (name.to_owned(), d)));
        }
        for (name, letter, matrix) in [("K_f", "k", &model.modal_stiffness), ("D_f", "d", &model.modal_damping)] {
            diagonals.extend(self.modal(matrix, letter).map(|d| (name.to_owned(), d)));
        }
        lines.push(gathered(&diagonals));
        lines.push(self.friction_laws());
        let text = lines.concat();
        if text.is_empty() { text } else { format!("\\section*{{{}}}\n{text}", self.springs_title()) }
    }

    fn springs_title(&self) -> &'static str {
        match (self.model.is_elastic(), self.model.modes() > 0) {
            (true, _) => "Rotors, stiffness and damping",
            (false, true) => "Stiffness and damping",
            (false, false) => "Friction",
        }
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

    fn friction_laws(&self) -> String {
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
