//! Matrices and forces of the equations of motion.

use crate::arrays::{matrix, vector};
use crate::batch::Need;
use crate::errors;
use crate::robot::PyRobot;
use crate::workspace::Workspace;
use gyroflex::dynamics::{Bias, CoriolisMatrices, InertiaRates, State};
use gyroflex_sim::batch::Algorithm;
use pyo3::prelude::*;

#[pymethods]
impl PyRobot {
    /// Inertia matrix `M(q)` of the link side, shape `(nv, nv)` [kg m², kg m, kg]; rigidly geared rotors are fully in.
    ///
    /// Parameters
    /// ----------
    /// q
    ///     Joint positions, shape `(nq,)` [rad or m].
    /// model
    ///     Which physics of the motors.
    #[pyo3(signature = (q, *, model=None, out=None))]
    fn mass_matrix<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        model: Option<&str>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let single = || {
            self.with(model, |w| {
                self.layout.or_batch().positions(q, &mut w.q)?;
                w.dynamics.mass_matrix(&w.q, &mut w.matrix).map_err(errors::raise)?;
                Ok(matrix(py, "mass matrix", &w.matrix, self.layout.nv)?.into_any())
            })
        };
        let arguments = [("q", Some(q), Need::Always)];
        self.evaluate(py, &Algorithm::MassMatrix, model, &arguments, out, single)
    }

    /// Inertial coupling `S(q)` of link accelerations (rows) and motor accelerations (columns) seen from the link side,
    /// shape `(nv, nv)` [kg m², kg m, kg]; zero in columns of joints without an elastic transmission.
    ///
    /// Parameters
    /// ----------
    /// q
    ///     Joint positions, shape `(nq,)` [rad or m].
    /// model
    ///     Which physics of the motors; the coupling is zero in all but the complete one.
    #[pyo3(signature = (q, *, model=None, out=None))]
    fn coupling_matrix<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        model: Option<&str>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let single = || {
            self.with(model, |w| {
                self.layout.or_batch().positions(q, &mut w.q)?;
                w.dynamics.coupling(&w.q, &mut w.matrix).map_err(errors::raise)?;
                Ok(matrix(py, "coupling matrix", &w.matrix, self.layout.nv)?.into_any())
            })
        };
        let arguments = [("q", Some(q), Need::Always)];
        self.evaluate(py, &Algorithm::CouplingMatrix, model, &arguments, out, single)
    }

    /// Blocks of the Coriolis matrix in Christoffel form, `[C, C1; C2, 0]` over joints and motors.
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)`, and velocities, shape `(nv,)` [rad or m, per s].
    /// thetad
    ///     Motor velocities seen from the link side, shape `(nv,)`. Needed if the model has elastic joints.
    /// model
    ///     Which physics of the motors.
    ///
    /// Returns
    /// -------
    /// (C, C1, C2)
    ///     Links by links, links by motors, motors by links, shape `(nv, nv)` [kg m²/s]; with the rate of the whole inertia matrix
    ///     they are skew: `d/dt [M, S; Sᵀ, B] = [C, C1; C2, 0] + [C, C1; C2, 0]ᵀ`.
    #[pyo3(signature = (q, qd, thetad=None, *, model=None, out=None))]
    fn coriolis_matrices<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        thetad: Option<&Bound<'py, PyAny>>,
        model: Option<&str>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let nv = self.layout.nv;
        let single = || {
            self.with(model, |w| {
                self.layout.or_batch().motion(w, q, qd, thetad)?;
                let [mut c, mut c1, mut c2] = [(); 3].map(|()| vec![0.0; nv * nv]);
                let Workspace { dynamics, q, qd, theta, thetad, .. } = w;
                let out = CoriolisMatrices { c: &mut c, c1: &mut c1, c2: &mut c2 };
                dynamics.coriolis_matrices(State { q, qd, theta, thetad }, out).map_err(errors::raise)?;
                Ok((matrix(py, "C", &c, nv)?, matrix(py, "C1", &c1, nv)?, matrix(py, "C2", &c2, nv)?)
                    .into_pyobject(py)?
                    .into_any())
            })
        };
        let arguments =
            [("q", Some(q), Need::Always), ("qd", Some(qd), Need::Always), ("thetad", thetad, Need::Elastic)];
        self.evaluate(py, &Algorithm::CoriolisMatrices, model, &arguments, out, single)
    }

    /// Time derivatives of inertia matrix and coupling along a motion.
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)`, and velocities, shape `(nv,)` [rad or m, per s].
    /// model
    ///     Which physics of the motors.
    ///
    /// Returns
    /// -------
    /// (dM, dS)
    ///     Shape `(nv, nv)` [kg m²/s].
    #[pyo3(signature = (q, qd, *, model=None, out=None))]
    fn inertia_rates<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        model: Option<&str>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let nv = self.layout.nv;
        let single = || {
            self.with(model, |w| {
                self.layout.or_batch().positions(q, &mut w.q)?;
                self.layout.or_batch().velocities("qd", qd, &mut w.qd)?;
                w.theta.fill(0.0);
                w.thetad.fill(0.0);
                let [mut m, mut s] = [(); 2].map(|()| vec![0.0; nv * nv]);
                let Workspace { dynamics, q, qd, theta, thetad, .. } = w;
                let out = InertiaRates { m: &mut m, s: &mut s };
                dynamics.inertia_rates(State { q, qd, theta, thetad }, out).map_err(errors::raise)?;
                Ok((matrix(py, "dM", &m, nv)?, matrix(py, "dS", &s, nv)?).into_pyobject(py)?.into_any())
            })
        };
        let arguments = [("q", Some(q), Need::Always), ("qd", Some(qd), Need::Always)];
        self.evaluate(py, &Algorithm::InertiaRates, model, &arguments, out, single)
    }

    /// What a motion without accelerations asks for, beside friction, springs and loads.
    ///
    /// Parameters
    /// ----------
    /// q, qd
    ///     Joint positions, shape `(nq,)`, and velocities, shape `(nv,)` [rad or m, per s].
    /// thetad
    ///     Motor velocities seen from the link side, shape `(nv,)`. Needed if the model has elastic joints.
    /// model
    ///     Which physics of the motors.
    ///
    /// Returns
    /// -------
    /// (link, motor)
    ///     `C q̇ + C₁ θ̇ + g` and `C₂ q̇`, shape `(nv,)` [N m or N].
    #[pyo3(signature = (q, qd, thetad=None, *, model=None, out=None))]
    fn bias<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        qd: &Bound<'py, PyAny>,
        thetad: Option<&Bound<'py, PyAny>>,
        model: Option<&str>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let single = || {
            self.with(model, |w| {
                self.layout.or_batch().motion(w, q, qd, thetad)?;
                let Workspace { dynamics, q, qd, theta, thetad, out: [link, motor, _], .. } = w;
                dynamics.bias(State { q, qd, theta, thetad }, Bias { link, motor }).map_err(errors::raise)?;
                Ok((vector(py, "link", link)?, vector(py, "motor", motor)?).into_pyobject(py)?.into_any())
            })
        };
        let arguments =
            [("q", Some(q), Need::Always), ("qd", Some(qd), Need::Always), ("thetad", thetad, Need::Elastic)];
        self.evaluate(py, &Algorithm::Bias, model, &arguments, out, single)
    }

    /// Generalised forces that hold the links against gravity, shape `(nv,)` [N m or N].
    ///
    /// Parameters
    /// ----------
    /// q
    ///     Joint positions, shape `(nq,)` [rad or m].
    #[pyo3(signature = (q, *, out=None))]
    fn gravity_torques<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let single = || {
            self.with(None, |w| {
                self.layout.or_batch().positions(q, &mut w.q)?;
                let Workspace { dynamics, q, out: [g, ..], .. } = w;
                dynamics.gravity_torques(q, g).map_err(errors::raise)?;
                Ok(vector(py, "gravity torques", g)?.into_any())
            })
        };
        let arguments = [("q", Some(q), Need::Always)];
        self.evaluate(py, &Algorithm::GravityTorques, None, &arguments, out, single)
    }
}
