//! Files that a command writes.

use gyroflex_sim::error::{Error, ErrorKind};
use std::path::Path;

/// Writes a file, but not over the robot.
pub fn write(path: &Path, content: &[u8], robot: &Path) -> Result<(), Error> {
    spare_the_robot(path, robot)?;
    std::fs::write(path, content).map_err(|e| Error {
        problem: format!("cannot be written: {e}"),
        remedy: "choose a folder that exists and that you may write to".to_owned(),
        ..about(path)
    })
}

/// Refuses to write over the robot.
pub fn spare_the_robot(output: &Path, robot: &Path) -> Result<(), Error> {
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
