//! The drives of a robot, and copies of a robot with other numbers.

use crate::arguments;
use crate::overrides::{self, overrides};
use crate::robot::PyRobot;
use crate::{errors, named};
use gyroflex::model::{DriveSpec, SpringSpec, TransmissionSpec};
use gyroflex_sim::load::{LoadOptions, URDF_TEXT, YAML_TEXT, load, load_named_texts};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use std::path::PathBuf;

/// Where a robot was read from.
#[derive(Clone, Debug)]
pub(crate) enum Origin {
    File(PathBuf),
    /// What the URDF is called, its text, and the drives YAML, if any.
    Text(String, String, Option<String>),
}

impl Origin {
    /// Reads the robot, with the interpreter released.
    pub(crate) fn read(self, py: Python<'_>, options: LoadOptions) -> PyResult<PyRobot> {
        let robot = py.detach(|| match &self {
            Self::File(path) => load(path, &options),
            Self::Text(name, urdf, drives) => {
                let yaml = if drives.is_some() { YAML_TEXT } else { "the keys given" };
                load_named_texts((name, urdf), (yaml, drives.as_deref()), &options)
            }
        });
        PyRobot::new(py, robot.map_err(errors::raise)?, self, options)
    }
}

/// The argument `drives`.
#[derive(FromPyObject)]
enum Drives<'py> {
    #[pyo3(transparent, annotation = "str")]
    Yaml(String),
    #[pyo3(transparent, annotation = "Mapping")]
    ByJoint(Bound<'py, PyMapping>),
}

/// The motor of a joint with its gear and transmission.
#[pyclass(name = "Drive", module = "gyroflex", frozen)]
#[derive(Clone, Copy)]
pub(crate) struct PyDrive(DriveSpec);

#[pymethods]
impl PyDrive {
    /// Inertia of the rotor about its spin axis, motor side [kg m²].
    #[getter]
    fn rotor_inertia(&self) -> f64 {
        self.0.rotor.inertia
    }

    /// Rotor turns per joint turn, or rotor radians per metre.
    #[getter]
    fn ratio(&self) -> f64 {
        self.0.gear_ratio
    }

    /// Stiffness of the transmission without deflection, link side [N m/rad or N/m]; `None` of a rigid one, or one given by a table.
    #[getter]
    fn stiffness(&self) -> Option<f64> {
        match self.0.transmission {
            TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, .. }, .. } => Some(stiffness),
            _ => None,
        }
    }

    /// Damping of the transmission, link side [N m s/rad or N s/m]; `None` of a rigid one.
    #[getter]
    fn damping(&self) -> Option<f64> {
        match self.0.transmission {
            TransmissionSpec::Elastic { damping, .. } => Some(damping),
            TransmissionSpec::Rigid => None,
        }
    }

    /// Friction on the motor side: `viscous` [N m s/rad], `coulomb` [N m] and `smoothing_velocity` [rad/s].
    #[getter]
    fn friction<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let friction = PyDict::new(py);
        friction.set_item("viscous", self.0.friction.viscous)?;
        friction.set_item("coulomb", self.0.friction.coulomb)?;
        friction.set_item("smoothing_velocity", self.0.friction.smoothing_velocity)?;
        Ok(friction)
    }

    fn __repr__(&self) -> String {
        let rigid = |x: Option<f64>| x.map_or_else(|| "None".to_owned(), |x| x.to_string());
        let (stiffness, damping) = (rigid(self.stiffness()), rigid(self.damping()));
        let (ratio, inertia) = (self.ratio(), self.rotor_inertia());
        format!("<Drive: ratio {ratio}, rotor_inertia {inertia}, stiffness {stiffness}, damping {damping}>")
    }
}

#[pymethods]
impl PyRobot {
    /// The drives by the names of their joints.
    #[getter]
    fn drives<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let drives = PyDict::new(py);
        for (joint, body) in self.robot.joints.iter().zip(&self.robot.bodies) {
            if let Some(drive) = body.drive {
                drives.set_item(&joint.name, PyDrive(drive))?;
            }
        }
        Ok(drives)
    }

    /// Makes a robot from a URDF.
    ///
    /// Parameters
    /// ----------
    /// urdf
    ///     The URDF, or the path of its file.
    /// drives
    ///     The drives by the names of their joints, as `drives` of a robot's YAML; or the text of such a YAML, whose `urdf` is not
    ///     followed.
    /// floating, model, set
    ///     As those of `load`.
    #[staticmethod]
    #[pyo3(signature = (urdf, drives=None, *, floating=false, model=None, set=None))]
    fn from_urdf(
        py: Python<'_>,
        urdf: PathBuf,
        drives: Option<Drives<'_>>,
        floating: bool,
        model: Option<&str>,
        set: Option<&Bound<'_, PyMapping>>,
    ) -> PyResult<Self> {
        let model = model.map(arguments::fidelity).transpose()?;
        let mut options = LoadOptions { floating, model, ..LoadOptions::default() };
        let yaml = match drives {
            Some(Drives::Yaml(text)) => Some(text),
            Some(Drives::ByJoint(drives)) => {
                options.overrides = overrides::one("drives", &drives)?;
                None
            }
            None => None,
        };
        options.overrides.extend(&overrides(set)?);
        let origin = match urdf.to_str() {
            Some(text) if text.contains('<') => Origin::Text(URDF_TEXT.to_owned(), text.to_owned(), yaml),
            _ if yaml.is_none() => Origin::File(urdf),
            _ => {
                let text = std::fs::read_to_string(&urdf);
                let refuse = |e: std::io::Error| errors::file(&urdf, format!("cannot be read: {e}"), "check the path");
                let name = urdf.file_name().unwrap_or(urdf.as_os_str()).to_string_lossy().into_owned();
                Origin::Text(name, text.map_err(refuse)?, yaml)
            }
        };
        origin.read(py, options)
    }

    /// Makes a robot from links, joints and drives given one by one.
    ///
    /// Parameters
    /// ----------
    /// builder
    ///     A `RobotBuilder`.
    /// floating, model, set
    ///     As those of `load`.
    #[staticmethod]
    #[pyo3(signature = (builder, *, floating=false, model=None, set=None))]
    fn from_builder<'py>(
        py: Python<'py>,
        builder: &Bound<'py, PyAny>,
        floating: bool,
        model: Option<&str>,
        set: Option<&Bound<'py, PyMapping>>,
    ) -> PyResult<Self> {
        let class = py.import("gyroflex.builder")?.getattr("RobotBuilder")?;
        if !builder.is_instance(&class)? {
            let problem = format!("it is of type `{}`", builder.get_type().name()?);
            return Err(errors::argument("builder", problem, "give a `RobotBuilder`"));
        }
        let urdf = builder.call_method0("urdf")?.extract()?;
        let drives = builder.getattr("drives")?.cast_into::<PyMapping>()?;
        Self::from_urdf(py, urdf, Some(Drives::ByJoint(drives)), floating, model, set)
    }

    /// A copy of the robot with other numbers, read from its files again and validated as they are.
    ///
    /// Parameters
    /// ----------
    /// stiffness, damping
    ///     Of transmissions by the names of their joints, link side [N m/rad or N/m, N m s/rad or N s/m].
    /// ratio
    ///     Gear ratios by the names of the joints: rotor turns per joint turn.
    /// rotor_inertia
    ///     Inertias of rotors about their spin axes by the names of the joints, motor side [kg m²].
    /// friction
    ///     Friction by the names of the joints, as in the robot's YAML: `{"joint2": {"motor": {"coulomb": 0.1}}}`.
    /// model
    ///     The model used unless a call says otherwise.
    /// gravity
    ///     Acceleration of gravity in world axes, three numbers [m/s²].
    /// payload
    ///     A load on a link, as in the robot's YAML: `{"link": "tool", "mass": 2.0}`.
    /// set
    ///     Values of any other keys of the robot's YAML.
    #[pyo3(signature = (*, stiffness=None, damping=None, ratio=None, rotor_inertia=None, friction=None, model=None, gravity=None, payload=None, set=None))]
    #[expect(clippy::too_many_arguments, reason = "all of them may be left out")]
    fn with_<'py>(
        &self,
        py: Python<'py>,
        stiffness: Option<&Bound<'py, PyMapping>>,
        damping: Option<&Bound<'py, PyMapping>>,
        ratio: Option<&Bound<'py, PyMapping>>,
        rotor_inertia: Option<&Bound<'py, PyMapping>>,
        friction: Option<&Bound<'py, PyMapping>>,
        model: Option<&str>,
        #[pyo3(from_py_with = named::gravity)] gravity: Option<[f64; 3]>,
        payload: Option<&Bound<'py, PyMapping>>,
        set: Option<&Bound<'py, PyMapping>>,
    ) -> PyResult<Self> {
        let mut options = self.options.clone();
        // What was given beside the file becomes a key of it, so that the last word counts.
        let model = model.map(arguments::fidelity).transpose()?;
        if let Some(model) = model.or(options.model.take()) {
            options.overrides.set("model", model.name());
        }
        if let Some(gravity) = gravity.or(options.gravity.take()) {
            options.overrides.set("gravity", gravity.to_vec());
        }
        let by_joint = [
            ("stiffness", "transmission.stiffness", stiffness),
            ("damping", "transmission.damping", damping),
            ("ratio", "gear_ratio", ratio),
            ("rotor_inertia", "rotor.inertia", rotor_inertia),
            ("friction", "friction", friction),
        ];
        for (argument, key, values) in by_joint {
            if let Some(values) = values {
                options.overrides.extend(&overrides::by_joint(argument, key, values)?);
            }
        }
        if let Some(payload) = payload {
            options.overrides.extend(&overrides::one("payload", payload)?);
        }
        options.overrides.extend(&overrides(set)?);
        self.origin.clone().read(py, options)
    }
}
