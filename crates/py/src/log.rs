//! Logs: written of a run that is over, and read back.

use crate::errors;
use crate::simulate::{all_told, by_name};
use gyroflex_sim::record::{McapRecorder, MemoryRecorder, Recorder, read_states};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyTuple};
use std::path::PathBuf;

/// All that a run recorded, poses of the links and files included: what a log is written of.
#[pyclass(name = "Record", module = "gyroflex._gyroflex", frozen)]
pub(crate) struct PyRecord(pub(crate) MemoryRecorder);

#[pymethods]
impl PyRecord {
    /// Writes the MCAP log that the run would have written.
    fn write_mcap(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| {
            let run = &self.0;
            let mut log = McapRecorder::create(&path, run.info().clone())?;
            let mut impacts = run.impacts().iter().peekable();
            for sample in run.samples() {
                // The recorder took it as one that happened since the last sample.
                while let Some(impact) = impacts.next_if(|impact| impact.t <= sample.t) {
                    log.impact(impact)?;
                }
                log.record(sample)?;
            }
            impacts.try_for_each(|impact| log.impact(impact))?;
            log.finish()
        })
        .map_err(errors::raise)
    }
}

/// What a log holds, as `run_scenario` returns it: arrays, units and columns by name; names of the joints, metadata, impacts,
/// and whether the log was finished.
#[pyfunction]
pub(crate) fn read_log(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyTuple>> {
    let log = py.detach(|| read_states(&path)).map_err(errors::raise)?;
    let columns = || log.table.columns.iter().map(|c| c.name.as_str());
    let joints: Vec<&str> = columns().filter_map(|c| c.strip_prefix("q.")).collect();
    let contact = |column: &str| Some(column.strip_prefix("contact.")?.strip_suffix(".gap")?.to_owned());
    let contacts: Vec<String> = columns().filter_map(contact).collect();
    let named = by_name(py, &log.table)?;
    let impacts = all_told(py, &log.impacts, &contacts)?;
    (named, PyTuple::new(py, joints)?, log.metadata.into_py_dict(py)?, impacts, log.complete).into_pyobject(py)
}
