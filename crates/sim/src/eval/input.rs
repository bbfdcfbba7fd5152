//! One line of input: which keys there are, and numbers where numbers belong.

use super::json::Json;
use crate::error::{Error, ErrorKind};
use crate::load::nearest::nearest;

/// What is asked about one state. Arrays run over all joints in coordinate order; their lengths are checked against the robot
/// when the query is answered.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Query {
    /// Link positions, `nq` entries [rad or m]; a floating root leads with `x y z qx qy qz qw`. Always needed.
    pub q: Option<Vec<f64>>,
    /// Link velocities, `nv` entries; a floating root leads with its twist in its own frame, angular first.
    pub qd: Option<Vec<f64>>,
    /// Link accelerations, `nv` entries: asks for inverse dynamics.
    pub qdd: Option<Vec<f64>>,
    /// Motor positions, `nv` entries; with a floating root also without its six.
    pub theta: Option<Vec<f64>>,
    /// Motor velocities, like `theta`.
    pub thetad: Option<Vec<f64>>,
    /// Motor accelerations, like `theta`.
    pub thetadd: Option<Vec<f64>>,
    /// Motor torques, like `theta`: asks for forward dynamics. The six of a floating root are a wrench on it in its own frame.
    pub tau: Option<Vec<f64>>,
    /// Generalised forces on the link side of the joints, like `tau` [N m or N].
    pub tau_ext: Option<Vec<f64>>,
    /// Modal coordinates of links that bend, one entry per mode [m, in torsion rad]; `None` is zero.
    pub eta: Option<Vec<f64>>,
    /// Their rates; `None` is zero.
    pub etad: Option<Vec<f64>>,
    /// Their accelerations, for inverse dynamics; `None` leaves the modes free: their accelerations are computed.
    pub etadd: Option<Vec<f64>>,
    /// Generalised forces on the modes, for forward dynamics [N, in torsion N m]; `None` is zero.
    pub tau_eta: Option<Vec<f64>>,
    /// Loads on links.
    pub wrenches: Vec<Wrench>,
    /// Acceleration of gravity in world axes [m/s²]; `None` is the robot's own.
    pub gravity: Option<[f64; 3]>,
    /// Names of what holds the robot beside its joints: constraints, couplings, and contacts, which stick where they are. `None` is all constraints
    /// and couplings of the robot's file.
    pub held: Option<Vec<String>>,
    /// How motors and what is held share the load of inverse dynamics.
    pub distribution: Option<Distribution>,
}

/// Of all torques and forces that make a motion those are found whose weighted squares have the least sum.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Distribution {
    /// Weights of the torques `tau_j`, above zero, `nv` entries, with a floating root also without its six; `None` is ones.
    pub torques: Option<Vec<f64>>,
    /// Weights of the forces, one per held direction, not negative; `None` is 1e-6.
    pub multipliers: Option<Vec<f64>>,
    /// Forces to stay near to, one per held direction [N or N m]; `None` is zeros.
    pub wanted: Option<Vec<f64>>,
    /// Names of joints that nothing drives; a floating root always is one.
    pub passive: Vec<String>,
}

/// A load on a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Wrench {
    /// Name of the link, moving or fused to a moving one.
    pub link: String,
    /// Force [N].
    pub force: [f64; 3],
    /// Moment about `point` [N m].
    pub torque: [f64; 3],
    /// Axes of force and torque.
    pub axes: WrenchAxes,
    /// Where the force acts, in the link's frame [m].
    pub point: [f64; 3],
}

/// The axes a wrench is given in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WrenchAxes {
    /// The world's.
    #[default]
    World,
    /// The link's.
    Link,
}

const KEYS: [&str; 16] = [
    "q",
    "qd",
    "qdd",
    "theta",
    "thetad",
    "thetadd",
    "tau",
    "tau_ext",
    "eta",
    "etad",
    "etadd",
    "tau_eta",
    "wrenches",
    "gravity",
    "held",
    "distribution",
];
const DISTRIBUTION_KEYS: [&str; 4] = ["torques", "multipliers", "wanted", "passive"];
const WRENCH_KEYS: [&str; 5] = ["link", "force", "torque", "frame", "point"];

impl Query {
    /// Reads one line of JSON.
    ///
    /// # Errors
    /// Names the key that is unknown, doubled or not made of numbers, or the column where the JSON ends to make sense.
    pub fn parse(line: &str) -> Result<Self, Error> {
        let json = serde_json::from_str(line).map_err(|e| syntax(line, &e))?;
        let Json::Map(entries) = json else {
            let problem = format!("the line is {}, but must be an object", json.kind());
            return Err(fault(
                "",
                problem,
                "write one object a line, such as {\"q\": [0, 0], \"qd\": [0, 0], \"tau\": [0, 0]}",
            ));
        };
        let mut query = Self::default();
        for (key, value) in entries {
            match key.as_str() {
                "wrenches" => query.wrenches = wrenches(value)?,
                "gravity" => query.gravity = Some(triple("gravity", value)?),
                "held" => query.held = Some(names("held", value)?),
                "distribution" => query.distribution = Some(distribution(value)?),
                _ => match query.array(&key) {
                    Some(slot) => *slot = Some(numbers(&key, value)?),
                    None => return Err(unknown(&key, "", &KEYS)),
                },
            }
        }
        Ok(query)
    }

    fn array(&mut self, key: &str) -> Option<&mut Option<Vec<f64>>> {
        Some(match key {
            "q" => &mut self.q,
            "qd" => &mut self.qd,
            "qdd" => &mut self.qdd,
            "theta" => &mut self.theta,
            "thetad" => &mut self.thetad,
            "thetadd" => &mut self.thetadd,
            "tau" => &mut self.tau,
            "tau_ext" => &mut self.tau_ext,
            "eta" => &mut self.eta,
            "etad" => &mut self.etad,
            "etadd" => &mut self.etadd,
            "tau_eta" => &mut self.tau_eta,
            _ => return None,
        })
    }
}

/// An error about a key of the input.
pub(super) fn fault(key: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
    Error {
        kind: ErrorKind::Shape,
        file: String::new(),
        element: key.to_owned(),
        problem: problem.into(),
        remedy: remedy.into(),
    }
}

fn unknown(key: &str, place: &str, known: &[&'static str]) -> Error {
    let near = nearest(key, known.iter().copied()).unwrap_or_default();
    let remedy = format!("the nearest known one is `{near}`; known here: {}", known.join(", "));
    let error = fault(&format!("{place}{key}"), format!("`{key}` is not a known key"), remedy);
    Error { kind: ErrorKind::Yaml, ..error }
}

/// The key in whose value the JSON stops making sense, and why.
fn syntax(line: &str, error: &serde_json::Error) -> Error {
    let text = error.to_string();
    let what = text.split(" at line ").next().unwrap_or(&text);
    let before = line.get(..error.column().min(line.len())).unwrap_or(line);
    let key = before.rfind("\":").and_then(|end| before[..end].rsplit('"').next()).unwrap_or_default();
    let problem = format!("column {}: this is not valid JSON: {what}", error.column());
    let remedy = "write one object a line; NaN and infinity are not JSON numbers";
    Error { kind: ErrorKind::Yaml, ..fault(key, problem, remedy) }
}

fn number(place: &str, value: Json) -> Result<f64, Error> {
    match value {
        Json::Number(x) if x.is_finite() => Ok(x),
        other => Err(fault(place, format!("{} is not a finite number", other.kind()), "give a finite number")),
    }
}

fn numbers(key: &str, value: Json) -> Result<Vec<f64>, Error> {
    match value {
        Json::List(list) => list.into_iter().enumerate().map(|(i, x)| number(&format!("{key}[{i}]"), x)).collect(),
        other => {
            Err(fault(key, format!("it is {}, but must be a list of numbers", other.kind()), "give a list of numbers"))
        }
    }
}

fn triple(key: &str, value: Json) -> Result<[f64; 3], Error> {
    let list = numbers(key, value)?;
    <[f64; 3]>::try_from(list.as_slice()).map_err(|_| {
        fault(key, format!("{} entries are given, but 3 are expected", list.len()), "give the components x, y, z")
    })
}

fn text(key: &str, value: Json) -> Result<String, Error> {
    match value {
        Json::Text(text) => Ok(text),
        other => Err(fault(key, format!("it is {}, but must be a text", other.kind()), "give a text in quotes")),
    }
}

fn names(key: &str, value: Json) -> Result<Vec<String>, Error> {
    match value {
        Json::List(list) => list.into_iter().enumerate().map(|(i, x)| text(&format!("{key}[{i}]"), x)).collect(),
        other => {
            Err(fault(key, format!("it is {}, but must be a list of names", other.kind()), "give a list of names"))
        }
    }
}

fn distribution(value: Json) -> Result<Distribution, Error> {
    let Json::Map(entries) = value else {
        let problem = format!("it is {}, but must be an object", value.kind());
        return Err(fault("distribution", problem, "give an object such as {\"torques\": [1, 1, 4]}"));
    };
    let mut distribution = Distribution::default();
    for (key, value) in entries {
        let here = format!("distribution.{key}");
        match key.as_str() {
            "torques" => distribution.torques = Some(numbers(&here, value)?),
            "multipliers" => distribution.multipliers = Some(numbers(&here, value)?),
            "wanted" => distribution.wanted = Some(numbers(&here, value)?),
            "passive" => distribution.passive = names(&here, value)?,
            _ => return Err(unknown(&key, "distribution.", &DISTRIBUTION_KEYS)),
        }
    }
    Ok(distribution)
}

fn wrenches(value: Json) -> Result<Vec<Wrench>, Error> {
    let Json::List(list) = value else {
        let problem = format!("it is {}, but must be a list", value.kind());
        return Err(fault("wrenches", problem, "give a list such as [{\"link\": \"tool\", \"force\": [0, 0, -10]}]"));
    };
    list.into_iter().enumerate().map(|(i, value)| wrench(&format!("wrenches[{i}]"), value)).collect()
}

fn wrench(place: &str, value: Json) -> Result<Wrench, Error> {
    let Json::Map(entries) = value else {
        let problem = format!("it is {}, but must be an object", value.kind());
        return Err(fault(place, problem, "give an object such as {\"link\": \"tool\", \"force\": [0, 0, -10]}"));
    };
    let (mut link, mut force, mut torque) = (None, None, None);
    let (mut axes, mut point) = (WrenchAxes::World, [0.0; 3]);
    for (key, value) in entries {
        let here = format!("{place}.{key}");
        match key.as_str() {
            "link" => link = Some(text(&here, value)?),
            "force" => force = Some(triple(&here, value)?),
            "torque" => torque = Some(triple(&here, value)?),
            "point" => point = triple(&here, value)?,
            "frame" => {
                axes = match text(&here, value)?.as_str() {
                    "world" => WrenchAxes::World,
                    "link" => WrenchAxes::Link,
                    other => {
                        let problem = format!("`{other}` is not one of the choices");
                        return Err(fault(&here, problem, "give `world` or `link`"));
                    }
                }
            }
            _ => return Err(unknown(&key, &format!("{place}."), &WRENCH_KEYS)),
        }
    }
    let Some(link) = link else {
        return Err(fault(place, "the key `link` is missing", "name the link the wrench acts on"));
    };
    if force.is_none() && torque.is_none() {
        return Err(fault(place, "neither `force` nor `torque` is given", "give at least one of the two"));
    }
    Ok(Wrench { link, force: force.unwrap_or_default(), torque: torque.unwrap_or_default(), axes, point })
}
