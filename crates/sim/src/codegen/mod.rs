//! Code and equations of a loaded robot: what is asked for by names, and the files that come out.

mod report;
mod request;
mod samples;

use crate::error::{Error, ErrorKind};
use crate::robot::{OwnedModel, Robot};
use gyroflex_codegen::emit::{self, File, Head, latex};
use gyroflex_codegen::explicit::{ExplicitModel, Options as ExplicitOptions};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::optimise::optimise;
use gyroflex_codegen::quantity::{self, Options};
use gyroflex_codegen::robot as symbolic;
use gyroflex_codegen::split::split;
use gyroflex_codegen::weigh;
use std::path::{Path, PathBuf};

pub use gyroflex_codegen::emit::{Language, Precision, Style};
pub use report::{Parts, Report, Row, Weighing};
pub use request::{NOT_EXPLICIT, Request, Simplify, Target};

/// Generated files, and what they compute at what cost.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The files, to be written where the user wants them.
    pub files: Vec<File>,
    /// What was generated.
    pub report: Report,
}

impl Generated {
    /// Writes the files into a folder, which is made if it does not exist; returns their paths.
    ///
    /// # Errors
    /// Names the file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, Error> {
        let failed = |path: &Path| {
            let path = path.display().to_string();
            move |e: std::io::Error| Error {
                kind: ErrorKind::Io,
                file: path,
                element: "output".to_owned(),
                problem: format!("cannot be written: {e}"),
                remedy: "choose a folder that you may write to".to_owned(),
            }
        };
        std::fs::create_dir_all(folder).map_err(failed(folder))?;
        let write = |file: &File| {
            let path = folder.join(&file.name);
            std::fs::write(&path, &file.text).map_err(failed(&path)).map(|()| path)
        };
        self.files.iter().map(write).collect()
    }
}

/// Generates code for a robot. `progress` hears how far the work is, from 0 to 1, and ends it by saying no.
///
/// # Errors
/// Names what was asked for and cannot be had. `None` if `progress` ended it.
pub fn generate(
    robot: &Robot,
    request: &Request,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Generated>, Error> {
    let fidelity = request.fidelity.unwrap_or(robot.fidelity);
    let model = robot.model(fidelity)?;
    let names = Names::of(robot);
    let source = names.source(robot, &model);
    let options = request.options(robot, &source)?;
    request.check(robot)?;
    let mut report = Report::of(robot, fidelity);
    let mut explicit = None;
    if request.is_explicit() {
        let choices = ExplicitOptions { kept: options.kept.clone(), ..ExplicitOptions::default() };
        let whole = ExplicitModel::of(&source, &choices).map_err(|e| request::not_explicit(robot, &e))?;
        explicit = match &request.simplify {
            None => Some(whole),
            Some(simplify) => match simplified(robot, &source, &whole, simplify, progress)? {
                None => return Ok(None),
                Some((model, weighing)) => {
                    report.weighing = weighing;
                    Some(model)
                }
            },
        };
    }
    let stem = request.stem.clone().unwrap_or_else(|| request::identifier(&robot.name));
    let head = Head {
        robot: robot.name.clone(),
        model: fidelity.name().to_owned(),
        command: request.command(robot, fidelity),
    };
    if let (Target::Latex, Some(model)) = (request.target, &explicit) {
        report.terms = Some(model.terms());
        let document = File { name: format!("{stem}.tex"), ..latex::document(model, &head) };
        return Ok(Some(Generated { files: vec![document], report }));
    }
    let Some(functions) = functions(robot, request, &source, &options, explicit.as_ref(), progress)? else {
        return Ok(None);
    };
    report.add(&functions);
    let files = match (request.target, request.split) {
        (Target::Code(_), Some(processors)) => {
            let parts: Vec<_> =
                functions.into_iter().map(|f| (split(&f, processors), f)).map(|(s, f)| (f, s)).collect();
            report.split(&parts);
            emit::parallel(&head, &parts, request.style, &stem)
        }
        (Target::Code(language), None) => emit::files(language, &head, &functions, request.style, &stem),
        (Target::Latex, _) => Vec::new(),
    };
    Ok(Some(Generated { files, report }))
}

/// The functions asked for, by the algorithms or by the explicit equations.
fn functions(
    robot: &Robot,
    request: &Request,
    source: &symbolic::Robot,
    options: &Options,
    explicit: Option<&ExplicitModel>,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Vec<Function>>, Error> {
    let quantities = request.quantities(robot, source, options, explicit)?;
    let steps = 2.0 * quantities.len() as f64;
    let mut functions = Vec::new();
    for quantity in quantities {
        let traced = match explicit {
            Some(model) => model.function(quantity),
            None => quantity::function(source, quantity, options),
        };
        let traced = traced.map_err(|e| request::unavailable(robot, e))?;
        if !progress((2.0 * functions.len() as f64 + 1.0) / steps) {
            return Ok(None);
        }
        functions.push(optimise(&traced));
        if !progress(2.0 * functions.len() as f64 / steps) {
            return Ok(None);
        }
    }
    Ok(Some(functions))
}

/// The model with the terms that matter, and what other tolerances would have left.
fn simplified(
    robot: &Robot,
    source: &symbolic::Robot,
    whole: &ExplicitModel,
    simplify: &Simplify,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<(ExplicitModel, Vec<Weighing>)>, Error> {
    let Some(samples) = samples::of(robot, source.fidelity, simplify, progress)? else { return Ok(None) };
    let mut tolerances = samples::TOLERANCES.to_vec();
    tolerances.retain(|t| *t != simplify.tolerance);
    tolerances.push(simplify.tolerance);
    tolerances.sort_by(|a, b| b.total_cmp(a));
    let (mut chosen, mut table) = (None, Vec::new());
    for (k, tolerance) in tolerances.iter().enumerate() {
        let simpler = weigh::simplify(whole, &samples, *tolerance);
        table.push(Weighing::of(&simpler.report));
        if *tolerance == simplify.tolerance {
            chosen = Some(simpler.model);
        }
        if !progress((k + 1) as f64 / tolerances.len() as f64) {
            return Ok(None);
        }
    }
    Ok(chosen.map(|model| (model, table)))
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
