//! The one error of this crate: it always says where, what, and what to do about it.

use std::fmt;

/// Which part of the work failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// A file cannot be read or written.
    Io,
    /// A URDF is not well formed, or describes no robot we can simulate.
    Urdf,
    /// A YAML or JSON input is not well formed or has an unknown or contradictory entry.
    Yaml,
    /// The robot described is not physical.
    Model,
    /// A scenario asks for something that cannot be done.
    Scenario,
    /// A simulation left the finite numbers.
    Diverged,
    /// An array of the wrong length or with numbers that are not finite.
    Shape,
}

/// What went wrong, where, and how to mend it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// Which part of the work failed.
    pub kind: ErrorKind,
    /// The file, with the line where it is known (`robot.urdf:12`); empty where no file is concerned.
    pub file: String,
    /// The element of that file: a joint, a link, a key.
    pub element: String,
    /// What is wrong.
    pub problem: String,
    /// What the user can do.
    pub remedy: String,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for part in [&self.file, &self.element] {
            if !part.is_empty() {
                write!(f, "{part}: ")?;
            }
        }
        f.write_str(&self.problem)?;
        if !self.remedy.is_empty() {
            write!(f, "\n  remedy: {}", self.remedy)?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

/// Something the user should know that does not stop the work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The file, with the line where it is known.
    pub file: String,
    /// The element of that file.
    pub element: String,
    /// What was ignored or assumed, and why.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}", self.file, self.element, self.message)
    }
}

/// Results that cannot be written as JSON.
impl From<serde_json::Error> for Error {
    fn from(e: serde_json::Error) -> Self {
        Self {
            kind: ErrorKind::Io,
            file: String::new(),
            element: String::new(),
            problem: format!("the result cannot be written as JSON: {e}"),
            remedy: "use names of plain text".to_owned(),
        }
    }
}
