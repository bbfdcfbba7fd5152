//! Simulations, and their record as arrays by name.

use crate::errors;
use crate::log::PyRecord;
use crate::overrides::overrides;
use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::load::{Disk, LoadOptions, Overrides};
use gyroflex_sim::record::{Impact, McapRecorder, MemoryRecorder, Struck, Table, TeeRecorder};
use gyroflex_sim::scenario::ScenarioFile;
use gyroflex_sim::simulate::Simulation;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyMapping, PyTuple};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How often a running simulation looks whether the user pressed Ctrl-C.
pub(crate) const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// A run and how it ended.
struct Run {
    memory: MemoryRecorder,
    warnings: Vec<String>,
    /// Why the run ended early, if it diverged.
    diverged: Option<Error>,
}

/// Runs a scenario with the interpreter released; `gyroflex.simulation` makes a `SimulationResult` of what it returns:
/// arrays, units and columns by name; names of the joints, metadata, warnings, impacts, the record to write a log of, and the error
/// of a run that diverged.
#[pyfunction]
pub(crate) fn run_scenario<'py>(
    py: Python<'py>,
    scenario: PathBuf,
    log: Option<PathBuf>,
    set: Option<&Bound<'py, PyMapping>>,
) -> PyResult<Bound<'py, PyTuple>> {
    let overrides = overrides(set)?;
    let run = py.detach(|| run(&scenario, log.as_deref(), &overrides))?;
    let info = run.memory.info();
    let metadata = info.metadata.clone().into_py_dict(py)?;
    let named = by_name(py, &run.memory.table())?;
    let joints = PyTuple::new(py, &info.joints)?;
    let error = run.diverged.map(|e| errors::raise(e).into_value(py));
    let impacts = all_told(py, run.memory.impacts(), &info.contacts)?;
    let record = PyRecord(run.memory);
    (named, joints, metadata, run.warnings, impacts, record, error).into_pyobject(py)
}

pub(crate) fn all_told<'py>(py: Python<'py>, impacts: &[Impact], contacts: &[String]) -> PyResult<Bound<'py, PyTuple>> {
    let impacts = impacts.iter().map(|impact| told(py, impact, contacts));
    PyTuple::new(py, impacts.collect::<PyResult<Vec<_>>>()?)
}

/// An impact: time, energy lost, names of the contacts, and of each its impulse and its velocities before and after.
fn told<'py>(py: Python<'py>, impact: &Impact, contacts: &[String]) -> PyResult<Bound<'py, PyTuple>> {
    let names = PyTuple::new(py, impact.struck.iter().map(|s| contacts[s.contact].as_str()))?;
    let rows = |of: fn(&Struck) -> [f64; 3]| {
        let numbers: Vec<f64> = impact.struck.iter().flat_map(of).collect();
        PyArray1::from_vec(py, numbers).reshape([impact.struck.len(), 3])
    };
    let (impulse, before, after) = (rows(|s| s.impulse)?, rows(|s| s.before)?, rows(|s| s.after)?);
    (impact.t, impact.energy_lost, names, impulse, before, after).into_pyobject(py)
}

fn run(scenario: &Path, log: Option<&Path>, overrides: &Overrides) -> PyResult<Run> {
    let file = ScenarioFile::load_with(&Disk, scenario, overrides).map_err(errors::raise)?;
    let robot = file.load_robot(&Disk, &LoadOptions::default()).map_err(errors::raise)?;
    let mut simulation = Simulation::new(&robot, &file).map_err(errors::raise)?;
    let info = simulation.run_info();
    let mut memory = MemoryRecorder::new(info.clone());
    let mut recorder = TeeRecorder::new().with(&mut memory);
    if let Some(path) = log {
        recorder = recorder.with(McapRecorder::create(path, info).map_err(errors::raise)?);
    }

    let mut signal = Ok(());
    let mut looked = Instant::now();
    let mut progress = |_| {
        if looked.elapsed() >= SIGNAL_INTERVAL {
            looked = Instant::now();
            signal = Python::attach(|py| py.check_signals());
        }
        if signal.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let ended = simulation.run(&mut recorder, &mut progress);
    drop(recorder);
    signal?;
    let diverged = match ended {
        Ok(_) => None,
        Err(e) if e.kind == ErrorKind::Diverged => Some(e),
        Err(e) => return Err(errors::raise(e)),
    };
    let warnings = robot.warnings.iter().chain(simulation.warnings()).map(ToString::to_string).collect();
    Ok(Run { memory, warnings, diverged })
}

/// Columns `q.joint1`, `q.joint2`, … as one array `q` of a row per sample, those of a contact's force as `contact.name.force`; all others as vectors.
/// Poses of the links, which follow from `q`, stay in the log. Returns arrays, and of their columns the units and names.
pub(crate) fn by_name<'py>(py: Python<'py>, table: &Table) -> PyResult<[Bound<'py, PyDict>; 3]> {
    let [arrays, units, names] = [(); 3].map(|()| PyDict::new(py));
    let quantity = |i: usize| array_of(&table.columns[i].name);
    let mut first = 0;
    while first < table.columns.len() {
        let mut end = first + 1;
        let Some(name) = quantity(first) else {
            let column = &table.columns[first];
            arrays.set_item(&column.name, PyArray1::from_slice(py, &table.values[first]))?;
            units.set_item(&column.name, (column.unit,))?;
            names.set_item(&column.name, (&column.name,))?;
            first = end;
            continue;
        };
        while end < table.columns.len() && quantity(end).as_ref() == Some(&name) {
            end += 1;
        }
        if name != "frame" {
            let columns = &table.values[first..end];
            let rows: Vec<f64> = (0..table.len()).flat_map(|k| columns.iter().map(move |c| c[k])).collect();
            arrays.set_item(&name, PyArray1::from_vec(py, rows).reshape([table.len(), end - first])?)?;
            units.set_item(&name, PyTuple::new(py, table.columns[first..end].iter().map(|c| c.unit))?)?;
            names.set_item(&name, PyTuple::new(py, table.columns[first..end].iter().map(|c| &c.name))?)?;
        }
        first = end;
    }
    Ok([arrays, units, names])
}

/// The array that a column is a part of; `None` if it is a vector of its own.
fn array_of(column: &str) -> Option<String> {
    let Some(contact) = column.strip_prefix("contact.") else {
        return column.split_once('.').map(|(quantity, _)| quantity.to_owned());
    };
    // A name may have dots, the quantity has none.
    match contact.rsplit_once('.') {
        Some((name, "fx" | "fy" | "fz")) => Some(format!("contact.{name}.force")),
        _ => None,
    }
}
