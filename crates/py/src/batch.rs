//! Calls over batches: arrays of shape `(batch, n)` in lanes and on all cores, with the interpreter released.

use crate::arguments::{Layout, ROOT};
use crate::arrays::{numbers, text_of};
use crate::errors;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use gyroflex_sim::Dynamics;
use gyroflex_sim::batch::{self, Algorithm, Given, Real};
use gyroflex_sim::eval::unit_quaternion;
use numpy::{
    Element, PyArray1, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArray,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use pyo3::types::{PyEllipsis, PySequence, PyTuple};
use rayon::prelude::*;

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

/// A number of NumPy's that lanes compute with.
pub(crate) trait Float: Real + Element + Into<f64> {}
impl<F: Real + Element + Into<f64>> Float for F {}

/// The arrays of a call that is not about one state in float64.
struct Batch<'py> {
    arrays: Vec<(&'static str, Bound<'py, PyUntypedArray>)>,
    single_precision: bool,
    /// `None` if all are vectors.
    rows: Option<usize>,
}

impl<'py> Batch<'py> {
    /// `None` if one state in float64 is given, or what it will be refused for.
    fn of(arguments: &[Argument<'_, 'py>]) -> PyResult<Option<Self>> {
        let given = || arguments.iter().filter_map(|(name, value, _)| Some((*name, (*value)?)));
        if given().all(|(_, value)| value.cast::<PyArray1<f64>>().is_ok()) {
            return Ok(None);
        }
        let arrays: Vec<_> = given().map(|(name, value)| Ok((name, numbers(name, value)?))).collect::<PyResult<_>>()?;
        let single_precision = all_single(&arrays);
        let axes = |n: usize| arrays.iter().any(|(_, a)| a.ndim() == n);
        if arrays.iter().any(|(_, a)| !matches!(a.ndim(), 1 | 2)) || !(axes(2) || single_precision) {
            return Ok(None);
        }
        let rows = common_rows(&arrays, 2)?;
        Ok(Some(Self { arrays, single_precision, rows }))
    }
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

/// Reads an array whose last axis runs over the joints; `name` says whether over positions, and whether a root may be left out.
pub(crate) fn columns<'py, F: Float>(
    layout: &Layout,
    name: &str,
    array: &Bound<'py, PyUntypedArray>,
) -> PyResult<Numbers<'py, F>> {
    let py = array.py();
    let shape = array.shape();
    let given = shape.last().copied().unwrap_or(0);
    let (positions, rootless) = (name.starts_with('q') && !name.starts_with("qd"), !name.starts_with('q'));
    let n = if positions { layout.nq } else { layout.nv };
    let padded = layout.floating && rootless && given + ROOT == n;
    if given != n && !padded {
        let problem = format!("an array of shape {} is given, but ({n},) or (batch, {n}) is expected", text_of(shape));
        return Err(errors::shape(name, problem, "give one entry per coordinate in the last axis"));
    }
    let tidy = py.import("numpy")?.call_method1("ascontiguousarray", (array, numpy::dtype::<F>(py)))?;
    let array = tidy.cast_into::<PyArrayDyn<F>>()?.try_readonly()?;
    let all = array.as_slice().unwrap_or_default();
    if let Some(i) = all.iter().position(|x| !x.is_finite()) {
        let index = if shape.len() > 1 { format!("[{}, {}]", i / given, i % given) } else { i.to_string() };
        return Err(errors::not_finite(name, index, all[i].into()));
    }
    if padded {
        let root = [F::from_f64(0.0); ROOT];
        return Ok(Numbers::Own(all.chunks(given.max(1)).flat_map(|row| root.iter().chain(row)).copied().collect()));
    }
    if !(positions && layout.floating) {
        return Ok(Numbers::Array(array));
    }
    let mut all = all.to_vec();
    for row in all.chunks_mut(n) {
        let mut quaternion: [f64; 4] = core::array::from_fn(|i| row[3 + i].into());
        unit_quaternion(&mut quaternion).map_err(|e| errors::argument(name, e.problem, e.remedy))?;
        row[3..7].iter_mut().zip(quaternion).for_each(|(to, from)| *to = F::from_f64(from));
    }
    Ok(Numbers::Own(all))
}

/// Refuses a call that lacks an array.
pub(crate) fn all_given(arguments: &[Argument<'_, '_>], elastic: bool) -> PyResult<()> {
    for (name, value, need) in arguments {
        let problem = match need {
            Need::Always => "it is missing",
            Need::Elastic if elastic => "it is missing, but the robot has elastic joints in this model",
            _ => continue,
        };
        if value.is_none() {
            return Err(errors::argument(name, problem, "give one entry per joint, zeros for none"));
        }
    }
    Ok(())
}

/// A result: its name and the shape it has of one state.
pub(crate) type Shape = (&'static str, Vec<usize>);

/// The results of an algorithm that Python sees, the first ones of what it computes.
fn shapes(algorithm: Algorithm, nv: usize) -> Vec<Shape> {
    let each = |names: &[&'static str], shape: &[usize]| names.iter().map(|name| (*name, shape.to_vec())).collect();
    match algorithm {
        Algorithm::ForwardDynamics => each(&["qdd", "thetadd"], &[nv]),
        Algorithm::InverseDynamics => each(&["tau_j", "tau"], &[nv]),
        Algorithm::MassMatrix => each(&["mass matrix"], &[nv, nv]),
        Algorithm::CouplingMatrix => each(&["coupling matrix"], &[nv, nv]),
        Algorithm::CoriolisMatrices => each(&["C", "C1", "C2"], &[nv, nv]),
        Algorithm::InertiaRates => each(&["dM", "dS"], &[nv, nv]),
        Algorithm::Bias => each(&["link", "motor"], &[nv]),
        Algorithm::GravityTorques => each(&["gravity torques"], &[nv]),
        Algorithm::Energy => each(&["kinetic", "gravity", "elastic"], &[]),
        Algorithm::Placement(..) => each(&["placement"], &[4, 4]),
        Algorithm::Jacobian(..) => each(&["jacobian"], &[6, nv]),
    }
}

impl PyRobot {
    /// Runs an algorithm over what is given: one state in float64 as `single` does it, all else in lanes. `out` takes the results
    /// if there is one.
    pub(crate) fn evaluate<'py>(
        &self,
        py: Python<'py>,
        algorithm: Algorithm,
        model: Option<&str>,
        arguments: &[Argument<'_, 'py>],
        out: Option<&Bound<'py, PyAny>>,
        single: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        // Links that bend have no lanes: one state of them is computed in float64, whatever it is given in.
        let batch = Batch::of(arguments)?.filter(|batch| batch.rows.is_some() || self.layout.modes == 0);
        match (batch, out) {
            (None, None) => single(),
            (None, Some(out)) => fill(&shapes(algorithm, self.layout.nv), &single()?, out),
            (Some(batch), out) if batch.single_precision => {
                self.in_lanes::<f32>(py, algorithm, model, arguments, &batch, out)
            }
            (Some(batch), out) => self.in_lanes::<f64>(py, algorithm, model, arguments, &batch, out),
        }
    }

    fn in_lanes<'py, F: Float>(
        &self,
        py: Python<'py>,
        algorithm: Algorithm,
        model: Option<&str>,
        arguments: &[Argument<'_, 'py>],
        batch: &Batch<'py>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given: Vec<(&str, Numbers<'py, F>)> = batch
            .arrays
            .iter()
            .map(|(name, array)| Ok((*name, columns(&self.layout, name, array)?)))
            .collect::<PyResult<_>>()?;
        let of = |name: &str| given.iter().find(|(n, _)| *n == name).map_or(&[][..], |(_, numbers)| numbers.slice());
        let states = Given {
            q: of("q"),
            qd: of("qd"),
            theta: of("theta"),
            thetad: of("thetad"),
            qdd: of("qdd"),
            thetadd: of("thetadd"),
            tau: of("tau"),
            tau_ext: of("tau_ext"),
        };
        let shapes: Vec<Shape> = shapes(algorithm, self.layout.nv)
            .into_iter()
            .map(|(name, shape)| (name, batch.rows.into_iter().chain(shape).collect()))
            .collect();
        let rows = batch.rows.unwrap_or(1);
        let results = results::<F>(py, &shapes, out)?;
        self.with(model, |w| {
            all_given(arguments, w.elastic)?;
            write(&results, |slices| {
                let model = w.dynamics.owned_model();
                py.detach(|| batch::evaluate(model, algorithm, rows, states, slices)).map_err(errors::raise)?;
                all_finite(&shapes, slices, batch.rows)
            })
        })?;
        together(py, results.into_iter().map(Bound::into_any).collect())
    }

    /// Runs what has no lanes over what is given: one state as `read` finds it in the workspace, or a batch row by row in float64
    /// on all cores. `shapes` are those of the results of one state.
    #[expect(clippy::too_many_arguments, reason = "they are the call, what it takes and what it gives")]
    pub(crate) fn by_rows<'py>(
        &self,
        py: Python<'py>,
        model: Option<&str>,
        arguments: &[Argument<'_, 'py>],
        shapes: &[Shape],
        out: Option<&Bound<'py, PyAny>>,
        read: impl FnOnce(&mut Workspace) -> PyResult<()>,
        one: impl Fn(&mut Dynamics, Given<f64>, &mut [&mut [f64]]) -> Result<(), gyroflex_sim::Error> + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let batch = Batch::of(arguments)?.filter(|batch| batch.rows.is_some());
        let rows = batch.as_ref().and_then(|batch| batch.rows);
        let shapes: Vec<Shape> = shapes
            .iter()
            .map(|(name, shape)| (*name, rows.into_iter().chain(shape.iter().copied()).collect()))
            .collect();
        let results = results::<f64>(py, &shapes, out)?;
        self.with(model, |w| {
            let Some(batch) = batch else {
                read(w)?;
                return write(&results, |slices| {
                    let Workspace { dynamics, q, qd, theta, thetad, qdd, thetadd, tau, tau_ext, .. } = w;
                    one(dynamics, Given { q, qd, theta, thetad, qdd, thetadd, tau, tau_ext }, slices)
                        .map_err(errors::raise)?;
                    all_finite(&shapes, slices, None)
                });
            };
            all_given(arguments, w.elastic)?;
            let given: Vec<(&str, Numbers<'py, f64>)> = batch
                .arrays
                .iter()
                .map(|(name, array)| Ok((*name, columns(&self.layout, name, array)?)))
                .collect::<PyResult<_>>()?;
            let arrays: Vec<(&str, &[f64])> = given.iter().map(|(name, numbers)| (*name, numbers.slice())).collect();
            let zeros = vec![0.0; self.layout.nv];
            let row = |k: usize| {
                let of = |name: &str, width: usize| match arrays.iter().find(|(n, _)| *n == name) {
                    None => &zeros[..],
                    Some((_, all)) if all.len() == width => all,
                    Some((_, all)) => &all[k * width..][..width],
                };
                let vector = |name: &str| of(name, self.layout.nv);
                Given {
                    q: of("q", self.layout.nq),
                    qd: vector("qd"),
                    theta: vector("theta"),
                    thetad: vector("thetad"),
                    qdd: vector("qdd"),
                    thetadd: vector("thetadd"),
                    tau: vector("tau"),
                    tau_ext: vector("tau_ext"),
                }
            };
            write(&results, |slices| {
                let count = rows.unwrap_or(1);
                let mut tasks: Vec<Vec<&mut [f64]>> = (0..count).map(|_| Vec::new()).collect();
                for slice in slices.iter_mut() {
                    let width = slice.len() / count.max(1);
                    tasks.iter_mut().zip(slice.chunks_mut(width.max(1))).for_each(|(task, row)| task.push(row));
                }
                let dynamics = &w.dynamics;
                let run =
                    |dynamics: &mut Dynamics, (k, mut out): (usize, Vec<&mut [f64]>)| one(dynamics, row(k), &mut out);
                py.detach(|| tasks.into_par_iter().enumerate().try_for_each_init(|| dynamics.clone(), run))
                    .map_err(errors::raise)?;
                all_finite(&shapes, slices, rows)
            })
        })?;
        together(py, results.into_iter().map(Bound::into_any).collect())
    }
}

/// Nothing that is not a number leaves this house; says which result of which row would.
fn all_finite<F: Float>(shapes: &[Shape], results: &[&mut [F]], rows: Option<usize>) -> PyResult<()> {
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
    let mut lent =
        arrays.iter().map(|a| a.try_readwrite().map_err(|e| refuse(e.to_string()))).collect::<PyResult<Vec<_>>>()?;
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
        // NumPy's own way to make arrays says so where there is no memory.
        let zeros = py.import("numpy")?.getattr("zeros")?;
        let made =
            |shape: &Shape| Ok(zeros.call1((PyTuple::new(py, &shape.1)?, numpy::dtype::<F>(py)))?.cast_into()?);
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
fn fill<'py>(shapes: &[Shape], result: &Bound<'py, PyAny>, out: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
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
