//! A linear model and its modes.

use crate::arrays::{Complexes, Matrix, Vector, complexes, rectangle, vector};
use crate::errors;
use gyroflex_sim::linearize::{Linearization, Matrices, ModeKind, NaturalMode, natural_modes, zero_order_hold_of};
use numpy::Complex64;
use pyo3::prelude::*;
use pyo3::types::PyComplex;

/// A linear model `x' = A x + B u, y = C x + D u` about an operating point, or, sampled, `x[k+1] = A x[k] + B u[k]`.
///
/// Every array is a new one, and yours to change.
#[pyclass(name = "Linearization", module = "gyroflex", frozen)]
pub(crate) struct PyLinearization {
    linear: Linearization,
    matrices: Matrices,
}

impl PyLinearization {
    pub(super) fn new(linear: Linearization) -> Self {
        Self { matrices: Matrices::from(&linear), linear }
    }
}

#[pymethods]
impl PyLinearization {
    /// `A`, shape `(states, states)`.
    #[getter(A)]
    fn a<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        rectangle(py, "A", &self.matrices.a, self.matrices.states.len())
    }

    /// `B`, shape `(states, inputs)`.
    #[getter(B)]
    fn b<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        rectangle(py, "B", &self.matrices.b, self.matrices.inputs.len())
    }

    /// `C`, shape `(outputs, states)`.
    #[getter(C)]
    fn c<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        rectangle(py, "C", &self.matrices.c, self.matrices.states.len())
    }

    /// `D`, shape `(outputs, inputs)`.
    #[getter(D)]
    fn d<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        rectangle(py, "D", &self.matrices.d, self.matrices.inputs.len())
    }

    /// Names of the states, as `q.joint1`, `theta.joint1`, `qd.joint1`, `thetad.joint1`.
    #[getter]
    fn states(&self) -> Vec<String> {
        self.matrices.states.clone()
    }

    /// Names of the inputs, as `tau.joint1`.
    #[getter]
    fn inputs(&self) -> Vec<String> {
        self.matrices.inputs.clone()
    }

    /// Names of the outputs, as `motor_position.joint1` or `pose.tool.x`.
    #[getter]
    fn outputs(&self) -> Vec<String> {
        self.matrices.outputs.clone()
    }

    /// Joint positions at the operating point, shape `(nq,)` [rad or m].
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "q", &self.matrices.q)
    }

    /// Joint velocities there, shape `(nv,)` [rad/s or m/s].
    #[getter]
    fn qd<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "qd", &self.matrices.qd)
    }

    /// Motor positions there, seen from the link side, shape `(nv,)` [rad or m].
    #[getter]
    fn theta<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "theta", &self.matrices.theta)
    }

    /// Motor velocities there, seen from the link side, shape `(nv,)` [rad/s or m/s].
    #[getter]
    fn thetad<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "thetad", &self.matrices.thetad)
    }

    /// Motor torques there, seen from the link side, shape `(nv,)` [N m or N]; a floating root leads with the wrench that holds it.
    #[getter]
    fn tau<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "tau", &self.matrices.tau)
    }

    /// Sampling time [s]; `None` in continuous time.
    #[getter]
    fn step(&self) -> Option<f64> {
        self.matrices.step
    }

    /// The model sampled exactly, with inputs held between samples.
    ///
    /// Parameters
    /// ----------
    /// step
    ///     Sampling time [s].
    fn zero_order_hold(&self, step: f64) -> PyResult<Self> {
        if self.linear.step.is_some() {
            return Err(errors::argument(
                "self",
                "the model is sampled already",
                "sample the model in continuous time",
            ));
        }
        zero_order_hold_of(&self.linear, step).map(Self::new).map_err(super::about("step"))
    }

    /// The modes of a model in continuous time, from the slowest to the fastest; a pair of complex eigenvalues is one mode.
    pub(super) fn modes(&self, py: Python<'_>) -> PyResult<Vec<PyMode>> {
        let modes = py.detach(|| natural_modes(&self.linear)).map_err(errors::raise)?;
        Ok(modes.into_iter().map(PyMode).collect())
    }

    fn __repr__(&self) -> String {
        let Matrices { states, inputs, outputs, step, .. } = &self.matrices;
        let sampled = step.map_or(String::new(), |h| format!(", sampled every {h} s"));
        format!("<Linearization: {} states, {} inputs, {} outputs{sampled}>", states.len(), inputs.len(), outputs.len())
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
