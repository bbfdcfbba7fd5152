//! Motions of many copies of a robot at once.

use crate::arguments::{Layout, choice};
use crate::arrays::{numbers, text_of};
use crate::batch::{self, Finite, Float, Need, Numbers, all_given, all_single, columns};
use crate::errors;
use crate::named;
use crate::robot::PyRobot;
use gyroflex_sim::batch::{Rollout, Scheme, Trajectories, rollout};
use numpy::{PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;

/// What is given of a rollout, beside the torques.
type Start<'py> = Vec<(&'static str, Bound<'py, PyUntypedArray>)>;

/// How often the state is advanced, and how.
#[derive(Clone, Copy)]
struct Steps {
    dt: f64,
    steps: usize,
    scheme: Scheme,
}

#[pymethods]
impl PyRobot {
    /// Simulates many motions at once with fixed steps, each from its own state and under its own torques, in lanes and on all
    /// cores.
    ///
    /// Any of the arrays may do without the batch: it is the same for all motions then. In float32 if all of them are.
    ///
    /// Parameters
    /// ----------
    /// q0, qd0
    ///     Joint positions at the start, shape `(nq,)` or `(batch, nq)`, and velocities, shape `(nv,)` or `(batch, nv)`
    ///     [rad or m, per s].
    /// tau
    ///     Motor torques seen from the link side [N m or N], held over each step: shape `(nv,)` for the same all the time, which asks
    ///     for `steps`, `(steps, nv)`, or `(batch, steps, nv)`.
    /// dt
    ///     Time step [s].
    /// theta0, thetad0
    ///     Motor positions and velocities at the start, seen from the link side. Needed if the model has elastic joints.
    /// steps
    ///     Number of steps; by default as many as `tau` has.
    /// integrator
    ///     `semi_implicit_euler`, of first order, or `rk4`, of fourth.
    /// model
    ///     Which physics of the motors.
    ///
    /// Returns
    /// -------
    /// (q, qd, theta, thetad)
    ///     The states at all times, the start included, shape `(batch, steps + 1, n)`, or `(steps + 1, n)` where nothing is a batch. A
    ///     motion that diverges is not finite from there on, and leaves the others alone.
    #[pyo3(signature = (q0, qd0, tau, dt, *, theta0=None, thetad0=None, steps=None, integrator="semi_implicit_euler", model=None))]
    #[expect(clippy::too_many_arguments, reason = "they are the start, the torques and the steps")]
    fn rollout<'py>(
        &self,
        py: Python<'py>,
        q0: &Bound<'py, PyAny>,
        qd0: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = named::dt)] dt: f64,
        theta0: Option<&Bound<'py, PyAny>>,
        thetad0: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = named::steps)] steps: Option<usize>,
        integrator: &str,
        model: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if !(dt.is_finite() && dt > 0.0) {
            return Err(errors::argument("dt", format!("{dt} is no time step"), "give a positive number of seconds"));
        }
        let schemes = [("semi_implicit_euler", Scheme::SemiImplicitEuler), ("rk4", Scheme::Rk4)];
        let scheme = choice("integrator", integrator, &schemes)?;
        let tau = numbers("tau", tau)?;
        let in_tau = if tau.ndim() > 1 { Some(tau.shape()[tau.ndim() - 2]) } else { None };
        let steps = match (in_tau, steps) {
            (Some(n), None) => n,
            (Some(n), Some(steps)) if n == steps || n == 1 => steps,
            (None, Some(steps)) => steps,
            (None, None) => {
                return Err(errors::argument("steps", "it is missing", "give it, or torques of shape (steps, nv)"));
            }
            (Some(n), Some(steps)) => {
                let problem = format!("it has {n} steps, but {steps} are asked for");
                return Err(errors::shape("tau", problem, "leave `steps` out, or give torques of as many steps"));
            }
        };
        if steps > isize::MAX as usize / 1024 {
            return Err(errors::argument(
                "steps",
                format!("{steps} states are more than fit"),
                "give a smaller number",
            ));
        }
        let start = [
            ("q0", Some(q0), Need::Always),
            ("qd0", Some(qd0), Need::Always),
            ("theta0", theta0, Need::Elastic),
            ("thetad0", thetad0, Need::Elastic),
        ];
        let arrays: Start<'py> = start
            .iter()
            .filter_map(|(name, value, _)| Some((*name, (*value)?)))
            .map(|(name, value)| Ok((name, numbers(name, value)?)))
            .chain([Ok(("tau", tau))])
            .collect::<PyResult<_>>()?;
        self.with(model, |w| all_given(&start, w.elastic))?;
        let how = Steps { dt, steps, scheme };
        if all_single(&arrays) {
            self.roll::<f32>(py, &arrays, how, model)
        } else {
            self.roll::<f64>(py, &arrays, how, model)
        }
    }
}

impl PyRobot {
    fn roll<'py, F: Float>(
        &self,
        py: Python<'py>,
        arrays: &Start<'py>,
        Steps { dt, steps, scheme }: Steps,
        model: Option<&str>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rows = batch_of(arrays)?;
        let given: Vec<(&str, Numbers<'py, F>)> = arrays
            .iter()
            .map(|(name, array)| {
                let several = (*name == "tau").then_some("[batch,] steps");
                Ok((*name, columns(&Layout { several, ..self.layout }, name, array, Finite::Now)?))
            })
            .collect::<PyResult<_>>()?;
        let (nq, nv, n) = (self.layout.nq, self.layout.nv, rows.unwrap_or(1));
        let still = vec![F::from_f64(0.0); nv];
        let of = |name: &str| given.iter().find(|(n, _)| *n == name).map_or(&still[..], |(_, numbers)| numbers.slice());
        let tau = of("tau");
        let batched = arrays.iter().any(|(name, a)| *name == "tau" && a.ndim() == 3);
        let tau_steps = tau.len().checked_div(nv * if batched { n } else { 1 }).unwrap_or(0);
        let start = Rollout {
            q: of("q0"),
            qd: of("qd0"),
            theta: of("theta0"),
            thetad: of("thetad0"),
            tau,
            tau_steps,
            step: F::from_f64(dt),
            steps,
            scheme,
        };
        let shape = |name, columns| (name, rows.into_iter().chain([steps + 1, columns]).collect::<Vec<_>>());
        let shapes = [shape("q", nq), shape("qd", nv), shape("theta", nv), shape("thetad", nv)];
        let results = batch::results::<F>(py, &shapes, None)?;
        self.with(model, |w| {
            let model = w.dynamics.owned_model();
            batch::write(&results, |slices| {
                let [q, qd, theta, thetad] = slices else { return Ok(()) };
                let out = Trajectories { q, qd, theta, thetad };
                py.detach(|| rollout(model, n, start, out)).map_err(errors::raise)
            })
        })?;
        batch::together(py, results.into_iter().map(Bound::into_any).collect())
    }
}

/// How many motions there are; `None` if nothing says so.
fn batch_of(arrays: &Start<'_>) -> PyResult<Option<usize>> {
    let mut rows = None;
    for (name, array) in arrays {
        let most = if *name == "tau" { 3 } else { 2 };
        let shape = array.shape();
        if shape.is_empty() || shape.len() > most {
            let problem = format!("an array of shape {} is given", text_of(shape));
            return Err(errors::shape(name, problem, format!("give one of 1 to {most} axes")));
        }
        if shape.len() == most && *rows.get_or_insert(shape[0]) != shape[0] {
            let problem = format!("it has {} rows, but others have {}", shape[0], rows.unwrap_or(0));
            return Err(errors::shape(name, problem, "give arrays of the same batch, or one row for all"));
        }
    }
    Ok(rows)
}
