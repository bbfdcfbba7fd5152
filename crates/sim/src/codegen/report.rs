//! What was generated, as text and JSON.

use crate::robot::Robot;
use gyroflex::model::Fidelity;
use gyroflex_codegen::function::{Function, Operations};
use serde::Serialize;
use std::fmt::Write;

/// Functions with their operation counts.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The robot's name.
    pub robot: String,
    /// Which model of it.
    pub model: String,
    /// One row per function.
    pub functions: Vec<Row>,
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
    pub(super) fn of(robot: &Robot, fidelity: Fidelity, functions: &[Function]) -> Self {
        let functions = functions.iter().map(Row::of).collect();
        Self { robot: robot.name.clone(), model: fidelity.name().to_owned(), functions }
    }

    /// The same as JSON.
    pub fn json(&self) -> serde_json::Value {
        serde_json::to_value(self).unwrap_or_default()
    }

    /// A table.
    pub fn text(&self) -> String {
        let mut text = format!("{}, {} model\n", self.robot, self.model);
        let width = self.functions.iter().map(|row| row.name.len()).max().unwrap_or(0).max(8);
        let _ = write!(
            text,
            "{:width$} {:>10} {:>9} {:>9} {:>9} {:>7} {:>7} {:>7}",
            "function", "operations", "additions", "products", "divisions", "sin,cos", "others", "depth"
        );
        for row in &self.functions {
            let _ = write!(
                text,
                "\n{:width$} {:>10} {:>9} {:>9} {:>9} {:>7} {:>7} {:>7}",
                row.name,
                row.operations,
                row.additions,
                row.multiplications,
                row.divisions,
                row.circular,
                row.others,
                row.depth
            );
        }
        text
    }
}

impl Row {
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
