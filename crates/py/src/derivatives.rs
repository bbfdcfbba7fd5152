//! How accelerations and torques change with the motion and with the robot's parameters.

use crate::arrays::{Vector, vector};
use crate::batch::{motion_arguments, torque_arguments};
use crate::errors;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use gyroflex::dynamics::{Forward, ForwardDerivatives, InverseDerivatives, PARAMETERS, Regressor};
use gyroflex_sim::Dynamics;
use gyroflex_sim::batch::Given;
use gyroflex_sim::bending::RIGID;
use pyo3::prelude::*;

#[pymethods]
impl PyRobot {
    /// How the accelerations of `forward_dynamics` change with state and torques.
    ///
    /// Takes the arguments of `forward_dynamics`. Loads from outside keep their coordinates.
    ///
    /// Returns
    /// -------
    /// (dqdd, dthetadd)
    ///     Shape `(5, nv, nv)` or `(batch, 5, nv, nv)` each: matrices by `q, qd, theta, thetad, tau`, in this order. A floating root's
    ///     pose counts by a small motion in its own frame, angular first.
    #[pyo3(signature = (q, qd, theta=None, thetad=None, tau=None, *, model=None, tau_ext=None, out=None))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn forward_derivatives<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        theta: Option<&Bound<'py, PyAny>>,
        thetad: Option<&Bound<'py, PyAny>>,
        tau: Option<&Bound<'py, PyAny>>,
        model: Option<&str>,
        tau_ext: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let nv = self.layout.nv;
        let read = |w: &mut Workspace| self.layout.or_batch().torqued(w, [q, qd], [theta, thetad, tau, tau_ext]);
        let one = |dynamics: &mut Dynamics, s: Given<f64>, out: &mut [&mut [f64]]| {
            let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; nv]);
            let [mut by_qdd, mut by_thetadd] = [(); 2].map(|()| vec![0.0; 5 * nv * nv]);
            let value = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
            let derivatives = ForwardDerivatives { qdd: &mut by_qdd, thetadd: &mut by_thetadd };
            dynamics.forward_derivatives(s.state(), s.tau, s.load(), value, derivatives)?;
            out.iter_mut().zip([by_qdd, by_thetadd]).for_each(|(out, rows)| blocks(&rows, 5, nv, out));
            Ok(())
        };
        let arguments = torque_arguments([q, qd], [theta, thetad, tau, tau_ext]);
        let shapes = ["dqdd", "dthetadd"].map(|name| (name, vec![5, nv, nv]));
        self.by_rows(py, model, &arguments, &shapes, out, read, one)
    }

    /// How the torques of `inverse_dynamics` change with the motion.
    ///
    /// Takes the arguments of `inverse_dynamics`. Loads from outside keep their coordinates.
    ///
    /// Returns
    /// -------
    /// (dtau_j, dtau)
    ///     Shape `(6, nv, nv)` or `(batch, 6, nv, nv)` each: matrices by `q, qd, qdd, theta, thetad, thetadd`, in this order. A floating
    ///     root's pose counts by a small motion in its own frame, angular first.
    #[pyo3(signature = (q, qd, qdd, theta=None, thetad=None, thetadd=None, *, model=None, tau_ext=None, out=None))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn inverse_derivatives<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        theta: Option<&Bound<'py, PyAny>>,
        thetad: Option<&Bound<'py, PyAny>>,
        thetadd: Option<&Bound<'py, PyAny>>,
        model: Option<&str>,
        tau_ext: Option<&Bound<'py, PyAny>>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let nv = self.layout.nv;
        let read = |w: &mut Workspace| {
            self.motion_of(w, [q, qd, qdd], [theta, thetad, thetadd])?;
            self.layout.or_batch().load_or_none(tau_ext, &mut w.tau_ext)
        };
        let one = |dynamics: &mut Dynamics, s: Given<f64>, out: &mut [&mut [f64]]| {
            let [mut tau_j, mut tau] = [(); 2].map(|()| vec![0.0; 6 * nv * nv]);
            let derivatives = InverseDerivatives { tau_j: &mut tau_j, tau: &mut tau };
            dynamics.inverse_derivatives(s.state(), s.acceleration(), s.load(), derivatives)?;
            out.iter_mut().zip([tau_j, tau]).for_each(|(out, rows)| blocks(&rows, 6, nv, out));
            Ok(())
        };
        let arguments = motion_arguments([q, qd, qdd], [theta, thetad, thetadd], tau_ext);
        let shapes = ["dtau_j", "dtau"].map(|name| (name, vec![6, nv, nv]));
        self.by_rows(py, model, &arguments, &shapes, out, read, one)
    }

    /// Inverse dynamics as matrices that the robot's `parameters` enter linearly; loads from outside are left out.
    ///
    /// Takes the arguments of `inverse_dynamics` but `tau_ext`.
    ///
    /// Returns
    /// -------
    /// (link, transmission, motor)
    ///     Shape `(nv, 20 bodies)` or `(batch, nv, 20 bodies)` each. With `p = robot.parameters()`, `link @ p` is the torque that the
    ///     links need of the transmissions, `transmission @ p` the one that those exert, and `motor @ p` what a motor must exert beside its
    ///     transmission's torque, seen from the link side.
    #[pyo3(signature = (q, qd, qdd, theta=None, thetad=None, thetadd=None, *, model=None, out=None))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn regressor<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        qdd: &Bound<'py, PyAny>,
        theta: Option<&Bound<'py, PyAny>>,
        thetad: Option<&Bound<'py, PyAny>>,
        thetadd: Option<&Bound<'py, PyAny>>,
        model: Option<&str>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let width = PARAMETERS * self.robot.joints.len();
        let read = |w: &mut Workspace| self.motion_of(w, [q, qd, qdd], [theta, thetad, thetadd]);
        let one = |dynamics: &mut Dynamics, s: Given<f64>, out: &mut [&mut [f64]]| {
            // As many as there are shapes.
            let [link, transmission, motor] = out else { return Ok(()) };
            dynamics.regressor(s.state(), s.acceleration(), Regressor { link, transmission, motor })
        };
        let arguments = motion_arguments([q, qd, qdd], [theta, thetad, thetadd], None);
        let shapes = ["link", "transmission", "motor"].map(|name| (name, vec![self.layout.nv, width]));
        self.by_rows(py, model, &arguments, &shapes, out, read, one)
    }

    /// The parameters that `regressor` belongs to, twenty for each body, shape `(20 bodies,)`.
    ///
    /// Of a body: mass; first moment x, y, z; inertia about the link frame's origin xx, yy, zz, xy, xz, yz, with the rotors at rest on
    /// it; spin inertia of its joint's rotor; friction of the link side viscous, coulomb, stribeck; the same of the motor side;
    /// stiffness, cubic stiffness and damping of the transmission. SI units, each on its own side of the gear.
    #[pyo3(signature = (*, model=None))]
    fn parameters<'py>(&self, py: Python<'py>, model: Option<&str>) -> PyResult<Vector<'py>> {
        self.robot.refuse_bending("the regressor", RIGID).map_err(errors::raise)?;
        self.with(model, |w| vector(py, "parameters", &w.dynamics.parameters()))
    }
}

impl PyRobot {
    /// Positions, velocities and accelerations of joints and motors.
    pub(crate) fn motion_of(
        &self,
        w: &mut Workspace,
        [q, qd, qdd]: [&Bound<'_, PyAny>; 3],
        [theta, thetad, thetadd]: [Option<&Bound<'_, PyAny>>; 3],
    ) -> PyResult<()> {
        let layout = self.layout.or_batch();
        layout.state(w, q, qd, theta, thetad)?;
        layout.velocities("qdd", qdd, &mut w.qdd)?;
        layout.motors("thetadd", thetadd, w.elastic, &mut w.thetadd)
    }
}

/// Square blocks side by side become blocks one behind the other.
fn blocks(rows: &[f64], count: usize, nv: usize, out: &mut [f64]) {
    let entry = |at: usize| rows[(at / nv % nv) * count * nv + at / (nv * nv) * nv + at % nv];
    out.iter_mut().enumerate().for_each(|(at, to)| *to = entry(at));
}
