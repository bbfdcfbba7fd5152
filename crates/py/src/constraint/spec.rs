//! `gyroflex.Constraint`: what is held, by the names of links and joints.

use crate::arguments::choice;
use crate::arrays::read_rows;
use crate::errors;
use crate::named;
use crate::operational::direction;
use crate::robot::PyRobot;
use gyroflex::dynamics::{Anchor, Constraint, Contact, Directions, Frame, Hold};
use gyroflex::spatial::{Mat3, Transform, Vec3};
use gyroflex_sim::Robot;
use gyroflex_sim::load::nearest::nearest;
use gyroflex_sim::robot::HeldPart;
use pyo3::prelude::*;

/// How far the axes of a pose may be from a rotation.
const ROTATION: f64 = 1e-6;
const SETS: &str = "give `all`, `point`, or a list of directions out of rx, ry, rz, x, y, z";

/// Something held: made by `Constraint.frame` or `Constraint.joints`, for any robot that has links and joints of these names.
#[pyclass(name = "Constraint", module = "gyroflex", frozen)]
#[derive(Clone, Debug)]
pub(crate) struct PyConstraint {
    hold: Named,
    stabilisation: f64,
    contact: Option<Contact<f64>>,
}

#[derive(Clone, Debug)]
enum Named {
    Frame {
        link: String,
        /// Pose in that link's frame.
        placement: Transform<f64>,
        to: Option<String>,
        /// Pose in the frame of `to`, or in the world.
        at: Transform<f64>,
        directions: Directions,
    },
    Joints {
        joint: String,
        follows: String,
        ratio: f64,
        offset: f64,
    },
}

#[pymethods]
impl PyConstraint {
    /// Holds a frame of a link to a frame of the world or of another link, in whose axes the directions are.
    ///
    /// Parameters
    /// ----------
    /// link
    ///     Name of a moving link.
    /// xyz, rpy
    ///     Origin [m] and roll, pitch, yaw [rad] of the frame in that link's.
    /// to
    ///     Name of the link it is held to; by default the world.
    /// at_xyz, at_rpy
    ///     Origin [m] and roll, pitch, yaw [rad] of the frame it is held at, in the link `to` or in the world.
    /// at
    ///     The same as a pose, shape `(4, 4)`, as `Robot.placement` returns it, instead.
    /// directions
    ///     `all`, `point` for `x`, `y`, `z`, or a list out of `rx`, `ry`, `rz`, `x`, `y`, `z`. Multipliers stand in the order of this list of six.
    /// stabilisation
    ///     How fast errors of position and velocity are drawn back, critically damped [rad/s]; 0 leaves them.
    /// contact
    ///     The direction `x`, `y` or `z` along which the link can be pushed, but not pulled. Forward dynamics only reports the sign; impacts
    ///     can release it.
    /// restitution
    ///     Of a contact: speed of separation over speed of approach in an impact, 0 to 1.
    /// slip
    ///     Of a contact that slips: force along `x`, `y`, `z` for every newton of normal force, `−μ v/|v|`; by default it sticks.
    #[staticmethod]
    #[pyo3(signature = (link, *, xyz=[0.0; 3], rpy=[0.0; 3], to=None, at_xyz=None, at_rpy=None, at=None, directions=None, stabilisation=0.0, contact=None, restitution=0.0, slip=None),
           text_signature = "(link, *, xyz=(0.0, 0.0, 0.0), rpy=(0.0, 0.0, 0.0), to=None, at_xyz=None, at_rpy=None, at=None, directions=None, stabilisation=0.0, contact=None, restitution=0.0, slip=None)")]
    #[expect(clippy::too_many_arguments, reason = "most of them may be left out")]
    fn frame(
        link: String,
        #[pyo3(from_py_with = named::xyz)] xyz: [f64; 3],
        #[pyo3(from_py_with = named::rpy)] rpy: [f64; 3],
        to: Option<String>,
        #[pyo3(from_py_with = named::at_xyz)] at_xyz: Option<[f64; 3]>,
        #[pyo3(from_py_with = named::at_rpy)] at_rpy: Option<[f64; 3]>,
        at: Option<&Bound<'_, PyAny>>,
        directions: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = named::stabilisation)] stabilisation: f64,
        contact: Option<&str>,
        #[pyo3(from_py_with = named::restitution)] restitution: f64,
        #[pyo3(from_py_with = named::slip)] slip: Option<[f64; 3]>,
    ) -> PyResult<Self> {
        let directions = set_of(directions)?;
        let at = match at {
            None => pose(("at_xyz", at_xyz.unwrap_or_default()), ("at_rpy", at_rpy.unwrap_or_default()))?,
            Some(_) if at_xyz.is_some() || at_rpy.is_some() => {
                return Err(errors::argument("at", "it is given twice", "give `at`, or `at_xyz` and `at_rpy`"));
            }
            Some(at) => matrix_pose(at)?,
        };
        let hold = Named::Frame { link, placement: pose(("xyz", xyz), ("rpy", rpy))?, to, at, directions };
        let contact = contact.map(|name| pushed(name, directions, restitution, slip)).transpose()?;
        if contact.is_none() && (restitution != 0.0 || slip.is_some()) {
            let problem = "`restitution` or `slip` is given of something that is no contact";
            return Err(errors::argument("contact", problem, "name the direction along which it is pushed, as `z`"));
        }
        Ok(Self { hold, stabilisation: rate(stabilisation)?, contact })
    }

    /// Lets a joint follow another one: `q = ratio q_follows + offset`.
    ///
    /// Parameters
    /// ----------
    /// joint, follows
    ///     Names of two joints.
    /// ratio, offset
    ///     `ratio`, and `offset` [rad or m].
    /// stabilisation
    ///     How fast errors of position and velocity are drawn back, critically damped [rad/s]; 0 leaves them.
    #[staticmethod]
    #[pyo3(signature = (joint, follows, *, ratio=1.0, offset=0.0, stabilisation=0.0))]
    fn joints(
        joint: String,
        follows: String,
        #[pyo3(from_py_with = named::ratio)] ratio: f64,
        #[pyo3(from_py_with = named::offset)] offset: f64,
        #[pyo3(from_py_with = named::stabilisation)] stabilisation: f64,
    ) -> PyResult<Self> {
        if joint == follows {
            let remedy = "name the joint that it follows";
            return Err(errors::argument("follows", format!("the joint `{joint}` follows itself"), remedy));
        }
        finite("ratio", &[ratio])?;
        finite("offset", &[offset])?;
        let hold = Named::Joints { joint, follows, ratio, offset };
        Ok(Self { hold, stabilisation: rate(stabilisation)?, contact: None })
    }

    /// How many directions it constrains: as many multipliers it has.
    #[getter]
    fn rows(&self) -> usize {
        match &self.hold {
            Named::Frame { directions, .. } => directions.count(),
            Named::Joints { .. } => 1,
        }
    }

    fn __repr__(&self) -> String {
        match &self.hold {
            Named::Frame { link, to, .. } => {
                let to = to.as_ref().map_or("the world".to_owned(), |to| format!("{to:?}"));
                let kind = if self.contact.is_some() { ", a contact" } else { "" };
                format!("<Constraint: link {link:?} to {to}, {} directions{kind}>", self.rows())
            }
            Named::Joints { joint, follows, ratio, offset } => {
                format!("<Constraint: joint {joint:?} = {ratio} {follows:?} + {offset}>")
            }
        }
    }
}

impl PyConstraint {
    /// What a robot's file holds, by names again: a body is named by the link that its joint moves.
    pub(super) fn of_part(robot: &Robot, part: &HeldPart) -> Self {
        let link = |body: usize| robot.joints[body].child_link.clone();
        let hold = match part.hold {
            Hold::Frame { frame, anchor, directions } => Named::Frame {
                link: link(frame.body),
                placement: frame.placement,
                to: anchor.body.map(link),
                at: anchor.placement,
                directions,
            },
            Hold::Joints { joint, follows, ratio, offset } => {
                let [joint, follows] = [joint, follows].map(|i| robot.joints[i].name.clone());
                Named::Joints { joint, follows, ratio, offset }
            }
        };
        Self { hold, stabilisation: part.stabilisation, contact: None }
    }

    /// The constraint on this robot.
    pub(super) fn resolve(&self, robot: &PyRobot) -> PyResult<Constraint<f64>> {
        let hold = match &self.hold {
            Named::Frame { link, placement, to, at, directions } => {
                let on = robot.link("link", link)?;
                let Some(body) = on.body else {
                    let remedy = "name a moving link; what is held to it is given by `to`";
                    return Err(errors::argument("link", format!("the link `{link}` does not move"), remedy));
                };
                let frame = Frame { body, placement: placement.after(on.placement) };
                let anchor = match to.as_ref().map(|to| robot.link("to", to)).transpose()? {
                    None => Anchor { body: None, placement: *at },
                    Some(to) => Anchor { body: to.body, placement: at.after(to.placement) },
                };
                if anchor.body == Some(body) {
                    let problem = format!("the link `{link}` is held to a link that it is one body with");
                    return Err(errors::argument("to", problem, "name a link of another body, or none for the world"));
                }
                Hold::Frame { frame, anchor, directions: *directions }
            }
            Named::Joints { joint, follows, ratio, offset } => Hold::Joints {
                joint: body_of("joint", joint, robot)?,
                follows: body_of("follows", follows, robot)?,
                ratio: *ratio,
                offset: *offset,
            },
        };
        Ok(Constraint { hold, stabilisation: self.stabilisation, contact: self.contact })
    }
}

/// Index of the body that a joint moves; joints and bodies stand in the same order.
fn body_of(argument: &str, name: &str, robot: &PyRobot) -> PyResult<usize> {
    let all = robot.robot.joints.iter().enumerate().skip(usize::from(robot.layout.floating));
    all.clone().find(|(_, joint)| joint.name == name).map(|(body, _)| body).ok_or_else(|| {
        let near = nearest(name, all.map(|(_, joint)| joint.name.as_str())).unwrap_or_default();
        let remedy = format!("the nearest known one is `{near}`");
        errors::argument(argument, format!("the robot has no joint `{name}` of one degree of freedom"), remedy)
    })
}

fn set_of(value: Option<&Bound<'_, PyAny>>) -> PyResult<Directions> {
    let Some(value) = value else { return Ok(Directions::ALL) };
    if let Ok(name) = value.extract::<String>() {
        return choice("directions", &name, &[("all", Directions::ALL), ("point", Directions::POINT)]);
    }
    let problem = "it is no list of names";
    let names: Vec<String> = value.extract().map_err(|_| errors::argument("directions", problem, SETS))?;
    let listed = names.iter().map(|name| direction(name)).collect::<PyResult<Vec<_>>>()?;
    if listed.is_empty() {
        return Err(errors::argument("directions", "it is empty, so that nothing is held", SETS));
    }
    Ok(Directions::of(&listed))
}

fn pushed(name: &str, directions: Directions, restitution: f64, slip: Option<[f64; 3]>) -> PyResult<Contact<f64>> {
    let normal = choice("contact", name, &[("x", 3), ("y", 4), ("z", 5)])?;
    if !directions.contains(normal) {
        let problem = format!("the constraint leaves the direction `{name}` free");
        return Err(errors::argument("contact", problem, "add it to `directions`"));
    }
    if !(0.0..=1.0).contains(&restitution) {
        return Err(errors::argument("restitution", format!("it is {restitution}"), "give a number from 0 to 1"));
    }
    finite("slip", &slip.unwrap_or_default())?;
    Ok(Contact { normal, restitution, slip: slip.map(Vec3::from) })
}

fn rate(stabilisation: f64) -> PyResult<f64> {
    if stabilisation.is_finite() && stabilisation >= 0.0 {
        return Ok(stabilisation);
    }
    Err(errors::argument("stabilisation", format!("it is {stabilisation}"), "give a rate in rad/s, 0 for none"))
}

fn finite(name: &str, numbers: &[f64]) -> PyResult<()> {
    match numbers.iter().position(|x| !x.is_finite()) {
        Some(i) => Err(errors::not_finite(name, i.to_string(), numbers[i])),
        None => Ok(()),
    }
}

fn pose((of_xyz, xyz): (&str, [f64; 3]), (of_rpy, rpy): (&str, [f64; 3])) -> PyResult<Transform<f64>> {
    finite(of_xyz, &xyz)?;
    finite(of_rpy, &rpy)?;
    let [roll, pitch, yaw] = rpy;
    Ok(Transform::from_pose(Mat3::from_rpy(roll, pitch, yaw), Vec3::from(xyz)))
}

/// A pose from its homogeneous matrix.
fn matrix_pose(value: &Bound<'_, PyAny>) -> PyResult<Transform<f64>> {
    let remedy = "give a pose of shape (4, 4), as `Robot.placement` returns it";
    let x = read_rows("at", value, 4, remedy)?;
    if x.len() != 16 {
        return Err(errors::shape("at", format!("it has {} rows", x.len() / 4), remedy));
    }
    let rows = [0, 4, 8].map(|i| Vec3::new(x[i], x[i + 1], x[i + 2]));
    let near = |a: f64, b: f64| (a - b).abs() <= ROTATION;
    let square = (0..3).all(|i| (0..3).all(|j| near(rows[i].dot(rows[j]), f64::from(u8::from(i == j)))));
    if !(square && rows[0].cross(rows[1]).dot(rows[2]) > 0.0) {
        return Err(errors::argument("at", "its upper left part is no rotation", remedy));
    }
    if !(x[12..15].iter().all(|x| near(*x, 0.0)) && near(x[15], 1.0)) {
        return Err(errors::argument("at", "its last row is not 0 0 0 1", remedy));
    }
    Ok(Transform::from_pose(Mat3 { rows }, Vec3::new(x[3], x[7], x[11])))
}
