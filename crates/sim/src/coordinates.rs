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
        Self { joints: joints.collect(), floating }
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
        match values {
            JointValues::Named(map) => {
                let mut out = vec![None; self.len()];
                for (name, value) in map {
                    out[self.find(name, keys, &format!("{key}.{name}"))?] = Some(*value);
                }
                Ok(out)
            }
            JointValues::Ordered(list) if list.len() == self.len() => Ok(list.iter().copied().map(Some).collect()),
            JointValues::Ordered(list) => Err(fault(
                keys,
                key,
                format!("the list has {} entries, but the robot has {} joints", list.len(), self.len()),
                format!("give one number per joint, in this order: {}", self.names().collect::<Vec<_>>().join(", ")),
            )),
        }
    }
}
