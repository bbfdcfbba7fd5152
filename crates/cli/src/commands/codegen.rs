//! `gyroflex codegen`: a robot's equations as code.

use super::{load, output};
use crate::args::{Codegen, LanguageName, Scalar};
use crate::failure::{Failure, print, say};
use crate::json;
use crate::progress::{STEPS, progress_bar, stop_flag};
use gyroflex_sim::ScenarioFile;
use gyroflex_sim::codegen::{Language, Precision, Request, Simplify, Style, Target, generate};
use gyroflex_sim::load::Disk;
use std::sync::atomic::Ordering;

pub fn run(args: &Codegen, quiet: bool) -> Result<(), Failure> {
    let robot = load(&args.robot, args.floating, &args.set, quiet)?;
    let along = args.along.as_deref().map(|path| ScenarioFile::load(&Disk, path)).transpose()?;
    let request = Request {
        what: args.what.clone(),
        target: args.lang.into(),
        style: Style { precision: args.scalar.into(), lanes: args.lanes },
        fidelity: args.model.map(Into::into),
        kept: args.keep_symbol.clone(),
        link: args.link.clone(),
        simplify: args.simplify_to.map(|tolerance| Simplify { tolerance, along }),
        split: args.split,
        stem: args.name.clone(),
        overrides: args.set.overrides(),
    };
    let stop = stop_flag(quiet, "end the generation");
    let bar = progress_bar(quiet, "generating");
    let generated = generate(&robot, &request, &mut |done| {
        bar.set_position((done * STEPS as f64) as u64);
        !stop.load(Ordering::Relaxed)
    });
    bar.finish_and_clear();
    let Some(generated) = generated? else { return Err(Failure::Interrupted) };
    for file in &generated.files {
        output::spare_the_robot(&args.output.join(&file.name), &args.robot)?;
    }
    let written = generated.write(&args.output)?;
    if !quiet {
        let names: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
        say(&format!("written: {}", names.join(", ")));
    }
    if args.json { print(&json::text(&generated.report.json())) } else { print(&generated.report.text()) }
}

impl From<LanguageName> for Target {
    fn from(name: LanguageName) -> Self {
        match name {
            LanguageName::Rust => Self::Code(Language::Rust),
            LanguageName::C => Self::Code(Language::C),
            LanguageName::Python => Self::Code(Language::Python),
            LanguageName::Json => Self::Code(Language::Json),
            LanguageName::Latex => Self::Latex,
        }
    }
}

impl From<Scalar> for Precision {
    fn from(scalar: Scalar) -> Self {
        match scalar {
            Scalar::F32 => Self::Single,
            Scalar::F64 => Self::Double,
        }
    }
}
