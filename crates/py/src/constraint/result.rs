//! What dynamics and impacts of a robot with something held find.

use crate::batch::{Shape, Table};
use gyroflex::dynamics::{Constraint, Solved, constraint_rows};
use gyroflex::spatial::Force;
use pyo3::prelude::*;

/// Results: some over the joints, then the forces of what is held and how well they were determined.
pub(super) fn shapes(over_joints: &[&'static str], nv: usize, held: &[Constraint<f64>]) -> Vec<Shape> {
    let forces = [("multipliers", vec![constraint_rows(held)]), ("wrenches", vec![held.len(), 6])];
    let numbers = ["dependent", "contradiction", "independence", "released"].map(|name| (name, vec![]));
    over_joints.iter().map(|name| (*name, vec![nv])).chain(forces).chain(numbers).collect()
}

/// Writes what follows the multipliers.
pub(super) fn write(solved: &Solved<f64>, wrenches: &[Force<f64>], out: &mut [&mut [f64]]) {
    let Solved { dependent, contradiction, independence, released } = *solved;
    let [_, rows, a, b, c, d] = out else { return };
    rows.iter_mut().zip(wrenches.iter().flat_map(|w| w.to_array())).for_each(|(to, from)| *to = from);
    (a[0], b[0], c[0], d[0]) = (dependent, contradiction, independence, released);
}

/// Accelerations of a robot with something held, and the forces of it. Every array is a new one; of a batch, all are arrays that lead with it.
#[pyclass(name = "ConstrainedMotion", module = "gyroflex", frozen)]
pub(crate) struct PyConstrainedMotion(pub(super) Table);

#[pymethods]
impl PyConstrainedMotion {
    /// Accelerations of the joints, shape `([batch,] nv)` [rad/s² or m/s²].
    #[getter]
    fn qdd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "qdd")
    }

    /// Accelerations of the motors seen from the link side, shape `([batch,] nv)`; those of the joints without an elastic transmission.
    #[getter]
    fn thetadd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "thetadd")
    }

    /// Torques that the transmissions exert on the joints, shape `([batch,] nv)` [N m or N].
    #[getter]
    fn tau_j<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "tau_j")
    }

    /// Forces along the constrained directions, constraint by constraint, shape `([batch,] m)` [N or N m].
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "multipliers")
    }

    /// Wrench of each constraint on its link, about the origin of its frame in world axes, shape `([batch,] constraints, 6)`: moment [N m], force
    /// [N]. Zero for coupled joints.
    #[getter]
    fn wrenches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "wrenches")
    }

    /// How many directions were left out because others say the same.
    #[getter]
    fn dependent<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.count(py, "dependent")
    }

    /// The largest acceleration that those ask for and do not get [m/s² or rad/s²]; not small if constraints contradict each other.
    #[getter]
    fn contradiction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "contradiction")
    }

    /// The smallest part of a direction's own mobility that the ones before it leave it, 0 to 1: next to 0 it nearly depends on them.
    #[getter]
    fn independence<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "independence")
    }
}

/// Torques of a motion with something held, and the forces of it. Every array is a new one; of a batch, all are arrays that lead with it.
#[pyclass(name = "ConstrainedTorques", module = "gyroflex", frozen)]
pub(crate) struct PyConstrainedTorques(pub(super) Table);

#[pymethods]
impl PyConstrainedTorques {
    /// Torques that the transmissions must exert on the joints, shape `([batch,] nv)` [N m or N].
    #[getter]
    fn tau_j<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "tau_j")
    }

    /// Torques that the motors must exert, seen from the link side, shape `([batch,] nv)` [N m or N].
    #[getter]
    fn tau<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "tau")
    }

    /// Forces along the constrained directions, constraint by constraint, shape `([batch,] m)` [N or N m].
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "multipliers")
    }

    /// Wrench of each constraint on its link, about the origin of its frame in world axes, shape `([batch,] constraints, 6)`: moment [N m], force
    /// [N]. Zero for coupled joints.
    #[getter]
    fn wrenches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "wrenches")
    }

    /// How many directions were left out because others say the same.
    #[getter]
    fn dependent<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.count(py, "dependent")
    }

    /// The largest load at a passive joint, or on a floating root, that no constraint bears [N m or N]: not small, and the motion is impossible.
    #[getter]
    fn unborne<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "unborne")
    }
}

/// Velocities after an impact, and the impulses of it. Every array is a new one; of a batch, all are arrays that lead with it.
#[pyclass(name = "Impact", module = "gyroflex", frozen)]
pub(crate) struct PyImpact(pub(super) Table);

#[pymethods]
impl PyImpact {
    /// Velocities of the joints afterwards, shape `([batch,] nv)` [rad/s or m/s].
    #[getter]
    fn qd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "qd")
    }

    /// Velocities of the motors afterwards seen from the link side, shape `([batch,] nv)`; those of the joints without an elastic transmission.
    #[getter]
    fn thetad<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "thetad")
    }

    /// Impulses that rigid gears exert on their joints, shape `([batch,] nv)` [N m s or N s]; zero elsewhere.
    #[getter]
    fn gears<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "gears")
    }

    /// Impulses along the constrained directions, constraint by constraint, shape `([batch,] m)` [N s or N m s].
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "multipliers")
    }

    /// Impulse of each constraint on its link, about the origin of its frame in world axes, shape `([batch,] constraints, 6)`: angular [N m s],
    /// linear [N s]. Zero for coupled joints.
    #[getter]
    fn wrenches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "wrenches")
    }

    /// How many directions were left out because others say the same.
    #[getter]
    fn dependent<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.count(py, "dependent")
    }

    /// The largest jump of velocity that those ask for and do not get [m/s or rad/s].
    #[getter]
    fn contradiction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "contradiction")
    }

    /// The smallest part of a direction's own mobility that the ones before it leave it, 0 to 1: next to 0 it nearly depends on them.
    #[getter]
    fn independence<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.get(py, "independence")
    }

    /// How many contacts were released because they would have pulled.
    #[getter]
    fn released<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.0.count(py, "released")
    }
}
