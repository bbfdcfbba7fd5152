//! Energies, and how a frame moves with the joints.

use crate::arrays::{check_result, shaped};
use crate::batch::Need;
use crate::errors;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use gyroflex::dynamics::{Axes, State};
use gyroflex_sim::batch::Algorithm;
use pyo3::prelude::*;

#[pymethods]
impl PyRobot {
    /// Energies of a state [J].
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)` or `(batch, nq)`, and velocities, shape `(nv,)` or `(batch, nv)` [rad or m, per s].
    /// theta, thetad
    ///     Motor positions and velocities seen from the link side, shaped alike. Needed if the model has elastic joints.
    /// model
    ///     Which physics of the motors.
    /// out
    ///     Three arrays that take the results, of shape `()`, of a batch `(batch,)`.
    ///
    /// Returns
    /// -------
    /// (kinetic, gravity, elastic)
    ///     Of one state a `float` each, in float32 or with `out` an array of shape `()`; of many arrays of shape `(batch,)`.
    #[pyo3(signature = (q, qd, theta=None, thetad=None, *, model=None, out=None))]
    #[expect(clippy::too_many_arguments, reason = "they are the state")]
    fn energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        theta: Option<&Bound<'py, PyAny>>,
        thetad: Option<&Bound<'py, PyAny>>,
        model: Option<&str>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let single = || {
            self.with(model, |w| {
                self.layout.or_batch().state(w, q, qd, theta, thetad)?;
                let Workspace { dynamics, q, qd, theta, thetad, .. } = w;
                let e = dynamics.energy(State { q, qd, theta, thetad }).map_err(errors::raise)?;
                for (name, energy) in [("kinetic", e.kinetic), ("gravity", e.gravity), ("elastic", e.elastic)] {
                    check_result(name, &[energy])?;
                }
                Ok((e.kinetic, e.gravity, e.elastic).into_pyobject(py)?.into_any())
            })
        };
        let arguments = [
            ("q", Some(q), Need::Always),
            ("qd", Some(qd), Need::Always),
            ("theta", theta, Need::Elastic),
            ("thetad", thetad, Need::Elastic),
        ];
        self.evaluate(py, &Algorithm::Energy, model, &arguments, out, single)
    }

    /// Jacobian of a link's frame, shape `(6, nv)` or `(batch, 6, nv)`, angular rows first: times `qd` it is the frame's angular
    /// velocity and the velocity of its origin.
    ///
    /// Parameters
    /// ----------
    /// frame
    ///     Name of a moving link of the URDF.
    /// q
    ///     Joint positions, shape `(nq,)` or `(batch, nq)` [rad or m].
    /// axes
    ///     Whose axes the rows are in: `world`, or `local` for the frame's own.
    /// out
    ///     An array that takes the result.
    #[pyo3(signature = (frame, q, *, axes="world", out=None))]
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        frame: &str,
        q: &Bound<'py, PyAny>,
        axes: &str,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let link = self.frame(frame)?;
        if !link.moves() {
            return Err(errors::argument("frame", format!("the link `{frame}` does not move"), "name a moving link"));
        }
        let axes = crate::arguments::choice("axes", axes, &[("world", Axes::World), ("local", Axes::Local)])?;
        let single = || {
            self.with(None, |w| {
                self.layout.or_batch().positions(q, &mut w.q)?;
                let nv = self.layout.nv;
                let mut rows = vec![0.0; 6 * nv];
                link.jacobian(&w.dynamics, &w.q, axes, &mut rows).map_err(errors::raise)?;
                Ok(shaped(py, "jacobian", &rows, [6, nv])?.into_any())
            })
        };
        self.evaluate(py, &Algorithm::Jacobian(link.clone(), axes), None, &[("q", Some(q), Need::Always)], out, single)
    }
}
