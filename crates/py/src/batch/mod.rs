//! Calls over batches: arrays of shape `(batch, n)` in lanes and on all cores, with the interpreter released.

mod given;
mod out;
mod table;

pub(crate) use given::{
    Argument, Finite, Float, Need, Numbers, Row, all_given, all_single, columns, motion_arguments, rows,
    torque_arguments,
};
pub(crate) use out::{Shape, results, together, write};
pub(crate) use table::{Table, array};

use crate::errors;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use given::Batch;
use gyroflex_sim::batch::{self, Algorithm, Given};
use gyroflex_sim::{Dynamics, Error, ErrorKind};
use out::{all_finite, fill};
use pyo3::prelude::*;

/// The results of an algorithm that Python sees, the first ones of what it computes.
fn shapes(algorithm: &Algorithm, nv: usize) -> Vec<Shape> {
    let shape = match algorithm {
        Algorithm::ForwardDynamics | Algorithm::InverseDynamics | Algorithm::Bias | Algorithm::GravityTorques => {
            vec![nv]
        }
        Algorithm::MassMatrix | Algorithm::CouplingMatrix => vec![nv, nv],
        Algorithm::CoriolisMatrices | Algorithm::InertiaRates => vec![nv, nv],
        Algorithm::Energy => vec![],
        Algorithm::Placement(..) => vec![4, 4],
        Algorithm::Jacobian(..) => vec![6, nv],
    };
    // Python does not see the transmissions' torques of forward dynamics.
    let seen = if matches!(algorithm, Algorithm::ForwardDynamics) { 2 } else { 3 };
    algorithm.names().iter().take(seen).map(|name| (*name, shape.clone())).collect()
}

impl PyRobot {
    /// Runs an algorithm over what is given: one state in float64 as `single` does it, all else in lanes. `out` takes the results
    /// if there is one.
    pub(crate) fn evaluate<'py>(
        &self,
        py: Python<'py>,
        algorithm: &Algorithm,
        model: Option<&str>,
        arguments: &[Argument<'_, 'py>],
        out: Option<&Bound<'py, PyAny>>,
        single: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        match (Batch::of(arguments)?, out) {
            (None, None) => single(),
            (None, Some(out)) => fill(&shapes(algorithm, self.layout.nv), &single()?, out),
            (Some(batch), out) if batch.single_precision => {
                self.in_lanes::<f32>(py, algorithm, model, arguments, &batch, out)
            }
            (Some(batch), out) => self.in_lanes::<f64>(py, algorithm, model, arguments, &batch, out),
        }
    }

    fn in_lanes<'py, F: Float>(
        &self,
        py: Python<'py>,
        algorithm: &Algorithm,
        model: Option<&str>,
        arguments: &[Argument<'_, 'py>],
        batch: &Batch<'py>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given: Vec<(&str, Numbers<'py, F>)> = batch
            .arrays
            .iter()
            .map(|(name, array)| Ok((*name, columns(&self.layout, name, array, Finite::ByAlgorithm)?)))
            .collect::<PyResult<_>>()?;
        let of = |name: &str| given.iter().find(|(n, _)| *n == name).map_or(&[][..], |(_, numbers)| numbers.slice());
        let states = Given {
            q: of("q"),
            qd: of("qd"),
            theta: of("theta"),
            thetad: of("thetad"),
            qdd: of("qdd"),
            thetadd: of("thetadd"),
            tau: of("tau"),
            tau_ext: of("tau_ext"),
        };
        let shapes: Vec<Shape> = shapes(algorithm, self.layout.nv)
            .into_iter()
            .map(|(name, shape)| (name, batch.rows.into_iter().chain(shape).collect()))
            .collect();
        let rows = batch.rows.unwrap_or(1);
        let results = results::<F>(py, &shapes, out)?;
        self.with(model, |w| {
            all_given(arguments, w.elastic)?;
            write(&results, |slices| {
                let model = w.dynamics.owned_model();
                let Err(e) = py.detach(|| batch::evaluate(model, algorithm, rows, states, slices)) else {
                    return Ok(());
                };
                if e.kind == ErrorKind::Shape {
                    // An entry that is not finite: said with Python's index.
                    for (name, array) in &batch.arrays {
                        columns::<F>(&self.layout, name, array, Finite::Now)?;
                    }
                }
                if batch.rows.is_none() {
                    all_finite(&shapes, slices, None)?;
                }
                Err(errors::raise(e))
            })
        })?;
        together(py, results.into_iter().map(Bound::into_any).collect())
    }

    /// Runs what has no lanes over what is given: one state as `read` finds it in the workspace, or a batch row by row in float64
    /// on all cores. `shapes` are those of the results of one state.
    #[expect(clippy::too_many_arguments, reason = "they are the call, what it takes and what it gives")]
    pub(crate) fn by_rows<'py>(
        &self,
        py: Python<'py>,
        model: Option<&str>,
        arguments: &[Argument<'_, 'py>],
        shapes: &[Shape],
        out: Option<&Bound<'py, PyAny>>,
        read: impl FnOnce(&mut Workspace) -> PyResult<()>,
        one: impl OneState,
    ) -> PyResult<Bound<'py, PyAny>> {
        let batch = Batch::of(arguments)?.filter(|batch| batch.rows.is_some());
        let shapes = batched(&batch, shapes);
        let results = results::<f64>(py, &shapes, out)?;
        self.with(model, |w| {
            write(&results, |slices| self.row_by_row(py, w, arguments, batch, &shapes, slices, read, one))
        })?;
        together(py, results.into_iter().map(Bound::into_any).collect())
    }

    /// The same with results that are kept until they are asked for.
    pub(crate) fn table<'py>(
        &self,
        py: Python<'py>,
        model: Option<&str>,
        arguments: &[Argument<'_, 'py>],
        shapes: &[Shape],
        read: impl FnOnce(&mut Workspace) -> PyResult<()>,
        one: impl OneState,
    ) -> PyResult<Table> {
        let batch = Batch::of(arguments)?.filter(|batch| batch.rows.is_some());
        let shapes = batched(&batch, shapes);
        let mut table = Table::new(shapes.clone());
        self.with(model, |w| self.row_by_row(py, w, arguments, batch, &shapes, &mut table.slices(), read, one))?;
        Ok(table)
    }

    #[expect(clippy::too_many_arguments, reason = "they are the call, what it takes and what it gives")]
    fn row_by_row<'py>(
        &self,
        py: Python<'py>,
        w: &mut Workspace,
        arguments: &[Argument<'_, 'py>],
        given: Option<Batch<'py>>,
        shapes: &[Shape],
        results: &mut [&mut [f64]],
        read: impl FnOnce(&mut Workspace) -> PyResult<()>,
        one: impl OneState,
    ) -> PyResult<()> {
        let Some(given) = given else {
            read(w)?;
            let Workspace { dynamics, q, qd, theta, thetad, qdd, thetadd, tau, tau_ext, .. } = w;
            one(dynamics, Given { q, qd, theta, thetad, qdd, thetadd, tau, tau_ext }, results)
                .map_err(errors::raise)?;
            return all_finite(shapes, results, None);
        };
        all_given(arguments, w.elastic)?;
        let numbers: Vec<(&str, Numbers<'py, f64>)> = given
            .arrays
            .iter()
            .map(|(name, array)| Ok((*name, columns(&self.layout, name, array, Finite::Now)?)))
            .collect::<PyResult<_>>()?;
        let arrays: Vec<(&str, &[f64])> = numbers.iter().map(|(name, numbers)| (*name, numbers.slice())).collect();
        let zeros = vec![0.0; self.layout.nv];
        let row = |k: usize| {
            let of = |name: &str, width: usize| match arrays.iter().find(|(n, _)| *n == name) {
                None => &zeros[..],
                Some((_, all)) if all.len() == width => all,
                Some((_, all)) => &all[k * width..][..width],
            };
            let vector = |name: &str| of(name, self.layout.nv);
            Given {
                q: of("q", self.layout.nq),
                qd: vector("qd"),
                theta: vector("theta"),
                thetad: vector("thetad"),
                qdd: vector("qdd"),
                thetadd: vector("thetadd"),
                tau: vector("tau"),
                tau_ext: vector("tau_ext"),
            }
        };
        let count = given.rows.unwrap_or(1);
        let mut tasks: Vec<Vec<&mut [f64]>> = (0..count).map(|_| Vec::new()).collect();
        for result in results.iter_mut() {
            let width = result.len() / count.max(1);
            let mut rest = &mut **result;
            for task in &mut tasks {
                let (row, others) = rest.split_at_mut(width);
                task.push(row);
                rest = others;
            }
        }
        let dynamics = &w.dynamics;
        let run = |dynamics: &mut Dynamics, (k, mut out): (usize, Vec<&mut [f64]>)| {
            let of_row = |e: Error| Error { problem: format!("row {k}: {}", e.problem), ..e };
            one(dynamics, row(k), &mut out).map_err(of_row)
        };
        py.detach(|| batch::in_parallel(tasks, || dynamics.clone(), run)).map_err(errors::raise)?;
        all_finite(shapes, results, given.rows)
    }
}

/// What is computed of one state.
pub(crate) trait OneState: Fn(&mut Dynamics, Given<f64>, &mut [&mut [f64]]) -> Result<(), Error> + Sync {}
impl<F: Fn(&mut Dynamics, Given<f64>, &mut [&mut [f64]]) -> Result<(), Error> + Sync> OneState for F {}

/// The shapes that results have of all rows.
fn batched(batch: &Option<Batch<'_>>, shapes: &[Shape]) -> Vec<Shape> {
    let rows = batch.as_ref().and_then(|batch| batch.rows);
    shapes.iter().map(|(name, shape)| (*name, rows.into_iter().chain(shape.iter().copied()).collect())).collect()
}
