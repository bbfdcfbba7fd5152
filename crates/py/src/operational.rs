//! The dynamics that a frame feels.

use crate::arguments;
use crate::arrays::{matrix, shaped, vector};
use crate::errors;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use gyroflex::dynamics::{Frame, OperationalSpace, Rotation, State, Task};
use gyroflex::spatial::{Transform, Vec3};
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
    ///     Joint positions, shape `(nq,)`, and velocities, shape `(nv,)` [rad or m, per s].
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
    ///     `representation`, the smallest of the angles' rates.
    #[pyo3(signature = (frame, q, qd, thetad=None, *, directions=None, rotation="geometric", point=None, threshold=1e-6, model=None))]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn operational_space<'py>(
        &self,
        py: Python<'py>,
        frame: &str,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        thetad: Option<&Bound<'py, PyAny>>,
        directions: Option<Vec<String>>,
        rotation: &str,
        point: Option<[f64; 3]>,
        threshold: f64,
        model: Option<&str>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let link = self.link(frame)?;
        let Some(body) = link.body else {
            return Err(errors::argument("frame", format!("the link `{frame}` does not move"), "name a moving link"));
        };
        let directions = match directions {
            Some(names) => names.iter().map(|name| direction(name)).collect::<PyResult<_>>()?,
            None => vec![0, 1, 2, 3, 4, 5],
        };
        let known = [("geometric", Rotation::Geometric), ("rpy", Rotation::RollPitchYaw), ("zyz", Rotation::Zyz)];
        let rotation = arguments::choice("rotation", rotation, &known)?;
        let point = point.unwrap_or_default();
        if !(point.iter().all(|x| x.is_finite()) && (0.0..1.0).contains(&threshold)) {
            let problem = "it is not a finite point, or `threshold` is not from 0 to 1";
            return Err(errors::argument("point", problem, "give three finite coordinates and a small threshold"));
        }
        let placement =
            Transform { pos: link.placement.pos + link.placement.rotation() * Vec3::from(point), ..link.placement };
        let task = Task { frame: Frame { body, placement }, directions: &directions, rotation, threshold };
        let (nv, m) = (self.layout.nv, directions.len());
        self.with(model, |w| {
            self.motion(w, q, qd, thetad)?;
            let [mut jacobian, mut inverse] = [(); 2].map(|()| vec![0.0; m * nv]);
            let [mut bias, mut mu, mut p] = [(); 3].map(|()| vec![0.0; m]);
            let mut inertia = vec![0.0; m * m];
            let Workspace { dynamics, q, qd, theta, thetad, .. } = w;
            let out = OperationalSpace {
                jacobian: &mut jacobian,
                bias_acceleration: &mut bias,
                inertia: &mut inertia,
                inverse: &mut inverse,
                velocity_force: &mut mu,
                gravity_force: &mut p,
            };
            let values =
                dynamics.operational_space(State { q, qd, theta, thetad }, task, out).map_err(errors::raise)?;
            let answer = PyDict::new(py);
            answer.set_item("jacobian", shaped(py, "jacobian", &jacobian, [m, nv])?)?;
            answer.set_item("bias_acceleration", vector(py, "bias_acceleration", &bias)?)?;
            answer.set_item("inertia", matrix(py, "inertia", &inertia, m)?)?;
            answer.set_item("inverse", shaped(py, "inverse", &inverse, [nv, m])?)?;
            answer.set_item("velocity_force", vector(py, "velocity_force", &mu)?)?;
            answer.set_item("gravity_force", vector(py, "gravity_force", &p)?)?;
            answer.set_item("smallest", values.smallest)?;
            answer.set_item("largest", values.largest)?;
            answer.set_item("representation", values.representation)?;
            Ok(answer)
        })
    }
}

/// Index of a velocity of a frame.
pub(crate) fn direction(name: &str) -> PyResult<usize> {
    arguments::choice("directions", name, &[("rx", 0), ("ry", 1), ("rz", 2), ("x", 3), ("y", 4), ("z", 5)])
}
