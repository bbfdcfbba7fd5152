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

use crate::failure::{Failure, warn};
use gyroflex_sim::Robot;
use gyroflex_sim::load::{self, LoadOptions};
use std::path::Path;

/// Loads a robot and says what was ignored or assumed.
fn load(path: &Path, floating: bool, quiet: bool) -> Result<Robot, Failure> {
    let robot = load::load(path, &LoadOptions { floating, ..LoadOptions::default() })?;
    warn(&robot.warnings, quiet);
    Ok(robot)
}
