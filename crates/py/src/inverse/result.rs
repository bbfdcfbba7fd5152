//! What an inverse finds.

use crate::arrays::{Matrix, Vector, shaped, vector};
use gyroflex_sim::inverse::InverseModel;
use pyo3::prelude::*;

/// What the motors must do for a motion of the links. Arrays have shape `(nv,)` unless said otherwise, and every one is a new one.
///
/// Without an elastic transmission `theta` and its derivatives are those of the joint, and deflections zero.
#[pyclass(name = "ElasticInverse", module = "gyroflex", frozen)]
pub(crate) struct PyElasticInverse {
    nv: usize,
    /// Rows of `nv` entries: a quantity, then its derivatives.
    theta: Vec<f64>,
    tau_j: Vec<f64>,
    tau: Vec<f64>,
    deflection: Vec<f64>,
    deflection_rate: Vec<f64>,
}

#[pymethods]
impl PyElasticInverse {
    /// Motor positions seen from the link side [rad or m].
    #[getter]
    fn theta<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "theta", &self.theta[..self.nv])
    }

    /// Motor velocities seen from the link side [rad/s or m/s].
    #[getter]
    fn thetad<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "thetad", &self.theta[self.nv..2 * self.nv])
    }

    /// Motor accelerations seen from the link side [rad/s² or m/s²].
    #[getter]
    fn thetadd<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "thetadd", &self.theta[2 * self.nv..3 * self.nv])
    }

    /// Torques that the transmissions exert on the joints [N m or N].
    #[getter]
    fn tau_j<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "tau_j", &self.tau_j[..self.nv])
    }

    /// Motor torques seen from the link side [N m or N].
    #[getter]
    fn tau<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "tau", &self.tau[..self.nv])
    }

    /// Time derivatives of `tau_j` from the first on, shape `(torque_derivatives, nv)` [N m or N, per s, per s², …].
    #[getter]
    fn tau_j_derivatives<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        self.derivatives(py, "tau_j_derivatives", &self.tau_j)
    }

    /// Time derivatives of `tau` from the first on, shape `(torque_derivatives, nv)` [N m or N, per s, per s², …].
    #[getter]
    fn tau_derivatives<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        self.derivatives(py, "tau_derivatives", &self.tau)
    }

    /// Deflections of the transmissions after the step [rad or m]: the `deflection` of the next call.
    #[getter]
    fn deflection<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "deflection", &self.deflection)
    }

    /// Their rates before the step [rad/s or m/s].
    #[getter]
    fn deflection_rate<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "deflection_rate", &self.deflection_rate)
    }

    fn __repr__(&self) -> String {
        let derivatives = self.tau.len() / self.nv.max(1) - 1;
        format!("<ElasticInverse: {} entries, {derivatives} derivatives of the torques>", self.nv)
    }
}

impl PyElasticInverse {
    pub(super) fn of(inverse: &InverseModel, torque_derivatives: usize) -> Self {
        let rows = |row: for<'a> fn(&'a InverseModel, usize) -> &'a [f64], count: usize| {
            (0..count).flat_map(|k| row(inverse, k)).copied().collect()
        };
        Self {
            nv: inverse.deflection().len(),
            theta: rows(InverseModel::theta, 3),
            tau_j: rows(InverseModel::tau_j, 1 + torque_derivatives),
            tau: rows(InverseModel::tau, 1 + torque_derivatives),
            deflection: inverse.deflection().to_vec(),
            deflection_rate: inverse.deflection_rate().to_vec(),
        }
    }

    fn derivatives<'py>(&self, py: Python<'py>, name: &str, rows: &[f64]) -> PyResult<Matrix<'py>> {
        shaped(py, name, &rows[self.nv..], [rows.len() / self.nv.max(1) - 1, self.nv])
    }
}
