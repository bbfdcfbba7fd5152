//! Stiffness, damping, friction and the rotors' own inertia.

use super::constants::{modal_index, plain};
use super::lines::{aligned, gathered};
use super::sections::Writer;
use super::terms::joined;
use crate::explicit::{Sum, TransmissionLaw};
use gyroflex::model::Friction;

impl Writer<'_> {
    /// Stiffness, damping, friction, reflected inertia.
    pub(super) fn springs(&self) -> String {
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
        let transmission =
            |of: fn(&TransmissionLaw) -> &Sum| move |i: usize| model.transmission(i).map(|t| of(t).clone());
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
        let dry = |friction: &Friction<Sum>| friction.dry;
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
            let index = "i\\mathrm{m}";
            let text = if any_dry {
                format!("N_i\\bigl({}\\bigr) \\text{{ at }} v = N_i{speed}", law("v", index))
            } else {
                format!("N_i^2b_{{{index}}}{speed}")
            };
            lines.push(("f_{\\mathrm{m},i}".to_owned(), text));
        }
        gathered(&lines)
    }
}
