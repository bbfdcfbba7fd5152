//! The same for people.

use super::bounds::{Bound, Bounds};
use super::report::{JointReport, Report, Side};
use std::fmt;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = self.file.as_ref().map_or_else(|| self.of.clone(), |file| format!("{} {file}", self.of));
        writeln!(
            f,
            "{}: complete model beside the reduced one over {} instants of the {of}\n",
            self.robot, self.samples
        )?;
        let widest = self.joints.iter().map(|j| j.name.chars().count()).max().unwrap_or(0).max("joint".len());
        let side = |name: &str| format!("{:^36}", format!("{name}: torque and the reduced model's error"));
        writeln!(f, "  {:widest$}  {:>11}  {}  {}", "", "", side("tau_J"), side("tau").trim_end())?;
        let columns = ["peak", "error", "max %", "rms %"].map(|c| format!("{c:>9}")).concat();
        writeln!(f, "  {:<widest$}  {:>11}  {columns}  {columns}  verdict", "joint", "top speed")?;
        for joint in &self.joints {
            let JointReport { name, top_speed, tau_j, tau, verdict, .. } = joint;
            let (a, b) = (numbers(tau_j), numbers(tau));
            writeln!(f, "  {name:<widest$}  {:>11}  {a}  {b}  {verdict}", joint.speed_text(*top_speed))?;
        }
        writeln!(f, "  (N m on the link side, N for sliding joints; % of the joint's own peak torque)")?;
        let s = &self.significance;
        writeln!(
            f,
            "\nsignificance ratio r_s: {:.4} to {:.4} in these motions; {:.4} to {:.4} for any velocity at these poses",
            s.r_s_lowest, s.r_s_highest, s.r_s_min, s.r_s_max
        )?;
        if let Some(bounds) = &self.bounds {
            write!(f, "\n{bounds}")?;
        }
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        write!(f, "\nverdict: {}", self.verdict)
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "bounds over the joint limits, by samples and local search")?;
        let rows = [
            ("largest ||M||", "kg m²", &self.inertia_max),
            ("smallest ||M||", "kg m²", &self.inertia_min),
            ("smallest eigenvalue of M", "kg m²", &self.eigenvalue_min),
            ("largest ||C|| / ||qd||", "kg m²", &self.coriolis_max),
            ("largest ||g||", "N m", &self.gravity_max),
        ];
        for (name, unit, Bound { value, q, qd }) in rows {
            let list = |v: &[f64]| v.iter().map(|x| format!("{x:.3}")).collect::<Vec<_>>().join(", ");
            write!(f, "  {name:<28}{:>11} {unit:<6} at q = [{}]", digits(*value), list(q))?;
            writeln!(f, "{}", if qd.is_empty() { String::new() } else { format!(", qd along [{}]", list(qd)) })?;
        }
        Ok(())
    }
}

fn numbers(side: &Side) -> String {
    let Side { peak, error_max, error_max_percent, error_rms_percent, .. } = *side;
    [peak, error_max, error_max_percent, error_rms_percent].map(|x| format!("{:>9}", digits(x))).concat()
}

/// Four digits, and zero for what is rounding.
fn digits(x: f64) -> String {
    match x.abs() {
        a if a < 1e-9 => "0".to_owned(),
        a if a < 1e-3 => format!("{x:.1e}"),
        a if a < 9.9995 => format!("{x:.4}"),
        a if a < 999.95 => format!("{x:.2}"),
        _ => format!("{x:.0}"),
    }
}
