//! Where results go: new arrays, or those of `out`.

use super::Float;
use crate::arrays::text_of;
use crate::errors;
use numpy::{BorrowError, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyEllipsis, PySequence, PyTuple};

/// A result: its name and the shape it has of one state.
pub(crate) type Shape = (&'static str, Vec<usize>);

/// Nothing that is not a number leaves this house; says which result of which row would.
pub(super) fn all_finite<F: Float>(shapes: &[Shape], results: &[&mut [F]], rows: Option<usize>) -> PyResult<()> {
    shapes.iter().zip(results).try_for_each(|((name, _), numbers)| {
        let Some(i) = numbers.iter().position(|x| !x.is_finite()) else { return Ok(()) };
        Err(errors::overflow(&match rows {
            Some(rows) => format!("{name}[{}]", i / (numbers.len() / rows.max(1)).max(1)),
            None => (*name).to_owned(),
        }))
    })
}

/// One result by itself, several as a tuple.
pub(crate) fn together<'py>(py: Python<'py>, results: Vec<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
    match <[_; 1]>::try_from(results) {
        Ok([one]) => Ok(one),
        Err(all) => Ok(PyTuple::new(py, all)?.into_any()),
    }
}

/// Lends the memory of arrays that do not overlap.
pub(crate) fn write<F: Float>(
    arrays: &[Bound<'_, PyArrayDyn<F>>],
    call: impl FnOnce(&mut [&mut [F]]) -> PyResult<()>,
) -> PyResult<()> {
    let refuse =
        |problem: String| errors::argument("out", problem, "give writable arrays in C order that do not overlap");
    if arrays.iter().any(|array| !array.is_c_contiguous()) {
        return Err(refuse("an array is not in C order, one row after the other".to_owned()));
    }
    let shared = |e: BorrowError| match e {
        BorrowError::AlreadyBorrowed => {
            refuse("it shares memory with an argument, or an array of it with another".into())
        }
        _ => refuse(e.to_string()),
    };
    let mut lent = arrays.iter().map(|a| a.try_readwrite().map_err(shared)).collect::<PyResult<Vec<_>>>()?;
    let mut slices =
        lent.iter_mut().map(|a| a.as_slice_mut().map_err(|e| refuse(e.to_string()))).collect::<PyResult<Vec<_>>>()?;
    call(&mut slices)
}

/// New arrays for results, or the caller's.
pub(crate) fn results<'py, F: Float>(
    py: Python<'py>,
    shapes: &[Shape],
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<Vec<Bound<'py, PyArrayDyn<F>>>> {
    let Some(out) = out else {
        // NumPy's own way to make arrays says so where there is no memory. Every entry is written, or the call fails.
        let empty = py.import("numpy")?.getattr("empty")?;
        let made =
            |shape: &Shape| Ok(empty.call1((PyTuple::new(py, &shape.1)?, numpy::dtype::<F>(py)))?.cast_into()?);
        return shapes.iter().map(made).collect();
    };
    let outs = items(out, shapes.len())?;
    shapes.iter().zip(outs).map(|((name, shape), out)| checked::<F>(name, shape, &out)).collect()
}

/// The arrays of `out`.
fn items<'py>(out: &Bound<'py, PyAny>, n: usize) -> PyResult<Vec<Bound<'py, PyAny>>> {
    if n == 1 {
        return Ok(vec![out.clone()]);
    }
    let refuse =
        || errors::argument("out", format!("it is not a tuple of {n} arrays"), "give one array for each result");
    let items = out.cast::<PySequence>().map_err(|_| refuse())?;
    if items.len()? != n {
        return Err(refuse());
    }
    items.try_iter()?.collect()
}

/// An array that takes a result of that shape.
fn checked<'py, F: Float>(name: &str, shape: &[usize], out: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<F>>> {
    let dtype = numpy::dtype::<F>(out.py());
    let remedy = format!("give `numpy.empty({}, dtype={dtype})`", text_of(shape));
    let array = out
        .cast::<PyArrayDyn<F>>()
        .map_err(|_| errors::argument("out", format!("it is not an array of {dtype} for `{name}`"), remedy.clone()))?;
    if array.shape() != shape {
        let problem = format!("the array for `{name}` has shape {}, not {}", text_of(array.shape()), text_of(shape));
        return Err(errors::shape("out", problem, remedy));
    }
    Ok(array.clone())
}

/// Copies the results of one state into the caller's arrays.
pub(super) fn fill<'py>(
    shapes: &[Shape],
    result: &Bound<'py, PyAny>,
    out: &Bound<'py, PyAny>,
) -> PyResult<Bound<'py, PyAny>> {
    let (outs, results) = (items(out, shapes.len())?, items(result, shapes.len())?);
    let shared = out.py().import("numpy")?.getattr("shares_memory")?;
    for (i, one) in outs.iter().enumerate() {
        for other in &outs[..i] {
            if shared.call1((one, other))?.extract::<bool>()? {
                return Err(errors::argument("out", "its arrays overlap", "give an array of its own for each result"));
            }
        }
    }
    for ((name, shape), out) in shapes.iter().zip(&outs) {
        if !checked::<f64>(name, shape, out)?.getattr("flags")?.getattr("writeable")?.extract::<bool>()? {
            return Err(errors::argument(
                "out",
                format!("the array for `{name}` is read-only"),
                "give a writable array",
            ));
        }
    }
    outs.iter().zip(results).try_for_each(|(out, result)| out.set_item(PyEllipsis::get(out.py()), result))?;
    together(out.py(), outs)
}
