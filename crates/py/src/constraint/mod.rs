//! A robot with something held: forward and inverse dynamics, impacts, and the constraints themselves.

mod distribution;
mod result;
mod spec;

pub(crate) use result::{PyConstrainedMotion, PyConstrainedTorques, PyImpact};
pub(crate) use spec::PyConstraint;

use crate::batch::{Need, motion_arguments, torque_arguments};
use crate::errors;
use crate::named;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use distribution::Distribution;
use gyroflex::dynamics::{
    Constrained, Constraint, ConstraintMotion, Forward, Impact, Inverse, Regularisation, constraint_rows,
};
use gyroflex::spatial::Force;
use gyroflex_sim::Dynamics;
use gyroflex_sim::batch::Given;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What a call is told to hold.
type Held<'py> = Vec<Bound<'py, PyConstraint>>;

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
    ///     Joint positions, shape `(nq,)`, and velocities, shape `(nv,)` [rad or m, per s]. They need not keep the constraints. Any array over
    ///     joints or motors may be a batch, `(batch, n)`, whose states are computed on all cores.
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
    ///     Accelerations `qdd`, `thetadd`, forces `multipliers`, `wrenches`, and how well these were determined; arrays that lead with the
    ///     batch if there is one.
    #[pyo3(signature = (q, qd, theta=None, thetad=None, tau=None, *, constraints, model=None, tau_ext=None, threshold=1e-9, damping=0.0))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn constrained_forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        theta: Option<&Bound<'py, PyAny>>,
        thetad: Option<&Bound<'py, PyAny>>,
        tau: Option<&Bound<'py, PyAny>>,
        constraints: Held<'py>,
        model: Option<&str>,
        tau_ext: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = named::threshold)] threshold: f64,
        #[pyo3(from_py_with = named::damping)] damping: Option<f64>,
    ) -> PyResult<PyConstrainedMotion> {
        let (held, regularisation) =
            (self.held(&constraints)?, regularisation(threshold, damping.unwrap_or_default())?);
        let read = |w: &mut Workspace| self.layout.or_batch().torqued(w, [q, qd], [theta, thetad, tau, tau_ext]);
        let one = |dynamics: &mut Dynamics, s: Given<f64>, out: &mut [&mut [f64]]| {
            let [qdd, thetadd, tau_j, forces @ ..] = out else { return Ok(()) };
            let mut wrenches = vec![Force::zero(); held.len()];
            let solved = dynamics.constrained_forward(
                s.state(),
                s.tau,
                s.load(),
                &held,
                regularisation,
                Forward { qdd, thetadd, tau_j },
                Constrained { multipliers: forces[0], wrenches: &mut wrenches },
            )?;
            result::write(&solved, &wrenches, forces);
            Ok(())
        };
        let arguments = torque_arguments([q, qd], [theta, thetad, tau, tau_ext]);
        let shapes = result::shapes(&["qdd", "thetadd", "tau_j"], self.layout.nv, &held);
        Ok(PyConstrainedMotion(self.table(py, model, &arguments, &shapes, read, one)?))
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
    ///     constraints can be made. Arrays over joints or motors may be batches, `(batch, n)`; weights and `wanted` are the same for all.
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
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        theta: Option<&Bound<'py, PyAny>>,
        thetad: Option<&Bound<'py, PyAny>>,
        thetadd: Option<&Bound<'py, PyAny>>,
        constraints: Held<'py>,
        #[pyo3(from_py_with = named::passive)] passive: Option<Vec<String>>,
        torque_weights: Option<&Bound<'py, PyAny>>,
        multiplier_weights: Option<&Bound<'py, PyAny>>,
        wanted: Option<&Bound<'py, PyAny>>,
        model: Option<&str>,
        tau_ext: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = named::threshold)] threshold: f64,
        #[pyo3(from_py_with = named::damping)] damping: Option<f64>,
    ) -> PyResult<PyConstrainedTorques> {
        let (held, regularisation) =
            (self.held(&constraints)?, regularisation(threshold, damping.unwrap_or_default())?);
        let sharing = Distribution::read(self, &held, passive, torque_weights, multiplier_weights, wanted)?;
        let read = |w: &mut Workspace| {
            self.motion_of(w, [q, qd, qdd], [theta, thetad, thetadd])?;
            self.layout.load_or_none(tau_ext, &mut w.tau_ext)
        };
        let one = |dynamics: &mut Dynamics, s: Given<f64>, out: &mut [&mut [f64]]| {
            let [tau_j, tau, unborne, forces @ ..] = out else { return Ok(()) };
            let mut wrenches = vec![Force::zero(); held.len()];
            let solved = dynamics.constrained_inverse(
                s.state(),
                s.acceleration(),
                s.load(),
                &held,
                sharing.view(),
                regularisation,
                Inverse { tau_j, tau },
                Constrained { multipliers: forces[0], wrenches: &mut wrenches },
            )?;
            unborne[0] = sharing.passive().iter().fold(0.0, |most: f64, k| most.max(tau_j[*k].abs()));
            result::write(&solved, &wrenches, forces);
            Ok(())
        };
        let arguments = motion_arguments([q, qd, qdd], [theta, thetad, thetadd], tau_ext);
        let mut shapes = result::shapes(&["tau_j", "tau"], self.layout.nv, &held);
        shapes.insert(2, ("unborne", vec![]));
        Ok(PyConstrainedTorques(self.table(py, model, &arguments, &shapes, read, one)?))
    }

    /// Velocities after everything in `constraints` is caught at once, and the impulses of it. Positions stay.
    ///
    /// Elastic transmissions leave the rotors alone; a rigid gear has its rotor stopped with the joint.
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)` or `(batch, nq)`, and velocities before, shape `(nv,)` or `(batch, nv)` [rad or m, per s].
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
    ///     Velocities `qd`, `thetad`, impulses `multipliers`, `wrenches`, `gears`, and how well these were determined; arrays that lead with
    ///     the batch if there is one.
    #[pyo3(signature = (q, qd, thetad=None, *, constraints, release=false, model=None, threshold=1e-9, damping=0.0))]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn impact<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        thetad: Option<&Bound<'py, PyAny>>,
        constraints: Held<'py>,
        release: bool,
        model: Option<&str>,
        #[pyo3(from_py_with = named::threshold)] threshold: f64,
        #[pyo3(from_py_with = named::damping)] damping: Option<f64>,
    ) -> PyResult<PyImpact> {
        let (held, regularisation) =
            (self.held(&constraints)?, regularisation(threshold, damping.unwrap_or_default())?);
        let read = |w: &mut Workspace| self.layout.or_batch().motion(w, q, qd, thetad);
        let one = |dynamics: &mut Dynamics, s: Given<f64>, out: &mut [&mut [f64]]| {
            let [qd, thetad, gears, forces @ ..] = out else { return Ok(()) };
            let mut wrenches = vec![Force::zero(); held.len()];
            let solved = dynamics.impact(
                s.state(),
                &held,
                release,
                regularisation,
                Impact { qd, thetad, gears },
                Constrained { multipliers: forces[0], wrenches: &mut wrenches },
            )?;
            result::write(&solved, &wrenches, forces);
            Ok(())
        };
        let arguments =
            [("q", Some(q), Need::Always), ("qd", Some(qd), Need::Always), ("thetad", thetad, Need::Elastic)];
        let shapes = result::shapes(&["qd", "thetad", "gears"], self.layout.nv, &held);
        Ok(PyImpact(self.table(py, model, &arguments, &shapes, read, one)?))
    }

    /// How far constraints are from being kept, and their Jacobian.
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)` or `(batch, nq)`, and velocities, shape `(nv,)` or `(batch, nv)` [rad or m, per s].
    /// constraints
    ///     What is held: `Constraint`s.
    /// out
    ///     A tuple of arrays that takes the results.
    ///
    /// Returns
    /// -------
    /// (error, velocity, jacobian)
    ///     With `m` directions: errors of position, of turns to first order, and of velocity, shape `(m,)` [m or rad, per s], and the Jacobian
    ///     of the errors, shape `(m, nv)`, of a floating root by its twist; each leads with the batch if there is one.
    #[pyo3(signature = (q, qd, *, constraints, out=None))]
    fn constraint_motion<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        constraints: Held<'py>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let held = self.held(&constraints)?;
        let read = |w: &mut Workspace| {
            self.layout.or_batch().positions(q, &mut w.q)?;
            self.layout.or_batch().velocities("qd", qd, &mut w.qd)
        };
        let one = |dynamics: &mut Dynamics, s: Given<f64>, out: &mut [&mut [f64]]| {
            let [error, velocity, jacobian] = out else { return Ok(()) };
            dynamics.constraint_motion(s.q, s.qd, &held, ConstraintMotion { error, velocity, jacobian })
        };
        let (m, nv) = (constraint_rows(&held), self.layout.nv);
        let shapes = [("error", vec![m]), ("velocity", vec![m]), ("jacobian", vec![m, nv])];
        let arguments = [("q", Some(q), Need::Always), ("qd", Some(qd), Need::Always)];
        self.by_rows(py, None, &arguments, &shapes, out, read, one)
    }
}

impl PyRobot {
    fn held(&self, constraints: &Held<'_>) -> PyResult<Vec<Constraint<f64>>> {
        constraints.iter().map(|c| c.get().resolve(self)).collect()
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
