//! Arrays in: whatever NumPy understands as real numbers, copied once into storage of ours, checked on the way.
//! Arrays out: new ones, checked too.

use crate::errors;
use numpy::ndarray::{Dim, Dimension, IntoDimension};
use numpy::{
    Complex64, PyArray, PyArray1, PyArray2, PyArrayDescrMethods, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::PyString;

pub(crate) type Vector<'py> = Bound<'py, PyArray1<f64>>;
pub(crate) type Matrix<'py> = Bound<'py, PyArray2<f64>>;
pub(crate) type Complexes<'py> = Bound<'py, PyArray1<Complex64>>;

/// Copies a vector argument into `out`.
///
/// # Errors
/// `ShapeError` if it is not a vector of that length, `NotFiniteError` if an entry is not finite, `ArgumentError` if it holds
/// no real numbers.
pub(crate) fn read(name: &str, value: &Bound<'_, PyAny>, out: &mut [f64], meaning: &str) -> PyResult<()> {
    read_fitting(name, value, out, Fit { skip: 0, several: None, meaning })
}

/// Like [`read`], and an array without the leading `skip` entries is welcome too: those become zero.
pub(crate) fn read_without(
    name: &str,
    value: &Bound<'_, PyAny>,
    skip: usize,
    out: &mut [f64],
    meaning: &str,
) -> PyResult<()> {
    read_fitting(name, value, out, Fit { skip, several: None, meaning })
}

/// What a vector argument may be, and how a message says it.
#[derive(Clone, Copy)]
pub(crate) struct Fit<'a> {
    /// Leading entries that may be left out, and become zero then.
    pub(crate) skip: usize,
    /// What the call takes several of, elsewhere: the name of the axis that leads then.
    pub(crate) several: Option<&'a str>,
    /// What its entries are.
    pub(crate) meaning: &'a str,
}

/// Copies a vector argument that fits into `out`.
pub(crate) fn read_fitting(name: &str, value: &Bound<'_, PyAny>, out: &mut [f64], fit: Fit<'_>) -> PyResult<()> {
    let n = out.len();
    let whole = fit.skip == 0 || value.len().is_ok_and(|given| given == n);
    let (head, tail) = out.split_at_mut(if whole { 0 } else { fit.skip });
    head.fill(0.0);
    copy(name, value, tail, |shape| {
        let more = |n: usize| fit.several.map_or(String::new(), |axis| format!(" or ({axis}, {n})"));
        let shapes = |n: usize| format!("({n},){}", more(n));
        let rootless =
            if fit.skip == 0 { String::new() } else { format!(", or without the root {},", shapes(n - fit.skip)) };
        let problem = format!("an array of shape {shape} is given, but {}{rootless} is expected", shapes(n));
        errors::shape(name, problem, fit.meaning)
    })
}

fn copy(name: &str, value: &Bound<'_, PyAny>, out: &mut [f64], misfit: impl Fn(String) -> PyErr) -> PyResult<()> {
    // An array of float64 is read in place, in any memory layout; the rest NumPy converts first.
    match value.cast::<PyArray1<f64>>() {
        Ok(array) => copy_array(array, out, misfit)?,
        Err(_) => copy_array(converted::<1>(name, value, &misfit)?.cast::<PyArray1<f64>>()?, out, misfit)?,
    }
    match out.iter().position(|x| !x.is_finite()) {
        Some(i) => Err(errors::not_finite(name, i.to_string(), out[i])),
        None => Ok(()),
    }
}

fn copy_array(array: &Bound<'_, PyArray1<f64>>, out: &mut [f64], misfit: impl Fn(String) -> PyErr) -> PyResult<()> {
    if array.len() != out.len() {
        return Err(misfit(format!("({},)", array.len())));
    }
    let array = array.try_readonly()?;
    match array.as_slice() {
        Ok(slice) => out.copy_from_slice(slice),
        Err(_) => out.iter_mut().zip(array.as_array()).for_each(|(to, from)| *to = *from),
    }
    Ok(())
}

/// Rows of so many numbers each, one after the other: as many rows as there are.
///
/// # Errors
/// `ShapeError` if it is no matrix of so many columns, `NotFiniteError` if an entry is not finite, `ArgumentError` if it holds no real
/// numbers.
pub(crate) fn read_rows(name: &str, value: &Bound<'_, PyAny>, columns: usize, meaning: &str) -> PyResult<Vec<f64>> {
    let misfit = |shape: String| {
        let problem = format!("an array of shape {shape} is given, but (any number, {columns}) is expected");
        errors::shape(name, problem, meaning)
    };
    let array = converted::<2>(name, value, &misfit)?.cast_into::<PyArray2<f64>>()?;
    if array.shape()[1] != columns {
        return Err(misfit(text_of(array.shape())));
    }
    let numbers: Vec<f64> = array.try_readonly()?.as_array().iter().copied().collect();
    match numbers.iter().position(|x| !x.is_finite()) {
        Some(i) => Err(errors::not_finite(name, format!("[{}, {}]", i / columns, i % columns), numbers[i])),
        None => Ok(numbers),
    }
}

/// A shape as Python writes it.
pub(crate) fn text_of(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        _ => format!("({})", shape.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// Lists, integers, other floats: a new array of float64 with so many axes.
fn converted<'py, const AXES: usize>(
    name: &str,
    value: &Bound<'py, PyAny>,
    misfit: &impl Fn(String) -> PyErr,
) -> PyResult<Bound<'py, PyAny>> {
    let array = numbers(name, value)?;
    if array.ndim() != AXES {
        return Err(misfit(text_of(array.shape())));
    }
    array.call_method1("astype", (numpy::dtype::<f64>(value.py()),))
}

/// An array of real numbers of any kind and shape.
///
/// # Errors
/// `ArgumentError` if it holds something else.
pub(crate) fn numbers<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyUntypedArray>> {
    let py = value.py();
    let not_numbers = |problem: String| errors::argument(name, problem, "give an array of real numbers");
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (value,)).map_err(|e| not_numbers(format!("not an array: {e}")))?;
    let array = array.cast_into::<PyUntypedArray>().map_err(|e| not_numbers(e.to_string()))?;
    let empty = array.len() == 0;
    if !(matches!(array.dtype().kind(), b'f' | b'i' | b'u') || empty) {
        let dtype = array.dtype().str().unwrap_or_else(|_| PyString::new(py, "?"));
        return Err(not_numbers(format!("an array of {dtype} is given")));
    }
    Ok(array)
}

/// A result over the joints.
pub(crate) fn vector<'py>(py: Python<'py>, name: &str, numbers: &[f64]) -> PyResult<Vector<'py>> {
    check_result(name, numbers)?;
    Ok(PyArray1::from_slice(py, numbers))
}

/// A square matrix from its rows, one after the other.
pub(crate) fn matrix<'py>(py: Python<'py>, name: &str, numbers: &[f64], n: usize) -> PyResult<Matrix<'py>> {
    check_result(name, numbers)?;
    PyArray1::from_slice(py, numbers).reshape([n, n])
}

/// A result of any shape, its last axis running fastest.
pub(crate) fn shaped<'py, const D: usize>(
    py: Python<'py>,
    name: &str,
    numbers: &[f64],
    shape: [usize; D],
) -> PyResult<Bound<'py, PyArray<f64, Dim<[usize; D]>>>>
where
    Dim<[usize; D]>: Dimension,
    [usize; D]: IntoDimension<Dim = Dim<[usize; D]>>,
{
    check_result(name, numbers)?;
    PyArray1::from_slice(py, numbers).reshape(shape)
}

/// A result of complex numbers.
pub(crate) fn complexes<'py>(
    py: Python<'py>,
    name: &str,
    numbers: impl Iterator<Item = Complex64>,
) -> PyResult<Complexes<'py>> {
    let numbers: Vec<Complex64> = numbers.collect();
    numbers.iter().try_for_each(|z| check_result(name, &[z.re, z.im]))?;
    Ok(PyArray1::from_vec(py, numbers))
}

/// Nothing that is not a number leaves this house.
pub(crate) fn check_result(name: &str, numbers: &[f64]) -> PyResult<()> {
    if numbers.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(errors::overflow(name)) }
}
