//! How accelerations and torques change with the motion and with the robot's parameters.

use crate::arrays::{Matrix, Vector, shaped, vector};
use crate::errors;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use gyroflex::dynamics::{
    Acceleration, External, Forward, ForwardDerivatives, InverseDerivatives, PARAMETERS, Regressor, State,
};
use gyroflex_sim::bending::RIGID;
use numpy::PyArray3;
use pyo3::prelude::*;

type Blocks<'py> = Bound<'py, PyArray3<f64>>;

#[pymethods]
impl PyRobot {
    /// How the accelerations of `forward_dynamics` change with state and torques.
    ///
    /// Takes the arguments of `forward_dynamics`. Loads from outside keep their coordinates.
    ///
    /// Returns
    /// -------
    /// (dqdd, dthetadd)
    ///     Shape `(5, nv, nv)` each: matrices by `q, qd, theta, thetad, tau`, in this order. A floating root's pose counts by a
    ///     small motion in its own frame, angular first.
    #[pyo3(signature = (q, qd, theta=None, thetad=None, tau=None, *, model=None, tau_ext=None))]
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
    ) -> PyResult<(Blocks<'py>, Blocks<'py>)> {
        let nv = self.layout.nv;
        self.with(model, |w| {
            self.layout.state(w, q, qd, theta, thetad)?;
            let Some(tau) = tau else {
                return Err(errors::argument("tau", "it is missing", "give the motor torques, zeros for none"));
            };
            self.layout.forces("tau", tau, &mut w.first)?;
            let Workspace { dynamics, q, qd, theta, thetad, first: tau, tau_ext: room, out, .. } = w;
            let ext = External { tau: self.layout.load(tau_ext, room)?, wrenches: &[] };
            let [qdd, thetadd, tau_j] = out;
            let [mut by_qdd, mut by_thetadd] = [(); 2].map(|()| vec![0.0; 5 * nv * nv]);
            let derivatives = ForwardDerivatives { qdd: &mut by_qdd, thetadd: &mut by_thetadd };
            let value = Forward { qdd, thetadd, tau_j };
            dynamics
                .forward_derivatives(State { q, qd, theta, thetad }, tau, ext, value, derivatives)
                .map_err(errors::raise)?;
            Ok((blocks(py, "dqdd", &by_qdd, 5, nv)?, blocks(py, "dthetadd", &by_thetadd, 5, nv)?))
        })
    }

    /// How the torques of `inverse_dynamics` change with the motion.
    ///
    /// Takes the arguments of `inverse_dynamics`. Loads from outside keep their coordinates.
    ///
    /// Returns
    /// -------
    /// (dtau_j, dtau)
    ///     Shape `(6, nv, nv)` each: matrices by `q, qd, qdd, theta, thetad, thetadd`, in this order. A floating root's pose counts
    ///     by a small motion in its own frame, angular first.
    #[pyo3(signature = (q, qd, qdd, theta=None, thetad=None, thetadd=None, *, model=None, tau_ext=None))]
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
    ) -> PyResult<(Blocks<'py>, Blocks<'py>)> {
        let nv = self.layout.nv;
        self.with(model, |w| {
            self.layout.state(w, q, qd, theta, thetad)?;
            self.layout.velocities("qdd", qdd, &mut w.first)?;
            self.layout.motors("thetadd", thetadd, w.elastic, &mut w.second)?;
            let Workspace { dynamics, q, qd, theta, thetad, first: qdd, second: thetadd, tau_ext: room, .. } = w;
            let ext = External { tau: self.layout.load(tau_ext, room)?, wrenches: &[] };
            let [mut tau_j, mut tau] = [(); 2].map(|()| vec![0.0; 6 * nv * nv]);
            let out = InverseDerivatives { tau_j: &mut tau_j, tau: &mut tau };
            dynamics
                .inverse_derivatives(State { q, qd, theta, thetad }, Acceleration { qdd, thetadd }, ext, out)
                .map_err(errors::raise)?;
            Ok((blocks(py, "dtau_j", &tau_j, 6, nv)?, blocks(py, "dtau", &tau, 6, nv)?))
        })
    }

    /// Inverse dynamics as matrices that the robot's `parameters` enter linearly; loads from outside are left out.
    ///
    /// Takes the arguments of `inverse_dynamics` but `tau_ext`.
    ///
    /// Returns
    /// -------
    /// (link, transmission, motor)
    ///     Shape `(nv, 20 bodies)` each. With `p = robot.parameters()`, `link @ p` is the torque that the links need of the
    ///     transmissions, `transmission @ p` the one that those exert, and `motor @ p` what a motor must exert beside its transmission's
    ///     torque, seen from the link side.
    #[pyo3(signature = (q, qd, qdd, theta=None, thetad=None, thetadd=None, *, model=None))]
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
    ) -> PyResult<(Matrix<'py>, Matrix<'py>, Matrix<'py>)> {
        self.with(model, |w| {
            self.layout.state(w, q, qd, theta, thetad)?;
            self.layout.velocities("qdd", qdd, &mut w.first)?;
            self.layout.motors("thetadd", thetadd, w.elastic, &mut w.second)?;
            let Workspace { dynamics, q, qd, theta, thetad, first: qdd, second: thetadd, poses, .. } = w;
            let width = PARAMETERS * poses.len();
            let [mut link, mut transmission, mut motor] = [(); 3].map(|()| vec![0.0; self.layout.nv * width]);
            let out = Regressor { link: &mut link, transmission: &mut transmission, motor: &mut motor };
            dynamics
                .regressor(State { q, qd, theta, thetad }, Acceleration { qdd, thetadd }, out)
                .map_err(errors::raise)?;
            let of = |name, numbers: &[f64]| shaped(py, name, numbers, [self.layout.nv, width]);
            Ok((of("link", &link)?, of("transmission", &transmission)?, of("motor", &motor)?))
        })
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

/// Square blocks side by side, one behind the other.
fn blocks<'py>(py: Python<'py>, name: &str, rows: &[f64], count: usize, nv: usize) -> PyResult<Blocks<'py>> {
    let entry = |at: usize| rows[(at / nv % nv) * count * nv + at / (nv * nv) * nv + at % nv];
    let numbers: Vec<f64> = (0..rows.len()).map(entry).collect();
    shaped(py, name, &numbers, [count, nv, nv])
}
