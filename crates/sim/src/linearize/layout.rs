//! Which entry of the state and of the input belongs to what.

use super::is_joint;
use crate::error::{Error, ErrorKind};
use crate::load::nearest::nearest;
use crate::robot::Robot;
use gyroflex::model::Model;

/// What a floating root's six entries are called, as positions and as velocities.
const ROOT: [[&str; 6]; 2] = [["rx", "ry", "rz", "x", "y", "z"], ["wx", "wy", "wz", "vx", "vy", "vz"]];

/// The order of states and inputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Name of the joint, or the mode of a link, of every velocity coordinate.
    joints: Vec<String>,
    /// How many of these are modes, the last ones.
    modes: usize,
    floating: bool,
    elastic: Vec<usize>,
    inputs: Vec<usize>,
}

impl Layout {
    pub(super) fn of(robot: &Robot, model: &Model<f64>) -> Self {
        let mut joints = Vec::with_capacity(model.nv());
        for (joint, body) in robot.joints.iter().zip(model.bodies()) {
            joints.extend(std::iter::repeat_n(joint.name.clone(), body.joint.nv()));
        }
        let modes = robot.mode_names();
        let bodies = || model.bodies().iter();
        Self {
            modes: modes.len(),
            joints: joints.into_iter().chain(modes).collect(),
            floating: robot.is_floating(),
            elastic: bodies().filter(|b| b.is_elastic()).map(|b| b.v_index()).collect(),
            inputs: bodies().filter(|b| is_joint(b.joint)).map(|b| b.v_index()).collect(),
        }
    }

    /// Number of velocity coordinates of joints and modes.
    pub fn nv(&self) -> usize {
        self.joints.len()
    }

    /// Number of modes of links that bend: the last velocity coordinates.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// Whether a floating root leads.
    pub fn floating(&self) -> bool {
        self.floating
    }

    /// Velocity coordinates of the joints with an elastic transmission: entry `i` of `θ` in the state is that of `elastic()[i]`.
    pub fn elastic(&self) -> &[usize] {
        &self.elastic
    }

    /// Velocity coordinates of the joints: entry `i` of the input is the torque of `inputs()[i]`.
    pub fn inputs(&self) -> &[usize] {
        &self.inputs
    }

    /// Number of positions in the state, half of its entries.
    pub fn positions(&self) -> usize {
        self.nv() + self.elastic.len()
    }

    /// Place in the state of the motor position of velocity coordinate `k`: the link's own without an elastic transmission.
    pub fn motor(&self, k: usize) -> usize {
        self.elastic.iter().position(|e| *e == k).map_or(k, |i| self.nv() + i)
    }

    /// Velocity coordinate of the joint of that name.
    ///
    /// # Errors
    /// Names the joint with the nearest name.
    pub fn find(&self, name: &str) -> Result<usize, Error> {
        let known = || self.inputs.iter().map(|k| self.joints[*k].as_str());
        self.inputs.iter().copied().find(|k| self.joints[*k] == name).ok_or_else(|| Error {
            kind: ErrorKind::Shape,
            file: String::new(),
            element: "joint".to_owned(),
            problem: format!("the robot has no joint `{name}`"),
            remedy: match nearest(name, known()) {
                Some(near) => {
                    format!("the nearest known one is `{near}`; known: {}", known().collect::<Vec<_>>().join(", "))
                }
                None => "the robot has no joints".to_owned(),
            },
        })
    }

    /// Name of the joint or the mode of a velocity coordinate.
    pub fn joint(&self, k: usize) -> &str {
        &self.joints[k]
    }

    /// Names of the states.
    pub fn state_names(&self) -> Vec<String> {
        let mut names = Vec::with_capacity(2 * self.positions());
        let first_mode = self.nv() - self.modes;
        for (side, [link, mode, motor]) in [["q", "eta", "theta"], ["qd", "etad", "thetad"]].into_iter().enumerate() {
            for (k, joint) in self.joints.iter().enumerate() {
                let link = if k < first_mode { link } else { mode };
                match ROOT[side].get(k).filter(|_| self.floating) {
                    Some(entry) => names.push(format!("{link}.{joint}.{entry}")),
                    None => names.push(format!("{link}.{joint}")),
                }
            }
            names.extend(self.elastic.iter().map(|k| format!("{motor}.{}", self.joints[*k])));
        }
        names
    }

    /// Names of the inputs.
    pub fn input_names(&self) -> Vec<String> {
        self.inputs.iter().map(|k| format!("tau.{}", self.joints[*k])).collect()
    }
}
