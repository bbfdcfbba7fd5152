//! The equations in matrices, before what these are.

use super::lines::aligned;
use super::sections::Writer;
use std::fmt::Write;

impl Writer<'_> {
    /// The matrix form.
    pub(super) fn equations(&self) -> String {
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
}
