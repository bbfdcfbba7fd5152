//! A frequency response.

use crate::arrays::{Complexes, Vector, complexes, vector};
use gyroflex_sim::linearize::{Extreme, Response};
use numpy::Complex64;
use pyo3::prelude::*;

/// Response of a joint to its own motor; motor quantities are seen from the link side.
///
/// Every array is a new one, and yours to change.
#[pyclass(name = "FrequencyResponse", module = "gyroflex", frozen)]
pub(crate) struct PyFrequencyResponse(Response);

impl PyFrequencyResponse {
    pub(super) fn new(response: Response) -> Self {
        Self(response)
    }
}

#[pymethods]
impl PyFrequencyResponse {
    /// Name of the joint.
    #[getter]
    fn joint(&self) -> &str {
        &self.0.joint
    }

    /// Frequencies [Hz].
    #[getter]
    fn frequency<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "frequency", &self.0.frequency)
    }

    /// Motor position per motor torque at each frequency [rad/(N m), or m/N].
    #[getter]
    fn motor<'py>(&self, py: Python<'py>) -> PyResult<Complexes<'py>> {
        complexes(py, "motor", self.0.motor.iter().map(|z| Complex64::new(z.re, z.im)))
    }

    /// Link position per motor torque at each frequency [rad/(N m), or m/N].
    #[getter]
    fn link<'py>(&self, py: Python<'py>) -> PyResult<Complexes<'py>> {
        complexes(py, "link", self.0.link.iter().map(|z| Complex64::new(z.re, z.im)))
    }

    /// Frequencies of the peaks of the motor's response [Hz], found to more digits than those of `frequency`.
    #[getter]
    fn resonances<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        frequencies(py, "resonances", &self.0.resonances)
    }

    /// Frequencies of the dips of the motor's response [Hz].
    #[getter]
    fn antiresonances<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        frequencies(py, "antiresonances", &self.0.antiresonances)
    }

    fn __repr__(&self) -> String {
        let Response { joint, frequency, .. } = &self.0;
        let ends = (frequency.first().unwrap_or(&0.0), frequency.last().unwrap_or(&0.0));
        format!("<FrequencyResponse: {joint}, {} frequencies from {:.4} to {:.4} Hz>", frequency.len(), ends.0, ends.1)
    }
}

fn frequencies<'py>(py: Python<'py>, name: &str, of: &[Extreme]) -> PyResult<Vector<'py>> {
    vector(py, name, &of.iter().map(|e| e.frequency).collect::<Vec<_>>())
}
