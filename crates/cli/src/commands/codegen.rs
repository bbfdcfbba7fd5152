//! `gyroflex codegen`: a robot's equations as code.

use super::{load, output};
use crate::args::{Codegen, LanguageName, Scalar};
use crate::failure::{Failure, print, say};
use crate::json;
use crate::progress::{STEPS, progress_bar, stop_flag};
use gyroflex_sim::codegen::{Language, Precision, Request, generate};
use std::sync::atomic::Ordering;

pub fn run(args: &Codegen, quiet: bool) -> Result<(), Failure> {
    let robot = load(&args.robot, args.floating, quiet)?;
    let request = Request {
        what: args.what.clone(),
        language: args.lang.into(),
        precision: match args.scalar {
            Scalar::F32 => Precision::Single,
            Scalar::F64 => Precision::Double,
        },
        fidelity: args.model.map(Into::into),
        kept: args.keep_symbol.clone(),
        link: args.link.clone(),
        stem: args.name.clone(),
    };
    let stop = stop_flag(quiet, "end the generation");
    let bar = progress_bar(quiet, "generating");
    let generated = generate(&robot, &request, |done| {
        bar.set_position((done * STEPS as f64) as u64);
        !stop.load(Ordering::Relaxed)
    });
    bar.finish_and_clear();
    let Some(generated) = generated? else { return Err(Failure::Interrupted) };
    for file in &generated.files {
        output::write(&args.output.join(&file.name), file.text.as_bytes(), &args.robot)?;
    }
    if !quiet {
        let names: Vec<String> =
            generated.files.iter().map(|f| args.output.join(&f.name).display().to_string()).collect();
        say(&format!("written: {}", names.join(", ")));
    }
    if args.json { print(&json::text(&generated.report.json())) } else { print(&generated.report.text()) }
}

impl From<LanguageName> for Language {
    fn from(name: LanguageName) -> Self {
        match name {
            LanguageName::Rust => Self::Rust,
        }
    }
}
