//! What was generated, as text and JSON.

use crate::robot::Robot;
use gyroflex::model::Fidelity;
use gyroflex_codegen::function::{Function, Operations};
use gyroflex_codegen::split::{HAND_OVER, Prediction, Split};
use gyroflex_codegen::weigh;
use serde::Serialize;
use std::fmt::Write;

/// What was generated: functions with their operation counts, and what was dropped or cut.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The robot's name.
    pub robot: String,
    /// Which model of it.
    pub model: String,
    /// One row per function.
    pub functions: Vec<Row>,
    /// Number of terms of explicit equations, where they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub terms: Option<usize>,
    /// What is left at several tolerances, where terms were weighed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub weighing: Vec<Weighing>,
    /// What the parts of each function cost, where they were cut.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Parts>,
}

/// What a tolerance leaves of a robot's equations.
#[derive(Clone, Debug, Serialize)]
pub struct Weighing {
    /// Largest part of an equation's largest torque that a dropped term may have.
    pub tolerance: f64,
    /// Terms of the whole equations.
    pub terms: usize,
    /// Terms that were kept.
    pub kept: usize,
    /// Terms below the tolerance that the inertia matrix needs to stay positive definite.
    pub restored: usize,
    /// Operations of forward dynamics.
    pub forward_operations: usize,
    /// Operations of inverse dynamics.
    pub inverse_operations: usize,
    /// Largest error of a torque, as part of the largest torque of its equation.
    pub torque_error: f64,
    /// Largest error of an acceleration, as part of the largest of its coordinate.
    pub acceleration_error: f64,
    /// Whether the coupling of links and motors vanished: what is left is a reduced model.
    pub reduced: bool,
}

/// What the parts of a function cost, in additions.
#[derive(Clone, Debug, Serialize)]
pub struct Parts {
    /// The function.
    pub name: String,
    /// The whole function.
    pub whole: f64,
    /// The longest chain of operations that wait for each other.
    pub critical_path: f64,
    /// What is computed before the parts.
    pub shared: f64,
    /// Each part.
    pub parts: Vec<f64>,
    /// How many times as fast, if handing over work cost nothing.
    pub ideal_speed_up: f64,
    /// How many times as fast.
    pub speed_up: f64,
}

/// One generated function.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Names of its arguments and how many numbers they have, in order.
    pub arguments: Vec<(String, usize)>,
    /// Names of its results and how many numbers they have, in order.
    pub outputs: Vec<(String, usize)>,
    /// All operations.
    pub operations: usize,
    /// Additions and subtractions.
    pub additions: usize,
    /// Multiplications.
    pub multiplications: usize,
    /// Divisions.
    pub divisions: usize,
    /// Sines and cosines.
    pub circular: usize,
    /// Everything else.
    pub others: usize,
    /// The longest chain of operations that wait for each other.
    pub depth: usize,
}

impl Report {
    pub(super) fn of(robot: &Robot, fidelity: Fidelity) -> Self {
        Self {
            robot: robot.name.clone(),
            model: fidelity.name().to_owned(),
            functions: Vec::new(),
            terms: None,
            weighing: Vec::new(),
            parts: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, functions: &[Function]) {
        self.functions.extend(functions.iter().map(Row::of));
    }

    pub(super) fn split(&mut self, functions: &[(Function, Split)]) {
        self.parts.extend(functions.iter().map(|(function, split)| Parts::of(function, &split.prediction)));
    }

    /// The same as JSON.
    pub fn json(&self) -> serde_json::Value {
        serde_json::to_value(self).unwrap_or_default()
    }

    /// Tables.
    pub fn text(&self) -> String {
        let mut text = format!("{}, {} model", self.robot, self.model);
        if let Some(terms) = self.terms {
            let _ = write!(text, ": {terms} terms");
        }
        if !self.functions.is_empty() {
            text += "\n";
            text += &table(&Row::COLUMNS, self.functions.iter().map(Row::cells));
        }
        if !self.weighing.is_empty() {
            text += "\n\n";
            text += &table(&Weighing::COLUMNS, self.weighing.iter().map(Weighing::cells));
        }
        if !self.parts.is_empty() {
            text += "\n\n";
            text += &table(&Parts::COLUMNS, self.parts.iter().map(Parts::cells));
            for parts in self.parts.iter().filter(|parts| parts.speed_up < 1.0) {
                let _ = write!(
                    text,
                    "\n{}: too short to split: handing over work takes as long as {HAND_OVER} additions, the function {:.0}",
                    parts.name, parts.whole
                );
            }
        }
        text
    }
}

/// Rows under their headings, the first column to the left.
fn table<const N: usize>(headings: &[&str; N], rows: impl Iterator<Item = [String; N]>) -> String {
    let rows: Vec<[String; N]> = rows.collect();
    let width = |k: usize| rows.iter().map(|row| row[k].len()).max().unwrap_or(0).max(headings[k].len());
    let line = |cells: [&str; N]| {
        let cell = |k: usize| {
            if k == 0 { format!("{:w$}", cells[k], w = width(k)) } else { format!("{:>w$}", cells[k], w = width(k)) }
        };
        (0..N).map(cell).collect::<Vec<_>>().join("  ")
    };
    let mut lines = vec![line(*headings)];
    lines.extend(rows.iter().map(|row| line(row.each_ref().map(String::as_str))));
    lines.join("\n")
}

impl Weighing {
    const COLUMNS: [&str; 8] =
        ["tolerance", "terms", "restored", "forward", "inverse", "torque error", "acceleration error", "model"];

    pub(super) fn of(report: &weigh::Report) -> Self {
        Self {
            tolerance: report.tolerance,
            terms: report.terms,
            kept: report.kept,
            restored: report.restored,
            forward_operations: report.forward_operations,
            inverse_operations: report.inverse_operations,
            torque_error: report.torque_error(),
            acceleration_error: report.acceleration_error(),
            reduced: report.uncoupled,
        }
    }

    fn cells(&self) -> [String; 8] {
        [
            format!("{:e}", self.tolerance),
            format!("{} of {}", self.kept, self.terms),
            self.restored.to_string(),
            self.forward_operations.to_string(),
            self.inverse_operations.to_string(),
            format!("{:.1e}", self.torque_error),
            format!("{:.1e}", self.acceleration_error),
            (if self.reduced { "reduced" } else { "" }).to_owned(),
        ]
    }
}

impl Parts {
    const COLUMNS: [&str; 7] = ["in parts", "whole", "critical path", "shared", "parts", "ideal speed-up", "predicted"];

    fn of(function: &Function, prediction: &Prediction) -> Self {
        Self {
            name: function.name.clone(),
            whole: prediction.whole,
            critical_path: prediction.critical_path,
            shared: prediction.shared,
            parts: prediction.parts.clone(),
            ideal_speed_up: prediction.ideal_speed_up(),
            speed_up: prediction.speed_up(),
        }
    }

    fn cells(&self) -> [String; 7] {
        let parts: Vec<String> = self.parts.iter().map(|x| format!("{x:.0}")).collect();
        [
            self.name.clone(),
            format!("{:.0}", self.whole),
            format!("{:.0}", self.critical_path),
            format!("{:.0}", self.shared),
            parts.join(" "),
            format!("{:.2}", self.ideal_speed_up),
            format!("{:.2}", self.speed_up),
        ]
    }
}

impl Row {
    const COLUMNS: [&str; 8] =
        ["function", "operations", "additions", "products", "divisions", "sin, cos", "others", "depth"];

    fn cells(&self) -> [String; 8] {
        let counts = [
            self.operations,
            self.additions,
            self.multiplications,
            self.divisions,
            self.circular,
            self.others,
            self.depth,
        ];
        let mut cells = [const { String::new() }; 8];
        cells[0].clone_from(&self.name);
        cells[1..].iter_mut().zip(counts).for_each(|(cell, count)| *cell = count.to_string());
        cells
    }

    fn of(function: &Function) -> Self {
        let count: Operations = function.operations();
        Self {
            name: function.name.clone(),
            arguments: function.arguments.iter().map(|a| (a.name.clone(), a.len)).collect(),
            outputs: function.outputs.iter().map(|o| (o.name.clone(), o.entries.len())).collect(),
            operations: count.total(),
            additions: count.additions,
            multiplications: count.multiplications,
            divisions: count.divisions,
            circular: count.circular,
            others: count.others,
            depth: function.depth(),
        }
    }
}
