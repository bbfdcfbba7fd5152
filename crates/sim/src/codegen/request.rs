//! What is asked for, by the names of the command line.

use super::symbolic;
use crate::error::{Error, ErrorKind};
use crate::load::{Overrides, file_of};
use crate::robot::Robot;
use crate::scenario::ScenarioFile;
use gyroflex::dynamics::Axes;
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{Language, Precision, Style};
use gyroflex_codegen::explicit::{ExplicitModel, NotExplicit};
use gyroflex_codegen::quantity::{self, Options, Point, Quantity, Unavailable};
use gyroflex_codegen::robot::{Parameter, UnknownParameter};

/// What to write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Code in a language.
    Code(Language),
    /// The explicit equations as a LaTeX document.
    Latex,
}

/// Which terms to drop.
#[derive(Clone, Debug)]
pub struct Simplify {
    /// Largest part of an equation's largest torque that a dropped term may have [–].
    pub tolerance: f64,
    /// The scenario whose motion counts; `None`: motions all over the workspace.
    pub along: Option<ScenarioFile>,
}

/// What to generate.
#[derive(Clone, Debug)]
pub struct Request {
    /// Names of quantities; `all` is all that the robot has.
    pub what: Vec<String>,
    /// What to write.
    pub target: Target,
    /// Number type and lanes of the code.
    pub style: Style,
    /// Which model; `None` is the robot's own.
    pub fidelity: Option<Fidelity>,
    /// Names of parameters that stay symbols.
    pub kept: Vec<String>,
    /// The link whose Jacobian is asked for; `None` is the last that moves.
    pub link: Option<String>,
    /// Which terms to drop; `None` is none.
    pub simplify: Option<Simplify>,
    /// For how many processors to cut the functions.
    pub split: Option<usize>,
    /// Name of the files without what the language appends; `None` is the robot's.
    pub stem: Option<String>,
    /// What the robot has otherwise than its files say, for the command that generated code repeats.
    pub overrides: Overrides,
}

/// More processors or lanes than there are for one function.
const MOST: usize = 1025;

impl Request {
    /// Whether the explicit equations are asked for, and not the algorithms.
    pub(super) fn is_explicit(&self) -> bool {
        self.target == Target::Latex || self.simplify.is_some()
    }

    /// Choices that do not go together.
    pub(super) fn check(&self, robot: &Robot) -> Result<(), Error> {
        let rust = self.target == Target::Code(Language::Rust);
        let wrong = |element: &str, problem: &str, remedy: &str| Err(wrong(robot, element, problem.to_owned(), remedy));
        if self.stem.as_ref().is_some_and(|stem| stem.is_empty() || identifier(stem) != stem.to_ascii_lowercase()) {
            return wrong(
                "--name",
                "it is no name of a file and of functions",
                "give letters, digits and underscores, a letter first",
            );
        }
        if self.what.is_empty() {
            return wrong("--what", "nothing is asked for", "name a quantity, or `all`");
        }
        match (self.split, self.style.lanes, &self.simplify) {
            (Some(_), ..) if !rust => {
                wrong("--split", "parts are run side by side by Rust alone", "choose --lang rust")
            }
            (Some(0), ..) => wrong("--split", "there is no part", "give at least 1"),
            (Some(MOST..), ..) => wrong("--split", "no machine has so many processors", "give as many as it has"),
            (_, Some(_), _) if !rust => wrong("--lanes", "lanes are Rust's", "choose --lang rust"),
            (_, Some(0), _) => wrong("--lanes", "there is no lane", "give at least 1"),
            (_, Some(MOST..), _) => wrong("--lanes", "no processor has so many lanes", "give 4 or 8, say"),
            (.., Some(simplify)) if !(simplify.tolerance.is_finite() && simplify.tolerance >= 0.0) => {
                wrong("--simplify-to", "it is not a part of a torque", "give a number from 0 up, such as 1e-3")
            }
            _ => Ok(()),
        }
    }

    /// The quantities asked for, once each.
    pub(super) fn quantities(
        &self,
        robot: &Robot,
        source: &symbolic::Robot,
        options: &Options,
        explicit: Option<&ExplicitModel>,
    ) -> Result<Vec<Quantity>, Error> {
        let mut quantities = Vec::new();
        for name in &self.what {
            let named: Vec<Quantity> = match (name.as_str(), explicit) {
                ("all", None) => quantity::available(source, options),
                ("all", Some(model)) => Quantity::ALL.iter().copied().filter(|q| model.function(*q).is_ok()).collect(),
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
        let parameter = |name: &String| Parameter::of(name, source).map_err(|e| no_parameter(robot, &e));
        let kept = self.kept.iter().map(parameter).collect::<Result<_, _>>()?;
        let point = self.link.as_ref().map(|name| point(robot, name)).transpose()?;
        Ok(Options { kept, point, ..Options::default() })
    }

    /// How the same files are made again.
    pub(super) fn command(&self, robot: &Robot, fidelity: Fidelity) -> String {
        let file = file_of(robot).unwrap_or("ROBOT");
        let language = match self.target {
            Target::Code(language) => language.name(),
            Target::Latex => "latex",
        };
        let mut command = format!("gyroflex codegen {file} --model {} --lang {language}", fidelity.name());
        if self.target != Target::Latex {
            command += &format!(" --what {}", self.what.join(","));
            command += if self.style.precision == Precision::Single { " --scalar f32" } else { "" };
        }
        command += if robot.is_floating() { " --floating" } else { "" };
        for (key, value) in self.overrides.iter() {
            command += &format!(" --set '{key}={value}'");
        }
        for name in &self.kept {
            command += &format!(" --keep-symbol {name}");
        }
        let number = |key: &str, n: Option<usize>| n.map_or(String::new(), |n| format!(" --{key} {n}"));
        command += &(number("lanes", self.style.lanes) + &number("split", self.split));
        if let Some(link) = &self.link {
            command += &format!(" --link {link}");
        }
        if let Some(simplify) = &self.simplify {
            command += &format!(" --simplify-to {}", simplify.tolerance);
            if let Some(file) = &simplify.along {
                command += &format!(" --along {}", file.path.file_name().unwrap_or_default().to_string_lossy());
            }
        }
        command
    }
}

fn named(robot: &Robot, name: &str) -> Result<Quantity, Error> {
    Quantity::ALL.iter().copied().find(|q| q.name() == name).ok_or_else(|| {
        let names: Vec<&str> = Quantity::ALL.iter().map(|q| q.name()).collect();
        let remedy = format!("choose from {}, all", names.join(", "));
        wrong(robot, "--what", format!("nothing is called `{name}`"), &remedy)
    })
}

/// A parameter that the robot does not have.
fn no_parameter(robot: &Robot, e: &UnknownParameter) -> Error {
    let remedy = match &e.nearest {
        Some(nearest) => format!("the nearest is `{nearest}`; choose from {}", e.known.join(", ")),
        None => "leave it out: no parameter of this robot may stay a symbol".to_owned(),
    };
    wrong(robot, "--keep-symbol", format!("the robot has no parameter `{}` in this model", e.name), &remedy)
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

/// What an error is about whose robot has no explicit equations, which no option asks for by itself.
pub const NOT_EXPLICIT: &str = "explicit equations";

/// A robot without explicit equations.
pub(super) fn not_explicit(robot: &Robot, e: &NotExplicit) -> Error {
    wrong(robot, NOT_EXPLICIT, e.to_string(), "generate code without --simplify-to, which every robot has")
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
