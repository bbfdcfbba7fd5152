//! One file a command.

pub mod analyze;
pub mod bench;
pub mod codegen;
pub mod compare;
pub mod completions;
pub mod eval;
pub mod export;
pub mod frf;
pub mod info;
pub mod inverse;
pub mod linearize;
mod logs;
pub mod modes;
mod output;
mod pose;
pub mod schema;
pub mod simulate;
pub mod sweep;

use crate::args::Set;
use crate::failure::{Failure, warn};
use gyroflex_sim::Robot;
use gyroflex_sim::load::{self, LoadOptions};
use std::path::Path;

/// Loads a robot and says what was ignored or assumed.
fn load(path: &Path, floating: bool, set: &Set, quiet: bool) -> Result<Robot, Failure> {
    let options = LoadOptions { floating, overrides: set.overrides(), ..LoadOptions::default() };
    let robot = load::load(path, &options)?;
    warn(&robot.warnings, quiet);
    Ok(robot)
}
