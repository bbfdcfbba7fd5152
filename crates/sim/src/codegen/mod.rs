//! Code for a loaded robot: what is asked for by names, and the files that come out.

mod report;
mod request;

use crate::error::Error;
use crate::robot::{OwnedModel, Robot};
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{self, File, Head};
pub use gyroflex_codegen::emit::{Language, Precision};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::optimise::optimise;
use gyroflex_codegen::quantity;
use gyroflex_codegen::robot as symbolic;
pub use report::{Report, Row};
pub use request::Request;

/// Generated files, and what they compute at what cost.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The files, to be written where the user wants them.
    pub files: Vec<File>,
    /// What was generated.
    pub report: Report,
}

/// Generates code for a robot. `progress` hears how far the work is, from 0 to 1, and ends it by saying no.
///
/// # Errors
/// Names what was asked for and cannot be had. `None` if `progress` ended it.
pub fn generate(
    robot: &Robot,
    request: &Request,
    mut progress: impl FnMut(f64) -> bool,
) -> Result<Option<Generated>, Error> {
    let fidelity = request.fidelity.unwrap_or(robot.fidelity);
    let model = robot.model(fidelity)?;
    let names = Names::of(robot);
    let source = names.source(robot, &model);
    let options = request.options(robot, &source)?;
    let quantities = request.quantities(robot, &source, &options)?;
    let steps = quantities.len() as f64;
    let mut functions: Vec<Function> = Vec::new();
    for (i, quantity) in quantities.into_iter().enumerate() {
        let traced = quantity::function(&source, quantity, &options).map_err(|e| request::unavailable(robot, e))?;
        if !progress((i as f64 + 0.5) / steps) {
            return Ok(None);
        }
        functions.push(optimise(&traced));
        if !progress((i as f64 + 1.0) / steps) {
            return Ok(None);
        }
    }
    let stem = request.stem.clone().unwrap_or_else(|| request::identifier(&robot.name));
    let head = head(robot, fidelity, request);
    let files = emit::files(request.language, &head, &functions, request.precision, &stem);
    let report = Report::of(robot, fidelity, &functions);
    Ok(Some(Generated { files, report }))
}

/// Names of a robot's joints and links, as the symbolic robot borrows them.
struct Names {
    joints: Vec<String>,
    links: Vec<String>,
}

impl Names {
    fn of(robot: &Robot) -> Self {
        Self {
            joints: robot.joints.iter().map(|j| j.name.clone()).collect(),
            links: robot.joints.iter().map(|j| j.child_link.clone()).collect(),
        }
    }

    fn source<'a>(&'a self, robot: &'a Robot, model: &'a OwnedModel) -> symbolic::Robot<'a> {
        symbolic::Robot {
            name: &robot.name,
            joints: &self.joints,
            links: &self.links,
            spec: robot.spec(),
            fidelity: model.fidelity,
            model: model.view(),
            flexible: model.flexible(),
            payload: robot.payload.and_then(|load| load.body.map(|body| (body, load.inertia))),
        }
    }
}

fn head(robot: &Robot, fidelity: Fidelity, request: &Request) -> Head {
    Head { robot: robot.name.clone(), model: fidelity.name().to_owned(), command: request.command(fidelity) }
}
