//! What a call is given: arrays over the joints, of one state or a batch.

use crate::arguments::{Layout, ROOT};
use crate::arrays::{numbers, text_of};
use crate::errors;
use gyroflex_sim::batch::Real;
use gyroflex_sim::eval::unit_quaternion;
use numpy::{
    Element, PyArray1, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;

/// When an array must be given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Need {
    Always,
    /// Where the model has elastic joints.
    Elastic,
    Never,
}

/// An argument that is an array over the joints: its name, its value, and when there must be one.
pub(crate) type Argument<'a, 'py> = (&'static str, Option<&'a Bound<'py, PyAny>>, Need);

/// The arrays of a state under torques.
pub(crate) fn torque_arguments<'a, 'py>(
    [q, qd]: [&'a Bound<'py, PyAny>; 2],
    [theta, thetad, tau, tau_ext]: [Option<&'a Bound<'py, PyAny>>; 4],
) -> [Argument<'a, 'py>; 6] {
    [
        ("q", Some(q), Need::Always),
        ("qd", Some(qd), Need::Always),
        ("theta", theta, Need::Elastic),
        ("thetad", thetad, Need::Elastic),
        ("tau", tau, Need::Always),
        ("tau_ext", tau_ext, Need::Never),
    ]
}

/// The arrays of a motion.
pub(crate) fn motion_arguments<'a, 'py>(
    [q, qd, qdd]: [&'a Bound<'py, PyAny>; 3],
    [theta, thetad, thetadd]: [Option<&'a Bound<'py, PyAny>>; 3],
    tau_ext: Option<&'a Bound<'py, PyAny>>,
) -> [Argument<'a, 'py>; 7] {
    [
        ("q", Some(q), Need::Always),
        ("qd", Some(qd), Need::Always),
        ("qdd", Some(qdd), Need::Always),
        ("theta", theta, Need::Elastic),
        ("thetad", thetad, Need::Elastic),
        ("thetadd", thetadd, Need::Elastic),
        ("tau_ext", tau_ext, Need::Never),
    ]
}

/// A number of NumPy's that lanes compute with.
pub(crate) trait Float: Real + Element {}
impl<F: Real + Element> Float for F {}

/// The arrays of a call that is not about one state in float64.
pub(super) struct Batch<'py> {
    pub(super) arrays: Vec<(&'static str, Bound<'py, PyUntypedArray>)>,
    pub(super) single_precision: bool,
    /// `None` if all are vectors.
    pub(super) rows: Option<usize>,
}

impl<'py> Batch<'py> {
    /// `None` if one state in float64 is given, or what it will be refused for.
    pub(super) fn of(arguments: &[Argument<'_, 'py>]) -> PyResult<Option<Self>> {
        let given = || arguments.iter().filter_map(|(name, value, _)| Some((*name, (*value)?)));
        if given().all(|(_, value)| value.cast::<PyArray1<f64>>().is_ok()) {
            return Ok(None);
        }
        let arrays: Vec<_> = given().map(|(name, value)| Ok((name, numbers(name, value)?))).collect::<PyResult<_>>()?;
        let single_precision = all_single(&arrays);
        let axes = |n: usize| arrays.iter().any(|(_, a)| a.ndim() == n);
        if let Some((name, array)) = arrays.iter().find(|(_, a)| axes(2) && !matches!(a.ndim(), 1 | 2)) {
            let problem = format!("an array of shape {} is given beside batches", text_of(array.shape()));
            return Err(errors::shape(name, problem, "give one row for all, (n,), or one for each state, (batch, n)"));
        }
        if arrays.iter().any(|(_, a)| !matches!(a.ndim(), 1 | 2)) || !(axes(2) || single_precision) {
            return Ok(None);
        }
        let rows = common_rows(&arrays, 2)?;
        Ok(Some(Self { arrays, single_precision, rows }))
    }
}

/// What so many arguments are in one row of a batch.
pub(crate) type Row<'py, const N: usize> = [Option<Bound<'py, PyAny>>; N];

/// The arguments of every row of a batch, one after the other, checked; `None` if no array is a batch.
pub(crate) fn rows<'py, const N: usize>(
    layout: &Layout,
    arguments: [(&'static str, Option<&Bound<'py, PyAny>>); N],
) -> PyResult<Option<Vec<Row<'py, N>>>> {
    let mut arrays = Vec::new();
    for (name, value) in arguments {
        if let Some(value) = value {
            arrays.push((name, numbers(name, value)?));
        }
    }
    let Some(rows) = common_rows(&arrays, 2)? else { return Ok(None) };
    if let Some((name, array)) = arrays.iter().find(|(_, a)| rows == 0 && a.ndim() == 2) {
        let problem = format!("an array of shape {} is given, a batch of nothing", text_of(array.shape()));
        return Err(errors::shape(name, problem, "give one row or more"));
    }
    arrays.iter().try_for_each(|(name, array)| columns::<f64>(layout, name, array, Finite::Now).map(drop))?;
    let of = |name: &str, k: usize| {
        let Some((_, array)) = arrays.iter().find(|(known, _)| *known == name) else { return Ok(None) };
        if array.ndim() == 2 { array.get_item(k).map(Some) } else { Ok(Some(array.clone().into_any())) }
    };
    let row = |k: usize| -> PyResult<Row<'py, N>> {
        let mut all = [const { None }; N];
        for (slot, (name, _)) in all.iter_mut().zip(arguments) {
            *slot = of(name, k)?;
        }
        Ok(all)
    };
    (0..rows).map(row).collect::<PyResult<_>>().map(Some)
}

/// Whether all arrays are float32.
pub(crate) fn all_single(arrays: &[(&'static str, Bound<'_, PyUntypedArray>)]) -> bool {
    arrays.iter().all(|(_, a)| a.dtype().is_equiv_to(&numpy::dtype::<f32>(a.py())))
}

/// The length of the first axis of all arrays of so many axes.
fn common_rows(arrays: &[(&'static str, Bound<'_, PyUntypedArray>)], axes: usize) -> PyResult<Option<usize>> {
    let mut first: Option<(&str, usize)> = None;
    for (name, array) in arrays.iter().filter(|(_, a)| a.ndim() == axes) {
        let rows = array.shape()[0];
        match first {
            None => first = Some((name, rows)),
            Some((other, expected)) if rows != expected => {
                let problem = format!("it has {rows} rows, but `{other}` has {expected}");
                return Err(errors::shape(name, problem, "give arrays of the same batch, or one row for all"));
            }
            Some(_) => {}
        }
    }
    Ok(first.map(|(_, rows)| rows))
}

/// An array of numbers one after the other: the caller's, or a copy that is padded or tidied.
pub(crate) enum Numbers<'py, F: Element> {
    Array(PyReadonlyArrayDyn<'py, F>),
    Own(Vec<F>),
}

impl<F: Element> Numbers<'_, F> {
    pub(crate) fn slice(&self) -> &[F] {
        match self {
            Self::Array(array) => array.as_slice().unwrap_or_default(),
            Self::Own(numbers) => numbers,
        }
    }
}

/// Who looks for entries that are not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Finite {
    Now,
    /// The algorithm that takes the numbers, on all cores.
    ByAlgorithm,
}

/// Reads an array whose last axis runs over the joints; `name` says whether over positions, and whether a root may be left out. Modes of links that
/// bend always may.
pub(crate) fn columns<'py, F: Float>(
    layout: &Layout,
    name: &str,
    array: &Bound<'py, PyUntypedArray>,
    finite: Finite,
) -> PyResult<Numbers<'py, F>> {
    let py = array.py();
    let shape = array.shape();
    let given = shape.last().copied().unwrap_or(0);
    let (positions, rootless) = (name.starts_with('q') && !name.starts_with("qd"), !name.starts_with('q'));
    let n = if positions { layout.nq } else { layout.nv };
    if rootless {
        layout.refuse_two_readings(name, given)?;
    }
    let root = if layout.floating && rootless { ROOT } else { 0 };
    let left_out = [(0, 0), (root, 0), (0, layout.modes), (root, layout.modes)];
    let Some((lead, trail)) = left_out.into_iter().find(|(lead, trail)| lead + given + trail == n) else {
        let axes = layout.several.unwrap_or("batch");
        let problem = format!("an array of shape {} is given, but ({n},) or ({axes}, {n}) is expected", text_of(shape));
        return Err(errors::shape(name, problem, "give one entry per coordinate in the last axis"));
    };
    let tidy = py.import("numpy")?.call_method1("ascontiguousarray", (array, numpy::dtype::<F>(py)))?;
    let array = tidy.cast_into::<PyArrayDyn<F>>()?.try_readonly()?;
    let all = array.as_slice().unwrap_or_default();
    let quaternions = positions && layout.floating;
    let copied = lead + trail > 0 || quaternions;
    let look = copied || finite == Finite::Now;
    if let Some(i) = all.iter().position(|x| look && !x.is_finite()) {
        return Err(errors::not_finite(name, index_of(shape, i), all[i].into()));
    }
    if !copied {
        return Ok(Numbers::Array(array));
    }
    let zeros = vec![F::from_f64(0.0); lead.max(trail)];
    let rows = all.chunks(given.max(1));
    let mut all: Vec<F> =
        rows.flat_map(|row| zeros[..lead].iter().chain(row).chain(&zeros[..trail])).copied().collect();
    if !quaternions {
        return Ok(Numbers::Own(all));
    }
    for (k, row) in all.chunks_mut(n).enumerate() {
        let mut quaternion: [f64; 4] = core::array::from_fn(|i| row[3 + i].into());
        let of_row = if shape.len() > 1 { format!("row {k}: ") } else { String::new() };
        unit_quaternion(&mut quaternion)
            .map_err(|e| errors::argument(name, format!("{of_row}{}", e.problem), e.remedy))?;
        row[3..7].iter_mut().zip(quaternion).for_each(|(to, from)| *to = F::from_f64(from));
    }
    Ok(Numbers::Own(all))
}

/// Where entry `i` of an array of that shape is, as Python says it.
fn index_of(shape: &[usize], i: usize) -> String {
    if shape.len() < 2 {
        return i.to_string();
    }
    let strides = (0..shape.len()).map(|axis| shape[axis + 1..].iter().product::<usize>());
    let index = strides.zip(shape).map(|(stride, n)| (i / stride.max(1) % n.max(&1)).to_string());
    format!("[{}]", index.collect::<Vec<_>>().join(", "))
}

/// Refuses a call that lacks an array.
pub(crate) fn all_given(arguments: &[Argument<'_, '_>], elastic: bool) -> PyResult<()> {
    for (name, value, need) in arguments {
        match need {
            _ if value.is_some() => {}
            Need::Always => return Err(errors::missing_torques(name)),
            Need::Elastic if elastic => return Err(errors::missing_of_elastic(name)),
            _ => {}
        }
    }
    Ok(())
}
