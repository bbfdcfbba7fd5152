//! What is asked for, by the names of the command line.

use super::symbolic;
use crate::error::{Error, ErrorKind};
use crate::robot::Robot;
use gyroflex::dynamics::Axes;
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{Language, Precision};
use gyroflex_codegen::quantity::{self, Options, Point, Quantity, Unavailable};
use gyroflex_codegen::robot::Parameter;

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
    /// Names of parameters that stay symbols.
    pub kept: Vec<String>,
    /// The link whose Jacobian is asked for; `None` is the last that moves.
    pub link: Option<String>,
    /// Name of the files without what the language appends; `None` is the robot's.
    pub stem: Option<String>,
}

impl Request {
    /// The quantities asked for, once each.
    pub(super) fn quantities(
        &self,
        robot: &Robot,
        source: &symbolic::Robot,
        options: &Options,
    ) -> Result<Vec<Quantity>, Error> {
        let mut quantities = Vec::new();
        for name in &self.what {
            let named: Vec<Quantity> = match name.as_str() {
                "all" => quantity::available(source, options),
                _ => vec![named(robot, name)?],
            };
            for quantity in named {
                if !quantities.contains(&quantity) {
                    quantities.push(quantity);
                }
            }
        }
        Ok(quantities)
    }

    /// Parameters that stay symbols, and the frame of the Jacobian.
    pub(super) fn options(&self, robot: &Robot, source: &symbolic::Robot) -> Result<Options, Error> {
        let parameter =
            |name: &String| Parameter::of(name, source).map_err(|e| wrong(robot, "--keep-symbol", e.to_string(), ""));
        let kept = self.kept.iter().map(parameter).collect::<Result<_, _>>()?;
        let point = self.link.as_ref().map(|name| point(robot, name)).transpose()?;
        Ok(Options { kept, point, ..Options::default() })
    }

    /// How the same files are made again.
    pub(super) fn command(&self, fidelity: Fidelity) -> String {
        format!("gyroflex codegen ROBOT --what {} --model {}", self.what.join(","), fidelity.name())
    }
}

fn named(robot: &Robot, name: &str) -> Result<Quantity, Error> {
    Quantity::ALL.iter().copied().find(|q| q.name() == name).ok_or_else(|| {
        let names: Vec<&str> = Quantity::ALL.iter().map(|q| q.name()).collect();
        let remedy = format!("choose from {}, all", names.join(", "));
        wrong(robot, "--what", format!("nothing is called `{name}`"), &remedy)
    })
}

/// The origin of a link, moving or fixed to one that moves, in the axes of the world.
fn point(robot: &Robot, name: &str) -> Result<Point, Error> {
    let problem = |problem: &str| {
        let names: Vec<&str> = robot.links.iter().filter(|l| l.body.is_some()).map(|l| l.name.as_str()).collect();
        wrong(robot, "--link", format!("{problem} `{name}`"), &format!("choose from {}", names.join(", ")))
    };
    let link = robot.links.iter().find(|l| l.name == name).ok_or_else(|| problem("there is no link"))?;
    let body = link.body.ok_or_else(|| problem("nothing moves the link"))?;
    Ok(Point { body, placement: link.placement, axes: Axes::World })
}

/// What is wrong with a request.
fn wrong(robot: &Robot, element: &str, problem: String, remedy: &str) -> Error {
    let files: Vec<&str> = robot.sources.iter().map(|s| s.name.as_str()).collect();
    Error {
        kind: ErrorKind::Scenario,
        file: files.join(", "),
        element: element.to_owned(),
        problem,
        remedy: remedy.to_owned(),
    }
}

/// A quantity that the robot does not have.
pub(super) fn unavailable(robot: &Robot, e: Unavailable) -> Error {
    wrong(robot, &format!("--what {}", e.quantity.name()), e.reason, &e.remedy)
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
