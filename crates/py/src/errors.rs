//! Errors of the simulator as the exceptions of `gyroflex.errors`.

use gyroflex_sim::error::{Error, ErrorKind, Warning};
use pyo3::prelude::*;
use std::ffi::CString;
use std::path::Path;

/// The classes of `python/gyroflex/errors.py`.
mod classes {
    use pyo3::import_exception;

    import_exception!(gyroflex.errors, ArgumentError);
    import_exception!(gyroflex.errors, DivergedError);
    import_exception!(gyroflex.errors, FileError);
    import_exception!(gyroflex.errors, FormatError);
    import_exception!(gyroflex.errors, ModelError);
    import_exception!(gyroflex.errors, NotFiniteError);
    import_exception!(gyroflex.errors, RobotWarning);
    import_exception!(gyroflex.errors, ScenarioError);
    import_exception!(gyroflex.errors, ShapeError);
}

/// The exception for an error of the simulator.
pub(crate) fn raise(error: impl Into<Error>) -> PyErr {
    let error = error.into();
    let kind = error.kind;
    let fields = (error.problem, error.element, error.file, error.remedy);
    match kind {
        ErrorKind::Io => classes::FileError::new_err(fields),
        ErrorKind::Urdf | ErrorKind::Yaml => classes::FormatError::new_err(fields),
        ErrorKind::Model => classes::ModelError::new_err(fields),
        ErrorKind::Scenario => classes::ScenarioError::new_err(fields),
        ErrorKind::Diverged => classes::DivergedError::new_err(fields),
        ErrorKind::Shape => classes::ShapeError::new_err(fields),
    }
}

/// An argument whose value is not allowed.
pub(crate) fn argument(name: &str, problem: impl Into<String>, remedy: impl Into<String>) -> PyErr {
    classes::ArgumentError::new_err((problem.into(), format!("argument `{name}`"), "", remedy.into()))
}

/// Motor torques that are not given. Words of one place, for every call that needs them.
pub(crate) fn missing_torques(name: &str) -> PyErr {
    argument(name, "it is missing", "give the motor torques, zeros for none")
}

/// An array over the motors that only a model with elastic joints needs.
pub(crate) fn missing_of_elastic(name: &str) -> PyErr {
    let problem = "it is missing, but the robot has elastic joints in this model";
    argument(name, problem, "give one entry per velocity coordinate, or choose a model with rigid transmissions")
}

/// A file that cannot be used.
pub(crate) fn file(path: &Path, problem: impl Into<String>, remedy: impl Into<String>) -> PyErr {
    classes::FileError::new_err((problem.into(), "", path.display().to_string(), remedy.into()))
}

/// An array argument of the wrong shape.
pub(crate) fn shape(name: &str, problem: impl Into<String>, remedy: impl Into<String>) -> PyErr {
    classes::ShapeError::new_err((problem.into(), format!("argument `{name}`"), "", remedy.into()))
}

/// An array argument with an entry that is not a finite number.
pub(crate) fn not_finite(name: &str, index: String, value: f64) -> PyErr {
    let element = format!("argument `{name}`, entry {index}");
    classes::NotFiniteError::new_err((format!("{value} is not a finite number"), element, "", "give a finite number"))
}

/// A result too large for a number, from arguments that are.
pub(crate) fn overflow(name: &str) -> PyErr {
    let remedy = "check the size of the numbers given";
    classes::DivergedError::new_err((format!("the result `{name}` is not finite"), "", "", remedy))
}

/// Hands the loader's warnings to Python's `warnings`, pointing at the caller's line.
pub(crate) fn warn(py: Python<'_>, warnings: &[Warning]) -> PyResult<()> {
    if warnings.is_empty() {
        return Ok(());
    }
    let category = py.get_type::<classes::RobotWarning>();
    for warning in warnings {
        // No file a user can write has a NUL in it after parsing, but a C string must not.
        let text = CString::new(warning.to_string().replace('\0', " ")).unwrap_or_default();
        PyErr::warn(py, &category, &text, 1)?;
    }
    Ok(())
}
