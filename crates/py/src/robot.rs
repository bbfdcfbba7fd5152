//! `gyroflex.Robot`: the calculator of one robot.

use crate::arguments::{self, Layout};
use crate::arrays::{Vector, matrix, vector};
use crate::batch::{Need, motion_arguments, torque_arguments};
use crate::drive::Origin;
use crate::errors;
use crate::inverse::Inverses;
use crate::overrides::overrides;
use crate::workspace::{Pool, Workspace};
use gyroflex::dynamics::{Acceleration, External, Forward, Inverse, State};
use gyroflex_sim::Robot;
use gyroflex_sim::batch::Algorithm;
use gyroflex_sim::link_frame::LinkFrame;
use gyroflex_sim::load::LoadOptions;
use gyroflex_sim::load::nearest::nearest;
use gyroflex_sim::robot::Link;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyMapping;
use std::path::PathBuf;

/// A robot with its drives, loaded from files. It never changes, and any number of threads may use it at once.
///
/// Arrays run over all joints in coordinate order (`joint_names`). With a floating root `q` leads with its position in the
/// world and its unit quaternion `x y z qx qy qz qw`, and every array over the velocities with six entries of the root, in
/// its own frame, angular first; `theta`, `thetad`, `thetadd`, `tau` and `tau_ext` may also be given without those six.
///
/// `theta` is the motor position seen through the gear, `q` plus the deflection of the transmission [rad or m]; `tau` the
/// motor torque seen through the gear [N m or N]. Entries of joints without an elastic transmission are ignored in `theta`,
/// `thetad` and `thetadd`: there the motor turns with the joint.
///
/// Where links bend (`flexible_links`), arrays over the joints go on with the modes (`mode_names`), and may be given without them:
/// those are zero then. A mode has no motor: its entries of `theta`, `thetad` and `thetadd` are ignored, its entry of `tau` is a
/// generalised force.
///
/// Where a method takes `out`, its arrays may also be of shape `(batch, n)`, any of them, and the results lead with that axis: the states
/// are computed side by side in lanes and on all cores (`RAYON_NUM_THREADS` limits them), with the interpreter released, and agree with
/// single calls to rounding. If all arrays are float32, so are the computation and the results; otherwise float64. `out` is an array, or a
/// tuple of them in C order, that takes the results; after an error it holds anything. Derivatives, the regressor and what has to do with
/// constraints come in float64, row by row; so is everything of robots whose links bend computed.
///
/// `model` is one of `complete`, `reduced`, `rigid`, `rigid_reflected`; the default is the one of the robot's file.
#[pyclass(name = "Robot", module = "gyroflex", frozen)]
pub(crate) struct PyRobot {
    pub(crate) robot: Robot,
    pool: Pool,
    pub(crate) inverses: Inverses,
    pub(crate) layout: Layout,
    pub(crate) origin: Origin,
    /// How it was read.
    pub(crate) options: LoadOptions,
}

#[pymethods]
impl PyRobot {
    /// Loads a robot YAML or a URDF.
    ///
    /// Parameters
    /// ----------
    /// path
    ///     The file.
    /// floating
    ///     Whether the root link moves freely instead of being fixed to the world.
    /// model
    ///     The model used unless a call says otherwise, instead of the one the file names.
    /// mimic
    ///     What to do with joints that mimic another one, instead of what the file says: `refuse` the robot, or let them
    ///     move on their own, `independent` of the other.
    /// set
    ///     Other values of keys of the robot's YAML, such as `{"drives.joint2.transmission.stiffness": 1e4}`: anything that could
    ///     be written there.
    ///
    /// What of the file was ignored or assumed is issued as `RobotWarning` and kept in `warnings`.
    #[staticmethod]
    #[pyo3(signature = (path, *, floating=false, model=None, mimic=None, set=None))]
    fn load(
        py: Python<'_>,
        path: PathBuf,
        floating: bool,
        model: Option<&str>,
        mimic: Option<&str>,
        set: Option<&Bound<'_, PyMapping>>,
    ) -> PyResult<Self> {
        let model = model.map(arguments::fidelity).transpose()?;
        let mimic = mimic.map(arguments::mimic).transpose()?;
        let options = LoadOptions { floating, model, mimic, overrides: overrides(set)?, ..LoadOptions::default() };
        Origin::File(path).read(py, options)
    }

    /// The robot's name.
    #[getter]
    fn name(&self) -> &str {
        &self.robot.name
    }

    /// Names of the joints of one degree of freedom, in coordinate order: all but a floating root.
    #[getter]
    pub(crate) fn joint_names(&self) -> Vec<&str> {
        self.joints().map(|j| j.name.as_str()).collect()
    }

    /// Names of the modes of links that bend. Their coordinates follow those of the joints in every array.
    #[getter]
    fn mode_names(&self) -> Vec<String> {
        self.robot.mode_names()
    }

    /// Names of all links of the URDF, those fused by fixed joints included.
    #[getter]
    fn link_names(&self) -> Vec<&str> {
        self.robot.links.iter().map(|l| l.name.as_str()).collect()
    }

    /// Number of entries of `q`.
    #[getter]
    fn nq(&self) -> usize {
        self.layout.nq
    }

    /// Number of entries of `qd` and of every other array over joints and modes.
    #[getter]
    fn nv(&self) -> usize {
        self.layout.nv
    }

    /// Whether the root moves freely.
    #[getter]
    fn floating(&self) -> bool {
        self.layout.floating
    }

    /// Acceleration of gravity in world axes, shape `(3,)` [m/s²].
    #[getter]
    fn gravity<'py>(&self, py: Python<'py>) -> Vector<'py> {
        PyArray1::from_slice(py, &self.robot.gravity.to_array())
    }

    /// The model used unless a call says otherwise.
    #[getter]
    fn model(&self) -> &'static str {
        self.robot.fidelity.name()
    }

    /// What of the robot's files was ignored or assumed.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.robot.warnings.iter().map(ToString::to_string).collect()
    }

    /// Accelerations of links and motors.
    ///
    /// Parameters
    /// ----------
    /// q
    ///     Joint positions, shape `(nq,)` [rad or m].
    /// qd
    ///     Joint velocities, shape `(nv,)` [rad/s or m/s].
    /// theta, thetad
    ///     Motor positions and velocities seen from the link side, shape `(nv,)`. Needed if the model has elastic joints.
    /// tau
    ///     Motor torques seen from the link side, shape `(nv,)` [N m or N]; at joints without a drive they act on the joint.
    ///     The six entries of a floating root are a wrench on it, in its own frame.
    /// model
    ///     Which physics of the motors.
    /// tau_ext
    ///     Further generalised forces on the link side of the joints, shape `(nv,)` [N m or N].
    ///
    /// Returns
    /// -------
    /// (qdd, thetadd)
    ///     Accelerations of joints and motors, shape `(nv,)` [rad/s² or m/s²]; `thetadd` is seen from the link side and
    ///     equals `qdd` at joints without an elastic transmission.
    #[pyo3(signature = (q, qd, theta=None, thetad=None, tau=None, *, model=None, tau_ext=None, out=None))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn forward_dynamics<'py>(
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
        let single = || {
            self.with(model, |w| {
                let layout = self.layout.or_batch();
                layout.state(w, q, qd, theta, thetad)?;
                let Some(tau) = tau else {
                    return Err(errors::missing_torques("tau"));
                };
                layout.forces("tau", tau, &mut w.tau)?;
                let Workspace { dynamics, q, qd, theta, thetad, tau, tau_ext: room, out, .. } = w;
                let ext = External { tau: layout.load(tau_ext, room)?, wrenches: &[] };
                let [qdd, thetadd, tau_j] = out;
                dynamics
                    .forward(State { q, qd, theta, thetad }, tau, ext, Forward { qdd, thetadd, tau_j })
                    .map_err(errors::raise)?;
                Ok((vector(py, "qdd", qdd)?, vector(py, "thetadd", thetadd)?).into_pyobject(py)?.into_any())
            })
        };
        let arguments = torque_arguments([q, qd], [theta, thetad, tau, tau_ext]);
        self.evaluate(py, &Algorithm::ForwardDynamics, model, &arguments, out, single)
    }

    /// Torques that a motion asks for.
    ///
    /// Parameters
    /// ----------
    /// q, qd, qdd
    ///     Joint positions, shape `(nq,)`, velocities and accelerations, shape `(nv,)` [rad or m, per s, per s²].
    /// theta, thetad, thetadd
    ///     The same of the motors, seen from the link side, shape `(nv,)`. Needed if the model has elastic joints.
    /// model
    ///     Which physics of the motors.
    /// tau_ext
    ///     Generalised forces on the link side of the joints that help, shape `(nv,)` [N m or N].
    ///
    /// Returns
    /// -------
    /// (tau_j, tau)
    ///     What the transmissions must exert on the joints, and what the motors must exert, seen from the link side; shape
    ///     `(nv,)` [N m or N]. `tau` is `tau_j` plus rotor inertia, gyroscopic coupling and friction on the motor side.
    #[pyo3(signature = (q, qd, qdd, theta=None, thetad=None, thetadd=None, *, model=None, tau_ext=None, out=None))]
    #[expect(clippy::too_many_arguments, reason = "they are the quantities of the equation of motion")]
    fn inverse_dynamics<'py>(
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
        let single = || {
            self.with(model, |w| {
                let layout = self.layout.or_batch();
                layout.state(w, q, qd, theta, thetad)?;
                layout.velocities("qdd", qdd, &mut w.qdd)?;
                layout.motors("thetadd", thetadd, w.elastic, &mut w.thetadd)?;
                let Workspace { dynamics, q, qd, theta, thetad, qdd, thetadd, tau_ext: room, out, .. } = w;
                let ext = External { tau: layout.load(tau_ext, room)?, wrenches: &[] };
                let [tau_j, tau, _] = out;
                dynamics
                    .inverse(State { q, qd, theta, thetad }, Acceleration { qdd, thetadd }, ext, Inverse { tau_j, tau })
                    .map_err(errors::raise)?;
                Ok((vector(py, "tau_j", tau_j)?, vector(py, "tau", tau)?).into_pyobject(py)?.into_any())
            })
        };
        let arguments = motion_arguments([q, qd, qdd], [theta, thetad, thetadd], tau_ext);
        self.evaluate(py, &Algorithm::InverseDynamics, model, &arguments, out, single)
    }

    /// Pose of a link in the world, shape `(4, 4)`: rotation from the link's axes to the world's, position of its origin [m].
    ///
    /// Parameters
    /// ----------
    /// frame
    ///     Name of a link of the URDF, moving, fused or fixed.
    /// q
    ///     Joint positions, shape `(nq,)` [rad or m].
    #[pyo3(signature = (frame, q, *, out=None))]
    fn placement<'py>(
        &self,
        py: Python<'py>,
        frame: &str,
        q: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let frame = self.frame(frame)?;
        let single = || {
            self.with(None, |w| {
                self.layout.or_batch().positions(q, &mut w.q)?;
                w.dynamics.placements(&w.q, &mut w.poses).map_err(errors::raise)?;
                let pose = frame.pose(&w.poses, w.dynamics.eta(&w.q));
                let [x, y, z] = pose.rotation().rows.map(|row| row.to_array());
                let p = pose.pos.to_array();
                let rows = [x, y, z].into_iter().zip(p).flat_map(|(r, p)| [r[0], r[1], r[2], p]);
                let numbers: Vec<f64> = rows.chain([0.0, 0.0, 0.0, 1.0]).collect();
                Ok(matrix(py, "placement", &numbers, 4)?.into_any())
            })
        };
        let arguments = [("q", Some(q), Need::Always)];
        self.evaluate(py, &Algorithm::Placement(frame.clone()), None, &arguments, out, single)
    }

    fn __repr__(&self) -> String {
        let floating = if self.floating() { ", floating root" } else { "" };
        format!("<Robot {:?}: {} joints{floating}, model {:?}>", self.robot.name, self.joints().count(), self.model())
    }
}

impl PyRobot {
    pub(crate) fn new(py: Python<'_>, robot: Robot, origin: Origin, options: LoadOptions) -> PyResult<Self> {
        let lowered = robot.model(robot.fidelity).map_err(errors::raise)?;
        let (nq, nv, modes) = (lowered.nq(), lowered.nv(), robot.flexible.modes());
        let layout = Layout { nq, nv, modes, floating: robot.is_floating(), several: None };
        errors::warn(py, &robot.warnings)?;
        Ok(Self { robot, pool: Pool::default(), inverses: Inverses::default(), layout, origin, options })
    }

    fn joints(&self) -> impl Iterator<Item = &gyroflex_sim::robot::Joint> {
        self.robot.joints.iter().skip(usize::from(self.floating()))
    }

    /// The link of that name.
    pub(crate) fn link(&self, argument: &str, name: &str) -> PyResult<&Link> {
        let links = &self.robot.links;
        links.iter().find(|l| l.name == name).ok_or_else(|| {
            let near = nearest(name, links.iter().map(|l| l.name.as_str())).unwrap_or_default();
            let problem = format!("the robot has no link `{name}`");
            errors::argument(argument, problem, format!("the nearest known one is `{near}`"))
        })
    }

    /// The frame of the link of that name.
    pub(crate) fn frame(&self, name: &str) -> PyResult<LinkFrame> {
        self.link("frame", name)?;
        let index = self.robot.links.iter().position(|l| l.name == name);
        Ok(LinkFrame::new(&self.robot, index.unwrap_or_default()))
    }

    pub(crate) fn with<R>(&self, model: Option<&str>, call: impl FnOnce(&mut Workspace) -> PyResult<R>) -> PyResult<R> {
        let fidelity = model.map_or(Ok(self.robot.fidelity), arguments::fidelity)?;
        self.pool.with(&self.robot, fidelity, call)
    }
}
