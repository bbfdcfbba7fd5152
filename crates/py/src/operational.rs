//! The dynamics that a frame feels.

use crate::arguments;
use crate::batch::Need;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use crate::{errors, named};
use gyroflex::dynamics::{Frame, OperationalSpace, Rotation, Task};
use gyroflex::spatial::{Transform, Vec3};
use gyroflex_sim::Dynamics;
use gyroflex_sim::batch::Given;
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[pymethods]
impl PyRobot {
    /// The dynamics that a link feels at its frame, or at a point of it: `Λ ẍ + μ + p = J̄ᵀ u`.
    ///
    /// Parameters
    /// ----------
    /// frame
    ///     Name of a moving link of the URDF.
    /// q, qd
    ///     Joint positions, shape `(nq,)`, and velocities, shape `(nv,)` [rad or m, per s]; or with a batch as the first axis.
    /// thetad
    ///     Motor velocities seen from the link side, shape `(nv,)`. Needed if the model has elastic joints.
    /// directions
    ///     Which velocities count, out of `rx`, `ry`, `rz`, `x`, `y`, `z` in world axes; all six by default.
    /// rotation
    ///     What `rx`, `ry`, `rz` are: `geometric` for the angular velocity, `rpy` or `zyz` for rates of these angles.
    /// point
    ///     Reference point in the link's frame [m]; by default its origin.
    /// threshold
    ///     Directions in which the frame accelerates less than this part of the most count as ones in which it cannot move.
    /// model
    ///     Which physics of the motors.
    ///
    /// Returns
    /// -------
    /// dict
    ///     With `m` directions: `jacobian` `(m, nv)`, `bias_acceleration` `J̇ q̇` `(m,)`, `inertia` `Λ` `(m, m)`, `inverse` `J̄`
    ///     `(nv, m)`, `velocity_force` `μ` and `gravity_force` `p` `(m,)`, and the singular values `smallest`, `largest` of the Jacobian and
    ///     `representation`, the smallest of the angles' rates. Of a batch all of them with the batch as the first axis.
    #[pyo3(signature = (frame, q, qd, thetad=None, *, directions=None, rotation="geometric", point=None, threshold=1e-6, model=None))]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn operational_space<'py>(
        &self,
        py: Python<'py>,
        frame: &str,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        thetad: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = named::directions)] directions: Option<Vec<String>>,
        rotation: &str,
        #[pyo3(from_py_with = named::point)] point: Option<[f64; 3]>,
        #[pyo3(from_py_with = named::threshold)] threshold: f64,
        model: Option<&str>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let link = self.link("frame", frame)?;
        let Some(body) = link.body else {
            return Err(errors::argument("frame", format!("the link `{frame}` does not move"), "name a moving link"));
        };
        let directions = match directions {
            Some(names) => names.iter().map(|name| direction(name)).collect::<PyResult<Vec<_>>>()?,
            None => vec![0, 1, 2, 3, 4, 5],
        };
        if directions.is_empty() || (1..directions.len()).any(|i| directions[..i].contains(&directions[i])) {
            let problem = if directions.is_empty() { "it is empty" } else { "a direction is there twice" };
            return Err(errors::argument("directions", problem, "give some of rx, ry, rz, x, y, z, once each"));
        }
        let known = [("geometric", Rotation::Geometric), ("rpy", Rotation::RollPitchYaw), ("zyz", Rotation::Zyz)];
        let rotation = arguments::choice("rotation", rotation, &known)?;
        let point = point.unwrap_or_default();
        if !(0.0..1.0).contains(&threshold) {
            let problem = format!("it is {threshold}");
            return Err(errors::argument("threshold", problem, "give a small number, 0 or more and less than 1"));
        }
        let placement =
            Transform { pos: link.placement.pos + link.placement.rotation() * Vec3::from(point), ..link.placement };
        let task = Task { frame: Frame { body, placement }, directions: &directions, rotation, threshold };
        let (nv, m) = (self.layout.nv, directions.len());
        let read = |w: &mut Workspace| self.layout.or_batch().motion(w, q, qd, thetad);
        let one = |dynamics: &mut Dynamics, s: Given<f64>, out: &mut [&mut [f64]]| {
            // As many as there are names.
            let [jacobian, bias, inertia, inverse, mu, p, smallest, largest, representation] = out else {
                return Ok(());
            };
            let out = OperationalSpace {
                jacobian,
                bias_acceleration: bias,
                inertia,
                inverse,
                velocity_force: mu,
                gravity_force: p,
            };
            let values = dynamics.operational_space(s.state(), task, out)?;
            (smallest[0], largest[0], representation[0]) = (values.smallest, values.largest, values.representation);
            Ok(())
        };
        let arguments =
            [("q", Some(q), Need::Always), ("qd", Some(qd), Need::Always), ("thetad", thetad, Need::Elastic)];
        let shapes = [
            ("jacobian", vec![m, nv]),
            ("bias_acceleration", vec![m]),
            ("inertia", vec![m, m]),
            ("inverse", vec![nv, m]),
            ("velocity_force", vec![m]),
            ("gravity_force", vec![m]),
            ("smallest", vec![]),
            ("largest", vec![]),
            ("representation", vec![]),
        ];
        let found = self.by_rows(py, model, &arguments, &shapes, None, read, one)?;
        let answer = PyDict::new(py);
        for ((name, _), array) in shapes.iter().zip(found.try_iter()?) {
            let array = array?;
            // A number by itself is a number, not an array of one.
            let is_number = array.getattr("ndim")?.extract::<usize>()? == 0;
            answer.set_item(name, if is_number { array.call_method0("item")? } else { array })?;
        }
        Ok(answer)
    }
}

/// Index of a velocity of a frame.
pub(crate) fn direction(name: &str) -> PyResult<usize> {
    arguments::choice("directions", name, &[("rx", 0), ("ry", 1), ("rz", 2), ("x", 3), ("y", 4), ("z", 5)])
}
