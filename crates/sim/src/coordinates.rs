//! Which joint owns which coordinate, by name.

use crate::error::Error;
use crate::load::nearest::nearest;
use crate::load::yaml::Keys;
use crate::robot::Robot;
use crate::scenario::{JointValues, fault};

/// A joint of one degree of freedom and its places in the coordinate vectors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coordinate {
    /// Name of the joint.
    pub name: String,
    /// Index of its body, and of its entry in [`Robot::joints`].
    pub body: usize,
    /// Its place in `q`.
    pub q: usize,
    /// Its place in `qd` and every vector of that length.
    pub v: usize,
}

/// The joints of one degree of freedom, in coordinate order: all but a floating root.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coordinates {
    /// One entry per joint.
    pub joints: Vec<Coordinate>,
    /// Whether a floating root leads the vectors with 7 and 6 entries.
    pub floating: bool,
    /// Names of the modes of links that bend, which follow the joints in the vectors.
    pub modes: Vec<String>,
}

impl Coordinates {
    /// The coordinates of a robot.
    pub fn of(robot: &Robot) -> Self {
        let floating = robot.is_floating();
        let (skip, q0, v0) = if floating { (1, 7, 6) } else { (0, 0, 0) };
        let joints = robot.joints.iter().enumerate().skip(skip).map(|(body, joint)| Coordinate {
            name: joint.name.clone(),
            body,
            q: q0 + body - skip,
            v: v0 + body - skip,
        });
        Self { joints: joints.collect(), floating, modes: robot.mode_names() }
    }

    /// Number of joints of one degree of freedom.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// Names of the joints, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(|j| j.name.as_str())
    }

    /// Length of `q`.
    pub fn nq(&self) -> usize {
        self.len() + self.modes.len() + if self.floating { 7 } else { 0 }
    }

    /// Length of `qd` and every vector of that length.
    pub fn nv(&self) -> usize {
        self.len() + self.modes.len() + if self.floating { 6 } else { 0 }
    }

    /// Index of the joint of this name, which the key `key` of a file mentions.
    ///
    /// # Errors
    /// Names the place in the file and the joint with the nearest name.
    pub fn find(&self, name: &str, keys: &Keys, key: &str) -> Result<usize, Error> {
        self.names().position(|n| n == name).ok_or_else(|| {
            let remedy = match nearest(name, self.names()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "remove it: the robot has no joints".to_owned(),
            };
            fault(keys, key, format!("the robot has no joint `{name}`"), remedy)
        })
    }

    /// One number per joint, `None` where `values` is silent.
    ///
    /// # Errors
    /// An unknown joint, or a list of the wrong length.
    pub fn spread(&self, values: &JointValues, keys: &Keys, key: &str) -> Result<Vec<Option<f64>>, Error> {
        let find = |name: &str| self.find(name, keys, &format!("{key}.{name}"));
        spread(values, self.len(), find, |given| {
            let problem = format!("the list has {given} entries, but the robot has {} joints", self.len());
            let order = self.names().collect::<Vec<_>>().join(", ");
            fault(keys, key, problem, format!("give one number per joint, in this order: {order}"))
        })
    }

    /// One number per mode of links that bend, `None` where `values` is silent.
    ///
    /// # Errors
    /// An unknown mode, or a list of the wrong length.
    pub fn spread_modes(&self, values: &JointValues, keys: &Keys, key: &str) -> Result<Vec<Option<f64>>, Error> {
        let names = || self.modes.iter().map(String::as_str);
        let find = |name: &str| {
            names().position(|n| n == name).ok_or_else(|| {
                let remedy = match nearest(name, names()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "remove it: no link of the robot bends (`flexible_links`)".to_owned(),
                };
                fault(keys, &format!("{key}.{name}"), format!("the robot has no mode `{name}`"), remedy)
            })
        };
        spread(values, self.modes.len(), find, |given| {
            let problem =
                format!("the list has {given} entries, but the robot's links have {} modes", self.modes.len());
            fault(keys, key, problem, format!("give one number per mode, in this order: {}", self.modes.join(", ")))
        })
    }
}

/// Values over `n` coordinates.
fn spread(
    values: &JointValues,
    n: usize,
    find: impl Fn(&str) -> Result<usize, Error>,
    wrong_length: impl Fn(usize) -> Error,
) -> Result<Vec<Option<f64>>, Error> {
    match values {
        JointValues::Named(map) => {
            let mut out = vec![None; n];
            for (name, value) in map {
                out[find(name)?] = Some(*value);
            }
            Ok(out)
        }
        JointValues::Ordered(list) if list.len() == n => Ok(list.iter().copied().map(Some).collect()),
        JointValues::Ordered(list) => Err(wrong_length(list.len())),
    }
}
