//! Arguments that PyO3 would refuse without their names: counts, numbers, points and lists of names.

use crate::{arrays, errors};
use numpy::{PyUntypedArray, PyUntypedArrayMethods};
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::PyString;

/// Readers for `from_py_with`, each named as its argument.
macro_rules! readers {
    ($($read:ident -> $of:ty: $($name:ident),+;)+) => { $($(
        pub(crate) fn $name(value: &Bound<'_, PyAny>) -> PyResult<$of> {
            $read(stringify!($name), value)
        }
    )+)+ };
}

readers! {
    count -> usize: points, samples, torque_derivatives;
    count -> u64: seed;
    count_or_none -> Option<usize>: lanes, split, steps;
    number -> f64: dt, offset, ratio, restitution, rise, stabilisation, step, threshold;
    number_or_none -> Option<f64>: damping, simplify_to, speed, start, stop;
    triple -> [f64; 3]: rpy, xyz;
    triple_or_none -> Option<[f64; 3]>: at_rpy, at_xyz, gravity, point, slip;
    names -> Vec<String>: keep_symbol;
    names_or_none -> Option<Vec<String>>: directions, passive;
    name_or_names -> Option<Vec<String>>: what;
}

/// A whole number, not negative. What is no number at all is Python's own `TypeError`.
fn count<'py, T: FromPyObjectOwned<'py>>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<T> {
    value.extract::<T>().map_err(Into::into).map_err(|e| match too_large(value, e) {
        Ok(true) => errors::argument(name, "it is negative", "give a whole number, 0 or more"),
        Ok(false) => errors::argument(name, "it is larger than any number of things", "give a smaller number"),
        Err(e) => e,
    })
}

fn count_or_none(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    if value.is_none() { Ok(None) } else { count(name, value).map(Some) }
}

/// A number of any size; an integer beyond all floats is refused here, what is not finite by who knows what it is for.
fn number(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    // Of which NumPy would take the only entry, and say that it should not.
    if value.cast::<PyUntypedArray>().is_ok_and(|array| array.ndim() > 0) {
        return Err(errors::argument(name, "it is an array", "give one number"));
    }
    value.extract::<f64>().map_err(|e| match too_large(value, e) {
        Ok(_) => errors::argument(name, "it is too large for a floating-point number", "give a smaller number"),
        Err(e) => e,
    })
}

fn number_or_none(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<f64>> {
    if value.is_none() { Ok(None) } else { number(name, value).map(Some) }
}

/// Whether a number that is too large for its type is negative; other errors as they are.
fn too_large(value: &Bound<'_, PyAny>, error: PyErr) -> PyResult<bool> {
    if error.is_instance_of::<PyOverflowError>(value.py()) { value.lt(0) } else { Err(error) }
}

fn triple(name: &str, value: &Bound<'_, PyAny>) -> PyResult<[f64; 3]> {
    let mut numbers = [0.0; 3];
    arrays::read(name, value, &mut numbers, "give three numbers")?;
    Ok(numbers)
}

fn triple_or_none(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<[f64; 3]>> {
    if value.is_none() { Ok(None) } else { triple(name, value).map(Some) }
}

/// A list of names. A text, which Python takes for a list of letters, is not one.
fn names(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<String>> {
    let refuse = |problem: String| errors::argument(name, problem, "give a list of names, of one name if there is one");
    if value.is_instance_of::<PyString>() {
        return Err(refuse(format!("the text {} is given", value.repr()?)));
    }
    let not_names = |_: PyErr| refuse("it is no list of names".to_owned());
    value
        .try_iter()
        .map_err(not_names)?
        .map(|item| item?.extract::<String>())
        .collect::<PyResult<_>>()
        .map_err(not_names)
}

fn names_or_none(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<Vec<String>>> {
    if value.is_none() { Ok(None) } else { names(name, value).map(Some) }
}

/// One name or several.
fn name_or_names(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Option<Vec<String>>> {
    match value.cast::<PyString>() {
        Ok(one) => Ok(Some(vec![one.to_string_lossy().into_owned()])),
        Err(_) => names_or_none(name, value),
    }
}
