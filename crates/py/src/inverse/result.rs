//! What an inverse finds.

use crate::errors;
use gyroflex_sim::inverse::InverseModel;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods};
use pyo3::prelude::*;

type Array<'py> = Bound<'py, PyArrayDyn<f64>>;

/// What the motors must do for a motion of the links. Arrays have shape `(nv,)`, of a motion over time `(times, nv)`, unless said
/// otherwise, and every one is a new one.
///
/// Without an elastic transmission `theta` and its derivatives are those of the joint, and deflections zero.
#[pyclass(name = "ElasticInverse", module = "gyroflex", frozen)]
pub(crate) struct PyElasticInverse {
    nv: usize,
    /// `None` if it is of one moment.
    times: Option<usize>,
    torque_derivatives: usize,
    /// Time by time, a quantity and its derivatives, `nv` entries each.
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
    fn theta<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.one(py, "theta", &self.theta, 0)
    }

    /// Motor velocities seen from the link side [rad/s or m/s].
    #[getter]
    fn thetad<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.one(py, "thetad", &self.theta, 1)
    }

    /// Motor accelerations seen from the link side [rad/s² or m/s²].
    #[getter]
    fn thetadd<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.one(py, "thetadd", &self.theta, 2)
    }

    /// Torques that the transmissions exert on the joints [N m or N].
    #[getter]
    fn tau_j<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.one(py, "tau_j", &self.tau_j, 0)
    }

    /// Motor torques seen from the link side [N m or N].
    #[getter]
    fn tau<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.one(py, "tau", &self.tau, 0)
    }

    /// Time derivatives of `tau_j` from the first on, shape `(torque_derivatives, nv)` [N m or N, per s, per s², …]; of a motion over
    /// time with the times as the first axis.
    #[getter]
    fn tau_j_derivatives<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.derivatives(py, "tau_j_derivatives", &self.tau_j)
    }

    /// Time derivatives of `tau` from the first on, shaped as those of `tau_j`.
    #[getter]
    fn tau_derivatives<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.derivatives(py, "tau_derivatives", &self.tau)
    }

    /// Deflections of the transmissions after the step [rad or m]: the `deflection` of the next call is the last of them.
    #[getter]
    fn deflection<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.one(py, "deflection", &self.deflection, 0)
    }

    /// Their rates before the step [rad/s or m/s].
    #[getter]
    fn deflection_rate<'py>(&self, py: Python<'py>) -> PyResult<Array<'py>> {
        self.one(py, "deflection_rate", &self.deflection_rate, 0)
    }

    fn __repr__(&self) -> String {
        let times = self.times.map_or(String::new(), |times| format!("{times} times, "));
        format!("<ElasticInverse: {times}{} entries, {} derivatives of the torques>", self.nv, self.torque_derivatives)
    }
}

impl PyElasticInverse {
    /// Nothing yet.
    pub(super) fn new(nv: usize, times: Option<usize>, torque_derivatives: usize) -> Self {
        let [theta, tau_j, tau, deflection, deflection_rate] = [const { Vec::new() }; 5];
        Self { nv, times, torque_derivatives, theta, tau_j, tau, deflection, deflection_rate }
    }

    /// Adds what was found for the next moment.
    pub(super) fn push(&mut self, inverse: &InverseModel) {
        let rows = 1 + self.torque_derivatives;
        (0..3).for_each(|k| self.theta.extend(inverse.theta(k)));
        (0..rows).for_each(|k| self.tau_j.extend(inverse.tau_j(k)));
        (0..rows).for_each(|k| self.tau.extend(inverse.tau(k)));
        self.deflection.extend(inverse.deflection());
        self.deflection_rate.extend(inverse.deflection_rate());
    }

    /// A quantity or one of its derivatives.
    fn one<'py>(&self, py: Python<'py>, name: &str, all: &[f64], order: usize) -> PyResult<Array<'py>> {
        self.part(py, name, all, order..order + 1, &[self.nv])
    }

    fn derivatives<'py>(&self, py: Python<'py>, name: &str, all: &[f64]) -> PyResult<Array<'py>> {
        self.part(py, name, all, 1..1 + self.torque_derivatives, &[self.torque_derivatives, self.nv])
    }

    /// Some orders of every time.
    fn part<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        all: &[f64],
        orders: core::ops::Range<usize>,
        shape: &[usize],
    ) -> PyResult<Array<'py>> {
        let width = all.len() / self.times.unwrap_or(1).max(1);
        let of = orders.start * self.nv..orders.end * self.nv;
        let numbers: Vec<f64> = all.chunks(width.max(1)).flat_map(|row| &row[of.clone()]).copied().collect();
        if let Some(i) = numbers.iter().position(|x| !x.is_finite()) {
            let one = (orders.end - orders.start) * self.nv;
            return Err(errors::overflow(
                &self.times.map_or(name.to_owned(), |_| format!("{name}[{}]", i / one.max(1))),
            ));
        }
        let shape: Vec<usize> = self.times.into_iter().chain(shape.iter().copied()).collect();
        PyArray1::from_vec(py, numbers).reshape(shape)
    }
}
