//! How a command can end other than well, and where its words go.

use gyroflex_sim::error::{Error, ErrorKind, Warning};
use std::io::{self, Write};

/// Why a command did not finish.
#[derive(Debug)]
pub enum Failure {
    /// Something is wrong; the user reads why.
    Error(Box<Error>),
    /// Ctrl-C.
    Interrupted,
    /// Whoever read our output has stopped reading, which is fine.
    Pipe,
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Error(Box::new(error))
    }
}

impl Failure {
    /// Says it and gives the exit code.
    pub fn report(&self) -> u8 {
        match self {
            Self::Error(error) => {
                say(&format!("error: {error}"));
                1
            }
            Self::Interrupted => 130,
            Self::Pipe => 0,
        }
    }
}

/// Prints one line to standard output.
pub fn print(line: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    writeln!(out, "{line}").and_then(|()| out.flush()).map_err(|e| match e.kind() {
        io::ErrorKind::BrokenPipe => Failure::Pipe,
        _ => Error {
            kind: ErrorKind::Io,
            file: "standard output".to_owned(),
            element: String::new(),
            problem: format!("cannot be written: {e}"),
            remedy: "check the disk or the program it is sent to".to_owned(),
        }
        .into(),
    })
}

/// Prints one line to standard error. If nobody can read it there is nobody to tell.
pub fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Prints warnings, unless the user wants quiet.
pub fn warn(warnings: &[Warning], quiet: bool) {
    if !quiet {
        warnings.iter().for_each(|w| say(&format!("warning: {w}")));
    }
}
