//! One run of a sweep.

use crate::errors;
use crate::overrides::overrides;
use crate::simulate::SIGNAL_INTERVAL;
use gyroflex_sim::sweep::measure;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

/// Runs a scenario with other values of some keys, with the interpreter released and without a record: numbers of the run by name, as
/// `gyroflex sweep` writes them, NaN where the run has none.
#[pyfunction]
pub(crate) fn measure_scenario<'py>(
    py: Python<'py>,
    scenario: PathBuf,
    set: Option<&Bound<'py, PyMapping>>,
) -> PyResult<Bound<'py, PyDict>> {
    let overrides = overrides(set)?;
    let measured = py.detach(|| {
        let (mut signal, mut looked) = (Ok(()), Instant::now());
        let result = measure(&scenario, &overrides, &mut |_| {
            if looked.elapsed() >= SIGNAL_INTERVAL {
                looked = Instant::now();
                signal = Python::attach(|py| py.check_signals());
            }
            if signal.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        signal?;
        result.map_err(errors::raise)
    })?;
    let row = PyDict::new(py);
    for (name, number) in measured.unwrap_or_default() {
        row.set_item(name, number)?;
    }
    Ok(row)
}
