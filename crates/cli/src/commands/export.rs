//! `gyroflex export`: a robot as source code.

use super::load;
use crate::args::{Export, Scalar};
use crate::failure::{Failure, print, say};
use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::export::{self, Precision};
use std::path::Path;

pub fn run(args: &Export, quiet: bool) -> Result<(), Failure> {
    let robot = load(&args.robot, args.floating, quiet)?;
    let fidelity = args.model.map_or(robot.fidelity, Into::into);
    let source = export::rust(&robot, fidelity, args.scalar.into())?;
    let Some(output) = &args.output else { return print(source.trim_end()) };
    spare_the_robot(output, &args.robot)?;
    std::fs::write(output, source).map_err(|e| Error {
        problem: format!("cannot be written: {e}"),
        remedy: "choose a folder that exists and that you may write to".to_owned(),
        ..about(output)
    })?;
    if !quiet {
        say(&format!("written: {}; it needs the crate gyroflex and nothing else", output.display()));
    }
    Ok(())
}

impl From<Scalar> for Precision {
    fn from(scalar: Scalar) -> Self {
        match scalar {
            Scalar::F32 => Self::Single,
            Scalar::F64 => Self::Double,
        }
    }
}

/// Refuses to write over the robot.
fn spare_the_robot(output: &Path, robot: &Path) -> Result<(), Error> {
    match (output.canonicalize(), robot.canonicalize()) {
        (Ok(a), Ok(b)) if a == b => Err(Error {
            problem: "it is the robot, and would be overwritten".to_owned(),
            remedy: "name another file".to_owned(),
            ..about(output)
        }),
        _ => Ok(()),
    }
}

fn about(output: &Path) -> Error {
    Error {
        kind: ErrorKind::Io,
        file: output.display().to_string(),
        element: "output".to_owned(),
        problem: String::new(),
        remedy: String::new(),
    }
}
