//! A frequency response.

use super::{entry, length};
use crate::batch::array;
use crate::errors;
use gyroflex_sim::linearize::{Extreme, Response};
use numpy::{Complex64, Element};
use pyo3::prelude::*;
use pyo3::types::{PyIterator, PyList};

/// Response of a joint to its own motor; motor quantities are seen from the link side.
///
/// Every array is a new one, and yours to change. Of a batch of poses it is the responses at all of them: arrays lead with the batch,
/// `response[k]` is one of them, and `len(response)` says how many there are.
#[pyclass(name = "FrequencyResponse", module = "gyroflex", frozen)]
pub(crate) struct PyFrequencyResponse {
    responses: Vec<Response>,
    batch: bool,
}

impl PyFrequencyResponse {
    pub(super) fn new(responses: Vec<Response>, batch: bool) -> Self {
        Self { responses, batch }
    }

    /// A value for every frequency.
    fn over_frequencies<'py, T: Element>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Response) -> Vec<T>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let points = self.responses.first().map_or(0, |r| r.frequency.len());
        let shape: Vec<usize> = self.batch.then_some(self.responses.len()).into_iter().chain([points]).collect();
        array(py, self.responses.iter().flat_map(of).collect(), &shape)
    }

    /// Frequencies of peaks or dips, of which every pose has as many as it has.
    fn frequencies<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        of: impl Fn(&Response) -> &Vec<Extreme>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (false, [one]) = (self.batch, &self.responses[..]) else {
            let problem = format!("this is a batch of {}, and each has {name} of its own", self.responses.len());
            return Err(errors::argument("self", problem, format!("take `[one.{name} for one in response]`")));
        };
        let found: Vec<f64> = of(one).iter().map(|e| e.frequency).collect();
        let n = found.len();
        array(py, found, &[n])
    }
}

#[pymethods]
impl PyFrequencyResponse {
    /// Name of the joint.
    #[getter]
    fn joint(&self) -> &str {
        self.responses.first().map_or("", |r| &r.joint)
    }

    /// Frequencies [Hz], shape `([batch,] points)`.
    #[getter]
    fn frequency<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.over_frequencies(py, |r| r.frequency.clone())
    }

    /// Motor position per motor torque at each frequency [rad/(N m), or m/N], shape `([batch,] points)`.
    #[getter]
    fn motor<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.over_frequencies(py, |r| r.motor.iter().map(|z| Complex64::new(z.re, z.im)).collect())
    }

    /// Link position per motor torque at each frequency [rad/(N m), or m/N], shape `([batch,] points)`.
    #[getter]
    fn link<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.over_frequencies(py, |r| r.link.iter().map(|z| Complex64::new(z.re, z.im)).collect())
    }

    /// Frequencies of the peaks of the motor's response at one pose [Hz], found to more digits than those of `frequency`.
    #[getter]
    fn resonances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.frequencies(py, "resonances", |r| &r.resonances)
    }

    /// Frequencies of the dips of the motor's response at one pose [Hz].
    #[getter]
    fn antiresonances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.frequencies(py, "antiresonances", |r| &r.antiresonances)
    }

    fn __bool__(&self) -> bool {
        true
    }

    fn __len__(&self) -> PyResult<usize> {
        length(self.batch, self.responses.len(), "response")
    }

    fn __getitem__(&self, index: isize) -> PyResult<Self> {
        let k = entry(self.batch, self.responses.len(), "response", index)?;
        Ok(Self { responses: vec![self.responses[k].clone()], batch: false })
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        let each = (0..self.__len__()? as isize).map(|k| self.__getitem__(k));
        PyList::new(py, each.collect::<PyResult<Vec<_>>>()?)?.try_iter()
    }

    fn __repr__(&self) -> String {
        let (false, [one]) = (self.batch, &self.responses[..]) else {
            return format!("<FrequencyResponse: {}, batch of {}>", self.joint(), self.responses.len());
        };
        let frequency = &one.frequency;
        let ends = (frequency.first().unwrap_or(&0.0), frequency.last().unwrap_or(&0.0));
        let n = frequency.len();
        format!("<FrequencyResponse: {}, {n} frequencies from {:.4} to {:.4} Hz>", one.joint, ends.0, ends.1)
    }
}
