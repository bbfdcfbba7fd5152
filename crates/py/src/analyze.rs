//! When do the rotors matter: what `gyroflex analyze` finds, as a dictionary.

use crate::robot::PyRobot;
use crate::simulate::SIGNAL_INTERVAL;
use crate::{errors, named};
use gyroflex_sim::analyze::{Options, of_log, of_scenario, of_workspace};
use gyroflex_sim::load::Disk;
use gyroflex_sim::{Error, ScenarioFile};
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

/// Motions that are kept at once, some hundred bytes each.
const MOST_SAMPLES: usize = 10_000_000;

#[pymethods]
impl PyRobot {
    /// When do the rotors matter? Torque errors of the reduced model beside the complete one, joint by joint.
    ///
    /// Without a scenario or a log, quasi-random motions over the joint limits are analysed.
    ///
    /// Parameters
    /// ----------
    /// scenario
    ///     Simulate this scenario with the complete model and analyse its motion.
    /// log
    ///     Analyse the motion in an MCAP log of a simulation.
    /// samples, seed
    ///     How many motions are drawn from the workspace, and which.
    /// speed
    ///     Top speed of all turning joints [rad/s]; by default each joint's own limit.
    /// rise
    ///     Time in which a joint comes from rest to its top speed [s].
    /// threshold
    ///     How large an error may be [% of the joint's peak torque].
    /// bounds
    ///     Whether to look for bounds of inertia and Coriolis matrix and of gravity torques over the joint limits.
    ///
    /// Returns
    /// -------
    /// dict
    ///     What `gyroflex analyze --json` prints; SI units, angles in radians.
    #[pyo3(signature = (*, scenario=None, log=None, samples=2000, seed=0, speed=None, rise=0.25, threshold=1.0, bounds=false))]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn analyze<'py>(
        &self,
        py: Python<'py>,
        scenario: Option<PathBuf>,
        log: Option<PathBuf>,
        #[pyo3(from_py_with = named::samples)] samples: usize,
        #[pyo3(from_py_with = named::seed)] seed: u64,
        #[pyo3(from_py_with = named::speed)] speed: Option<f64>,
        #[pyo3(from_py_with = named::rise)] rise: f64,
        #[pyo3(from_py_with = named::threshold)] threshold: f64,
        bounds: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        if samples > MOST_SAMPLES {
            let remedy = format!("give at most {MOST_SAMPLES}, which is far more than is needed");
            return Err(errors::argument("samples", format!("{samples} motions are more than fit"), remedy));
        }
        let options = Options { samples, seed, speed, rise, threshold, bounds };
        let mut signal = Ok(());
        let report = py.detach(|| match (&scenario, &log) {
            (Some(_), Some(_)) => Err(errors::argument("log", "there is a scenario too", "give one of the two")),
            (Some(path), None) => {
                let mut looked = Instant::now();
                let mut progress = |_| {
                    if looked.elapsed() >= SIGNAL_INTERVAL {
                        looked = Instant::now();
                        signal = Python::attach(|py| py.check_signals());
                    }
                    if signal.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
                };
                let file = ScenarioFile::load(&Disk, path).map_err(errors::raise)?;
                of_scenario(&self.robot, &file, &options, &mut progress).map_err(about_options)
            }
            (None, Some(path)) => of_log(&self.robot, path, &options).map_err(about_options),
            (None, None) => of_workspace(&self.robot, &options).map_err(about_options),
        });
        signal?;
        let text = report?.to_json().map_err(errors::raise)?;
        py.import("json")?.call_method1("loads", (text,))
    }
}

/// Options that mean nothing are arguments here.
fn about_options(e: Error) -> PyErr {
    match e.element.as_str() {
        option @ ("samples" | "speed" | "rise" | "threshold") => errors::argument(option, e.problem, e.remedy),
        _ => errors::raise(e),
    }
}
