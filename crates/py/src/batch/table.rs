//! Results that are kept until they are asked for by name.

use super::Shape;
use crate::errors;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;

/// Results of one state, or of a batch: their names, their shapes, and the numbers.
#[derive(Debug)]
pub(crate) struct Table(Vec<(Shape, Vec<f64>)>);

impl Table {
    /// Room for results, full of zeros.
    pub(super) fn new(shapes: Vec<Shape>) -> Self {
        let room = |shape: Shape| {
            let numbers = shape.1.iter().product();
            (shape, vec![0.0; numbers])
        };
        Self(shapes.into_iter().map(room).collect())
    }

    pub(super) fn slices(&mut self) -> Vec<&mut [f64]> {
        self.0.iter_mut().map(|(_, numbers)| &mut numbers[..]).collect()
    }

    fn find(&self, name: &str) -> PyResult<&(Shape, Vec<f64>)> {
        self.0.iter().find(|((known, _), _)| *known == name).ok_or_else(|| {
            errors::argument(name, "it is not among the results", "report this: it is an error of the library")
        })
    }

    /// A new array with the result of that name; a number of one state is a number.
    pub(crate) fn get<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let ((_, shape), numbers) = self.find(name)?;
        match (&shape[..], &numbers[..]) {
            ([], [number]) => number.into_bound_py_any(py),
            _ => array(py, numbers.clone(), shape),
        }
    }

    /// The same of a result that counts something.
    pub(crate) fn count<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let ((_, shape), numbers) = self.find(name)?;
        let counts: Vec<i64> = numbers.iter().map(|x| *x as i64).collect();
        match (&shape[..], &counts[..]) {
            ([], [count]) => count.into_bound_py_any(py),
            _ => array(py, counts, shape),
        }
    }
}

/// A new array of any shape, its last axis running fastest.
pub(crate) fn array<'py, T: Element>(py: Python<'py>, numbers: Vec<T>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    Ok(PyArray1::from_vec(py, numbers).reshape(shape)?.into_any())
}
