//! What dynamics and impacts of a robot with something held find.

use crate::arrays::{Matrix, Vector, shaped, vector};
use gyroflex::dynamics::Solved;
use gyroflex::spatial::Force;
use pyo3::prelude::*;

/// The forces of constraints, and how well they were determined.
#[derive(Debug)]
pub(super) struct Forces {
    pub(super) multipliers: Vec<f64>,
    pub(super) wrenches: Vec<Force<f64>>,
    pub(super) solved: Solved<f64>,
}

impl Forces {
    fn wrenches<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        let numbers: Vec<f64> = self.wrenches.iter().flat_map(|w| w.to_array()).collect();
        shaped(py, "wrenches", &numbers, [self.wrenches.len(), 6])
    }
}

/// Accelerations of a robot with something held, and the forces of it. Every array is a new one.
#[pyclass(name = "ConstrainedMotion", module = "gyroflex", frozen)]
pub(crate) struct PyConstrainedMotion {
    pub(super) out: [Vec<f64>; 3],
    pub(super) forces: Forces,
}

#[pymethods]
impl PyConstrainedMotion {
    /// Accelerations of the joints, shape `(nv,)` [rad/s² or m/s²].
    #[getter]
    fn qdd<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "qdd", &self.out[0])
    }

    /// Accelerations of the motors seen from the link side, shape `(nv,)`; those of the joints without an elastic transmission.
    #[getter]
    fn thetadd<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "thetadd", &self.out[1])
    }

    /// Torques that the transmissions exert on the joints, shape `(nv,)` [N m or N].
    #[getter]
    fn tau_j<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "tau_j", &self.out[2])
    }

    /// Forces along the constrained directions, constraint by constraint [N or N m].
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "multipliers", &self.forces.multipliers)
    }

    /// Wrench of each constraint on its link, about the origin of its frame in world axes, shape `(constraints, 6)`: moment [N m], force
    /// [N]. Zero for coupled joints.
    #[getter]
    fn wrenches<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        self.forces.wrenches(py)
    }

    /// How many directions were left out because others say the same.
    #[getter]
    fn dependent(&self) -> usize {
        self.forces.solved.dependent as usize
    }

    /// The largest acceleration that those ask for and do not get [m/s² or rad/s²]; not small if constraints contradict each other.
    #[getter]
    fn contradiction(&self) -> f64 {
        self.forces.solved.contradiction
    }

    /// The smallest part of a direction's own mobility that the ones before it leave it, 0 to 1: next to 0 it nearly depends on them.
    #[getter]
    fn independence(&self) -> f64 {
        self.forces.solved.independence
    }
}

/// Torques of a motion with something held, and the forces of it. Every array is a new one.
#[pyclass(name = "ConstrainedTorques", module = "gyroflex", frozen)]
pub(crate) struct PyConstrainedTorques {
    pub(super) tau_j: Vec<f64>,
    pub(super) tau: Vec<f64>,
    pub(super) unborne: f64,
    pub(super) forces: Forces,
}

#[pymethods]
impl PyConstrainedTorques {
    /// Torques that the transmissions must exert on the joints, shape `(nv,)` [N m or N].
    #[getter]
    fn tau_j<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "tau_j", &self.tau_j)
    }

    /// Torques that the motors must exert, seen from the link side, shape `(nv,)` [N m or N].
    #[getter]
    fn tau<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "tau", &self.tau)
    }

    /// Forces along the constrained directions, constraint by constraint [N or N m].
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "multipliers", &self.forces.multipliers)
    }

    /// Wrench of each constraint on its link, about the origin of its frame in world axes, shape `(constraints, 6)`: moment [N m], force
    /// [N]. Zero for coupled joints.
    #[getter]
    fn wrenches<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        self.forces.wrenches(py)
    }

    /// How many directions were left out because others say the same.
    #[getter]
    fn dependent(&self) -> usize {
        self.forces.solved.dependent as usize
    }

    /// The largest load at a passive joint, or on a floating root, that no constraint bears [N m or N]: not small, and the motion is impossible.
    #[getter]
    fn unborne(&self) -> f64 {
        self.unborne
    }
}

/// Velocities after an impact, and the impulses of it. Every array is a new one.
#[pyclass(name = "Impact", module = "gyroflex", frozen)]
pub(crate) struct PyImpact {
    pub(super) out: [Vec<f64>; 3],
    pub(super) forces: Forces,
}

#[pymethods]
impl PyImpact {
    /// Velocities of the joints afterwards, shape `(nv,)` [rad/s or m/s].
    #[getter]
    fn qd<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "qd", &self.out[0])
    }

    /// Velocities of the motors afterwards seen from the link side, shape `(nv,)`; those of the joints without an elastic transmission.
    #[getter]
    fn thetad<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "thetad", &self.out[1])
    }

    /// Impulses that rigid gears exert on their joints, shape `(nv,)` [N m s or N s]; zero elsewhere.
    #[getter]
    fn gears<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "gears", &self.out[2])
    }

    /// Impulses along the constrained directions, constraint by constraint [N s or N m s].
    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> PyResult<Vector<'py>> {
        vector(py, "multipliers", &self.forces.multipliers)
    }

    /// Impulse of each constraint on its link, about the origin of its frame in world axes, shape `(constraints, 6)`: angular [N m s],
    /// linear [N s]. Zero for coupled joints.
    #[getter]
    fn wrenches<'py>(&self, py: Python<'py>) -> PyResult<Matrix<'py>> {
        self.forces.wrenches(py)
    }

    /// How many directions were left out because others say the same.
    #[getter]
    fn dependent(&self) -> usize {
        self.forces.solved.dependent as usize
    }

    /// The largest jump of velocity that those ask for and do not get [m/s or rad/s].
    #[getter]
    fn contradiction(&self) -> f64 {
        self.forces.solved.contradiction
    }

    /// The smallest part of a direction's own mobility that the ones before it leave it, 0 to 1: next to 0 it nearly depends on them.
    #[getter]
    fn independence(&self) -> f64 {
        self.forces.solved.independence
    }

    /// How many contacts were released because they would have pulled.
    #[getter]
    fn released(&self) -> usize {
        self.forces.solved.released as usize
    }
}
