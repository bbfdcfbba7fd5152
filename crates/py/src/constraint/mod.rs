//! A robot with something held: forward and inverse dynamics, impacts, and the constraints themselves.

mod distribution;
mod result;
mod spec;

pub(crate) use result::{PyConstrainedMotion, PyConstrainedTorques, PyImpact};
pub(crate) use spec::PyConstraint;

use crate::arrays::{Matrix, Vector, shaped, vector};
use crate::errors;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use distribution::Distribution;
use gyroflex::dynamics::{
    Acceleration, Constrained, Constraint, ConstraintMotion, External, Forward, Impact, Inverse, Regularisation, State,
    constraint_rows,
};
use gyroflex::spatial::Force;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use result::Forces;

type Given<'py> = Vec<Bound<'py, PyConstraint>>;

#[pymethods]
impl PyRobot {
    /// The constraints and couplings of the robot's file by name: what always holds it in simulations. Calls take what holds it as an argument.
    #[getter]
    fn constraints<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        for part in &self.robot.held {
            named.set_item(&part.name, PyConstraint::of_part(&self.robot, part).into_pyobject(py)?)?;
        }
        Ok(named)
    }

    /// Accelerations of links and motors with something held, and the forces that hold it.
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)`, and velocities, shape `(nv,)` [rad or m, per s]. They need not keep the constraints.
    /// theta, thetad
    ///     Motor positions and velocities seen from the link side, shape `(nv,)`. Needed if the model has elastic joints.
    /// tau
    ///     Motor torques seen from the link side, shape `(nv,)` [N m or N]; at joints without a drive they act on the joint.
    /// constraints
    ///     What is held: `Constraint`s, in an order in which the first of those that say the same bear the load.
    /// model
    ///     Which physics of the motors.
    /// tau_ext
    ///     Further generalised forces on the link side of the joints, shape `(nv,)` [N m or N].
    /// threshold
    ///     Part of a direction's own mobility below which it counts as dependent on those before it, and is left out.
    /// damping
    ///     Part of its own mobility that is added to each direction, so that those that depend on each other share the load.
    ///
    /// Returns
    /// -------
    /// ConstrainedMotion
    ///     Accelerations `qdd`, `thetadd`, forces `multipliers`, `wrenches`, and how well these were determined.
    #[pyo3(signature = (q, qd, theta=None, thetad=None, tau=None, *, constraints, model=None, tau_ext=None, threshold=1e-9, damping=0.0))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn constrained_forward_dynamics<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        theta: Option<&Bound<'py, PyAny>>,
        thetad: Option<&Bound<'py, PyAny>>,
        tau: Option<&Bound<'py, PyAny>>,
        constraints: Given<'py>,
        model: Option<&str>,
        tau_ext: Option<&Bound<'py, PyAny>>,
        threshold: f64,
        damping: f64,
    ) -> PyResult<PyConstrainedMotion> {
        let (held, regularisation) = (self.held(&constraints)?, regularisation(threshold, damping)?);
        self.with(model, |w| {
            self.layout.state(w, q, qd, theta, thetad)?;
            let Some(tau) = tau else {
                return Err(errors::argument("tau", "it is missing", "give the motor torques, zeros for none"));
            };
            self.layout.forces("tau", tau, &mut w.tau)?;
            let Workspace { dynamics, q, qd, theta, thetad, tau, tau_ext: room, .. } = w;
            let ext = External { tau: self.layout.load(tau_ext, room)?, wrenches: &[] };
            let (mut out, mut multipliers, mut wrenches) = self.room(&held);
            let [qdd, thetadd, tau_j] = &mut out;
            let solved = dynamics.constrained_forward(
                State { q, qd, theta, thetad },
                tau,
                ext,
                &held,
                regularisation,
                Forward { qdd, thetadd, tau_j },
                Constrained { multipliers: &mut multipliers, wrenches: &mut wrenches },
            );
            let forces = Forces { solved: solved.map_err(errors::raise)?, multipliers, wrenches };
            Ok(PyConstrainedMotion { out, forces })
        })
    }

    /// Torques that a motion asks for with something held, and the forces that hold it: of all that make the motion those with the least
    /// `sum(torque_weights * tau_j**2) + sum(multiplier_weights * (multipliers - wanted)**2)`.
    ///
    /// Equal weights give the torques of least norm. What is to bear nothing, as a foot about to be lifted, is left out of `constraints`: the
    /// motion is given.
    ///
    /// Parameters
    /// ----------
    /// q, qd, qdd
    ///     Joint positions, shape `(nq,)`, velocities and accelerations, shape `(nv,)` [rad or m, per s, per s²]. Only motions that keep the
    ///     constraints can be made.
    /// theta, thetad, thetadd
    ///     The same of the motors, seen from the link side, shape `(nv,)`. Needed if the model has elastic joints.
    /// constraints
    ///     What is held: `Constraint`s; none that slips.
    /// passive
    ///     Names of joints that nothing drives, so that constraints must bear all of their load. A floating root always is.
    /// torque_weights
    ///     What torques cost, above zero, shape `(nv,)`; of a floating root's six entries nothing is read, and they may be left out. Default: ones.
    /// multiplier_weights
    ///     What forces along the constrained directions cost, not negative, shape `(m,)` with `m` directions. Zero is allowed where the torques
    ///     alone determine the forces. Default: 1e-6.
    /// wanted
    ///     Forces along the constrained directions to stay near to, shape `(m,)` [N or N m]. Default: zeros.
    /// model
    ///     Which physics of the motors.
    /// tau_ext
    ///     Generalised forces on the link side of the joints that help, shape `(nv,)` [N m or N].
    /// threshold, damping
    ///     As in `constrained_forward_dynamics`.
    ///
    /// Returns
    /// -------
    /// ConstrainedTorques
    ///     Torques `tau_j`, `tau`, forces `multipliers`, `wrenches`, and the load `unborne` that nothing bears.
    #[pyo3(signature = (q, qd, qdd, theta=None, thetad=None, thetadd=None, *, constraints, passive=None, torque_weights=None, multiplier_weights=None, wanted=None, model=None, tau_ext=None, threshold=1e-9, damping=0.0))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn constrained_inverse_dynamics<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        theta: Option<&Bound<'py, PyAny>>,
        thetad: Option<&Bound<'py, PyAny>>,
        thetadd: Option<&Bound<'py, PyAny>>,
        constraints: Given<'py>,
        passive: Option<Vec<String>>,
        torque_weights: Option<&Bound<'py, PyAny>>,
        multiplier_weights: Option<&Bound<'py, PyAny>>,
        wanted: Option<&Bound<'py, PyAny>>,
        model: Option<&str>,
        tau_ext: Option<&Bound<'py, PyAny>>,
        threshold: f64,
        damping: f64,
    ) -> PyResult<PyConstrainedTorques> {
        let (held, regularisation) = (self.held(&constraints)?, regularisation(threshold, damping)?);
        let sharing = Distribution::read(self, &held, passive, torque_weights, multiplier_weights, wanted)?;
        self.with(model, |w| {
            self.layout.state(w, q, qd, theta, thetad)?;
            self.layout.velocities("qdd", qdd, &mut w.qdd)?;
            self.layout.motors("thetadd", thetadd, w.elastic, &mut w.thetadd)?;
            let Workspace { dynamics, q, qd, theta, thetad, qdd, thetadd, tau_ext: room, .. } = w;
            let ext = External { tau: self.layout.load(tau_ext, room)?, wrenches: &[] };
            let ([mut tau_j, mut tau, _], mut multipliers, mut wrenches) = self.room(&held);
            let solved = dynamics.constrained_inverse(
                State { q, qd, theta, thetad },
                Acceleration { qdd, thetadd },
                ext,
                &held,
                sharing.view(),
                regularisation,
                Inverse { tau_j: &mut tau_j, tau: &mut tau },
                Constrained { multipliers: &mut multipliers, wrenches: &mut wrenches },
            );
            let forces = Forces { solved: solved.map_err(errors::raise)?, multipliers, wrenches };
            let unborne = sharing.passive().iter().fold(0.0, |most: f64, k| most.max(tau_j[*k].abs()));
            Ok(PyConstrainedTorques { tau_j, tau, unborne, forces })
        })
    }

    /// Velocities after everything in `constraints` is caught at once, and the impulses of it. Positions stay.
    ///
    /// Elastic transmissions leave the rotors alone; a rigid gear has its rotor stopped with the joint.
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)`, and velocities before, shape `(nv,)` [rad or m, per s].
    /// thetad
    ///     Motor velocities before, seen from the link side, shape `(nv,)`. Needed if the model has elastic joints.
    /// constraints
    ///     What is held afterwards: `Constraint`s; contacts rebound along their normal.
    /// release
    ///     Whether contacts that would have to pull are let go, the one that pulls most first.
    /// model
    ///     Which physics of the motors.
    /// threshold, damping
    ///     As in `constrained_forward_dynamics`.
    ///
    /// Returns
    /// -------
    /// Impact
    ///     Velocities `qd`, `thetad`, impulses `multipliers`, `wrenches`, `gears`, and how well these were determined.
    #[pyo3(signature = (q, qd, thetad=None, *, constraints, release=false, model=None, threshold=1e-9, damping=0.0))]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn impact<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        thetad: Option<&Bound<'py, PyAny>>,
        constraints: Given<'py>,
        release: bool,
        model: Option<&str>,
        threshold: f64,
        damping: f64,
    ) -> PyResult<PyImpact> {
        let (held, regularisation) = (self.held(&constraints)?, regularisation(threshold, damping)?);
        self.with(model, |w| {
            self.motion(w, q, qd, thetad)?;
            let Workspace { dynamics, q, qd, theta, thetad, .. } = w;
            let (mut out, mut multipliers, mut wrenches) = self.room(&held);
            let [after, motors, gears] = &mut out;
            let solved = dynamics.impact(
                State { q, qd, theta, thetad },
                &held,
                release,
                regularisation,
                Impact { qd: after, thetad: motors, gears },
                Constrained { multipliers: &mut multipliers, wrenches: &mut wrenches },
            );
            let forces = Forces { solved: solved.map_err(errors::raise)?, multipliers, wrenches };
            Ok(PyImpact { out, forces })
        })
    }

    /// How far constraints are from being kept, and their Jacobian.
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)`, and velocities, shape `(nv,)` [rad or m, per s].
    /// constraints
    ///     What is held: `Constraint`s.
    ///
    /// Returns
    /// -------
    /// (error, velocity, jacobian)
    ///     With `m` directions: errors of position, of turns to first order, and of velocity, shape `(m,)` [m or rad, per s], and the Jacobian
    ///     of the errors, shape `(m, nv)`, of a floating root by its twist.
    #[pyo3(signature = (q, qd, *, constraints))]
    fn constraint_motion<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        constraints: Given<'py>,
    ) -> PyResult<(Vector<'py>, Vector<'py>, Matrix<'py>)> {
        let held = self.held(&constraints)?;
        let (m, nv) = (constraint_rows(&held), self.layout.nv);
        let (mut error, mut velocity, mut jacobian) = (vec![0.0; m], vec![0.0; m], vec![0.0; m * nv]);
        self.with(None, |w| {
            self.layout.positions(q, &mut w.q)?;
            self.layout.velocities("qd", qd, &mut w.qd)?;
            let out = ConstraintMotion { error: &mut error, velocity: &mut velocity, jacobian: &mut jacobian };
            w.dynamics.constraint_motion(&w.q, &w.qd, &held, out).map_err(errors::raise)?;
            let jacobian = shaped(py, "jacobian", &jacobian, [m, nv])?;
            Ok((vector(py, "error", &error)?, vector(py, "velocity", &velocity)?, jacobian))
        })
    }
}

impl PyRobot {
    fn held(&self, constraints: &Given<'_>) -> PyResult<Vec<Constraint<f64>>> {
        constraints.iter().map(|c| c.get().resolve(self)).collect()
    }

    /// Room for three results over the joints, for multipliers and for wrenches.
    fn room(&self, held: &[Constraint<f64>]) -> ([Vec<f64>; 3], Vec<f64>, Vec<Force<f64>>) {
        let out = std::array::from_fn(|_| vec![0.0; self.layout.nv]);
        (out, vec![0.0; constraint_rows(held)], vec![Force::zero(); held.len()])
    }
}

fn regularisation(threshold: f64, damping: f64) -> PyResult<Regularisation<f64>> {
    if !(0.0..1.0).contains(&threshold) {
        return Err(errors::argument("threshold", format!("it is {threshold}"), "give a small number, 0 or more"));
    }
    if !(damping.is_finite() && damping >= 0.0) {
        return Err(errors::argument("damping", format!("it is {damping}"), "give a small number, 0 for none"));
    }
    Ok(Regularisation { threshold, damping })
}
