//! `gyroflex export`: a robot as source code.

use super::{load, output};
use crate::args::{Export, Scalar};
use crate::failure::{Failure, print, say};
use gyroflex_sim::export::{self, Precision};

pub fn run(args: &Export, quiet: bool) -> Result<(), Failure> {
    let robot = load(&args.robot, args.floating, &args.set, quiet)?;
    let fidelity = args.model.map_or(robot.fidelity, Into::into);
    let source = export::rust(&robot, fidelity, args.scalar.into())?;
    let Some(path) = &args.output else { return print(source.trim_end()) };
    output::write(path, source.as_bytes(), &args.robot)?;
    if !quiet {
        say(&format!("written: {}; it needs the crate gyroflex and nothing else", path.display()));
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
