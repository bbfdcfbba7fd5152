//! What is asked for, by the names of the command line.

use super::symbolic;
use crate::error::{Error, ErrorKind};
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{Language, Precision};
use gyroflex_codegen::quantity::{self, Quantity};

/// What to generate.
#[derive(Clone, Debug)]
pub struct Request {
    /// Names of quantities; `all` is all that the robot has.
    pub what: Vec<String>,
    /// The language.
    pub language: Language,
    /// The number type of the code.
    pub precision: Precision,
    /// Which model; `None` is the robot's own.
    pub fidelity: Option<Fidelity>,
    /// Name of the files without what the language appends; `None` is the robot's.
    pub stem: Option<String>,
}

impl Request {
    /// The quantities asked for, once each.
    pub(super) fn quantities(&self, robot: &symbolic::Robot) -> Result<Vec<Quantity>, Error> {
        let mut quantities = Vec::new();
        for name in &self.what {
            let named: Vec<Quantity> = match name.as_str() {
                "all" => Quantity::ALL.iter().copied().filter(|q| quantity::function(robot, *q).is_ok()).collect(),
                _ => vec![named(name)?],
            };
            for quantity in named {
                if !quantities.contains(&quantity) {
                    quantities.push(quantity);
                }
            }
        }
        Ok(quantities)
    }

    /// How the same files are made again.
    pub(super) fn command(&self, fidelity: Fidelity) -> String {
        format!("gyroflex codegen ROBOT --what {} --model {}", self.what.join(","), fidelity.name())
    }
}

fn named(name: &str) -> Result<Quantity, Error> {
    let known = Quantity::ALL.iter().find(|q| q.name() == name);
    known.copied().ok_or_else(|| {
        let names: Vec<&str> = Quantity::ALL.iter().map(|q| q.name()).collect();
        Error {
            kind: ErrorKind::Scenario,
            file: String::new(),
            element: "--what".to_owned(),
            problem: format!("nothing is called `{name}`"),
            remedy: format!("choose from {}, all", names.join(", ")),
        }
    })
}

/// A name as programs may have it.
pub(super) fn identifier(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    let text: String = name.chars().map(plain).collect();
    match text.chars().next() {
        None => "robot".to_owned(),
        Some(c) if c.is_ascii_digit() => format!("robot_{text}"),
        Some(_) => text,
    }
}
