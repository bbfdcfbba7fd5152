//! A linear model and its modes.

use super::{entry, length};
use crate::arrays::{Complexes, check_result, complexes};
use crate::batch::array;
use crate::errors;
use crate::named;
use gyroflex_sim::linearize::{Linearization, Matrices, ModeKind, NaturalMode, natural_modes, zero_order_hold_of};
use numpy::Complex64;
use pyo3::prelude::*;
use pyo3::types::{PyComplex, PyIterator, PyList};
use rayon::prelude::*;

/// A linear model `x' = A x + B u, y = C x + D u` about an operating point, or, sampled, `x[k+1] = A x[k] + B u[k]`.
///
/// Every array is a new one, and yours to change. Of a batch of operating points it is all of their models: arrays lead with the batch,
/// `linear[k]` is one of them, and `len(linear)` says how many there are.
#[pyclass(name = "Linearization", module = "gyroflex", frozen)]
pub(crate) struct PyLinearization {
    models: Vec<(Linearization, Matrices)>,
    batch: bool,
}

impl PyLinearization {
    pub(super) fn new(models: Vec<Linearization>, batch: bool) -> Self {
        let models = models.into_iter().map(|linear| (Matrices::from(&linear), linear));
        Self { models: models.map(|(matrices, linear)| (linear, matrices)).collect(), batch }
    }

    /// One of the models: all have the same states, inputs and outputs.
    fn first(&self) -> Option<&Matrices> {
        self.models.first().map(|(_, matrices)| matrices)
    }

    fn shape(&self, of_one: &[usize]) -> Vec<usize> {
        self.batch.then_some(self.models.len()).into_iter().chain(of_one.iter().copied()).collect()
    }

    fn matrix<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        of: impl Fn(&Matrices) -> &Vec<Vec<f64>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Some(first) = self.first() else { return array::<f64>(py, Vec::new(), &[0, 0, 0]) };
        let columns = if matches!(name, "A" | "C") { &first.states } else { &first.inputs };
        let shape = self.shape(&[of(first).len(), columns.len()]);
        let numbers: Vec<f64> = self.models.iter().flat_map(|(_, m)| of(m).iter().flatten().copied()).collect();
        check_result(name, &numbers)?;
        array(py, numbers, &shape)
    }

    fn vector<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        of: impl Fn(&Matrices) -> &Vec<f64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let shape = self.shape(&[self.first().map_or(0, |m| of(m).len())]);
        let numbers: Vec<f64> = self.models.iter().flat_map(|(_, m)| of(m).iter().copied()).collect();
        check_result(name, &numbers)?;
        array(py, numbers, &shape)
    }
}

#[pymethods]
impl PyLinearization {
    /// `A`, shape `([batch,] states, states)`.
    #[getter(A)]
    fn a<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.matrix(py, "A", |m| &m.a)
    }

    /// `B`, shape `([batch,] states, inputs)`.
    #[getter(B)]
    fn b<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.matrix(py, "B", |m| &m.b)
    }

    /// `C`, shape `([batch,] outputs, states)`.
    #[getter(C)]
    fn c<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.matrix(py, "C", |m| &m.c)
    }

    /// `D`, shape `([batch,] outputs, inputs)`.
    #[getter(D)]
    fn d<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.matrix(py, "D", |m| &m.d)
    }

    /// Names of the states, as `q.joint1`, `theta.joint1`, `qd.joint1`, `thetad.joint1`.
    #[getter]
    fn states(&self) -> Vec<String> {
        self.first().map_or_else(Vec::new, |m| m.states.clone())
    }

    /// Names of the inputs, as `tau.joint1`.
    #[getter]
    fn inputs(&self) -> Vec<String> {
        self.first().map_or_else(Vec::new, |m| m.inputs.clone())
    }

    /// Names of the outputs, as `motor_position.joint1` or `pose.tool.x`.
    #[getter]
    fn outputs(&self) -> Vec<String> {
        self.first().map_or_else(Vec::new, |m| m.outputs.clone())
    }

    /// Joint positions at the operating point, shape `([batch,] nq)` [rad or m].
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.vector(py, "q", |m| &m.q)
    }

    /// Joint velocities there, shape `([batch,] nv)` [rad/s or m/s].
    #[getter]
    fn qd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.vector(py, "qd", |m| &m.qd)
    }

    /// Motor positions there, seen from the link side, shape `([batch,] nv)` [rad or m].
    #[getter]
    fn theta<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.vector(py, "theta", |m| &m.theta)
    }

    /// Motor velocities there, seen from the link side, shape `([batch,] nv)` [rad/s or m/s].
    #[getter]
    fn thetad<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.vector(py, "thetad", |m| &m.thetad)
    }

    /// Motor torques there, seen from the link side, shape `([batch,] nv)` [N m or N]; a floating root leads with the wrench that holds it.
    #[getter]
    fn tau<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.vector(py, "tau", |m| &m.tau)
    }

    /// Sampling time [s]; `None` in continuous time.
    #[getter]
    fn step(&self) -> Option<f64> {
        self.first().and_then(|m| m.step)
    }

    /// Eigenvalues of `A`, shape `([batch,] states)` [1/s; of a sampled model -], by size.
    #[getter]
    fn eigenvalues<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let find = |(linear, _): &(Linearization, Matrices)| linear.eigenvalues();
        let found: Vec<_> =
            py.detach(|| self.models.par_iter().map(find).collect::<Result<_, _>>()).map_err(errors::raise)?;
        let found: Vec<Complex64> = found.concat().iter().map(|z| Complex64::new(z.re, z.im)).collect();
        array(py, found, &self.shape(&[self.first().map_or(0, |m| m.states.len())]))
    }

    /// The model sampled exactly, with inputs held between samples.
    ///
    /// Parameters
    /// ----------
    /// step
    ///     Sampling time [s].
    fn zero_order_hold(&self, py: Python<'_>, #[pyo3(from_py_with = named::step)] step: f64) -> PyResult<Self> {
        if self.step().is_some() {
            return Err(errors::argument(
                "self",
                "the model is sampled already",
                "sample the model in continuous time",
            ));
        }
        let sample = |(linear, _): &(Linearization, Matrices)| zero_order_hold_of(linear, step);
        let sampled = py.detach(|| self.models.par_iter().map(sample).collect::<Result<_, _>>());
        sampled.map(|all| Self::new(all, self.batch)).map_err(super::about("step"))
    }

    /// The modes of a model in continuous time, from the slowest to the fastest; a pair of complex eigenvalues is one mode.
    pub(super) fn modes(&self, py: Python<'_>) -> PyResult<Vec<PyMode>> {
        let (false, [(linear, _)]) = (self.batch, &self.models[..]) else {
            let problem = format!("this is a batch of {}, and each has modes of its own", self.models.len());
            let remedy = "take `[one.modes() for one in linear]`, or `linear.eigenvalues`";
            return Err(errors::argument("self", problem, remedy));
        };
        let modes = py.detach(|| natural_modes(linear)).map_err(errors::raise)?;
        Ok(modes.into_iter().map(PyMode).collect())
    }

    fn __bool__(&self) -> bool {
        true
    }

    fn __len__(&self) -> PyResult<usize> {
        length(self.batch, self.models.len(), "linear model")
    }

    fn __getitem__(&self, index: isize) -> PyResult<Self> {
        let k = entry(self.batch, self.models.len(), "linear model", index)?;
        Ok(Self { models: vec![self.models[k].clone()], batch: false })
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        let each = (0..self.__len__()? as isize).map(|k| self.__getitem__(k));
        PyList::new(py, each.collect::<PyResult<Vec<_>>>()?)?.try_iter()
    }

    fn __repr__(&self) -> String {
        let [states, inputs, outputs] = [self.states(), self.inputs(), self.outputs()].map(|names| names.len());
        let sampled = self.step().map_or(String::new(), |h| format!(", sampled every {h} s"));
        let batch = if self.batch { format!(", batch of {}", self.models.len()) } else { String::new() };
        format!("<Linearization: {states} states, {inputs} inputs, {outputs} outputs{sampled}{batch}>")
    }
}

/// One way a robot moves by itself.
#[pyclass(name = "Mode", module = "gyroflex", frozen)]
pub(crate) struct PyMode(NaturalMode);

#[pymethods]
impl PyMode {
    /// `oscillation`, `decay`, `growth`, or `rigid`: it stays wherever it is put.
    #[getter]
    fn kind(&self) -> &'static str {
        match self.0.kind {
            ModeKind::Oscillation => "oscillation",
            ModeKind::Decay => "decay",
            ModeKind::Growth => "growth",
            ModeKind::Rigid => "rigid",
        }
    }

    /// Size of the eigenvalue over 2π [Hz]: of an oscillation the natural frequency.
    #[getter]
    fn frequency(&self) -> f64 {
        self.0.frequency
    }

    /// Damping ratio [-]; `None` of a rigid motion. Below zero it grows.
    #[getter]
    fn damping_ratio(&self) -> Option<f64> {
        self.0.damping_ratio
    }

    /// The eigenvalue [1/s]; of a pair the one above the real axis.
    #[getter]
    fn eigenvalue<'py>(&self, py: Python<'py>) -> Bound<'py, PyComplex> {
        let [re, im] = self.0.eigenvalue;
        PyComplex::from_doubles(py, re, im)
    }

    /// Name of the position that moves most, as `theta.joint1`.
    #[getter]
    fn moves_most(&self) -> &str {
        &self.0.moves_most
    }

    /// How far each position moves relative to the one that moves most, in the order of the states.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Complexes<'py>> {
        complexes(py, "shape", self.0.shape.iter().map(|[re, im]| Complex64::new(*re, *im)))
    }

    fn __repr__(&self) -> String {
        format!("<Mode: {}, {:.4} Hz, {}>", self.kind(), self.0.frequency, self.0.moves_most)
    }
}
