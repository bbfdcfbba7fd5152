//! Which entry of an array belongs to which joint, and from which side of its gear it is given.

use super::input::fault;
use crate::error::Error;
use crate::robot::Robot;
use gyroflex::model::Model;

/// Beyond this a quaternion is a mistake, not a rounded unit quaternion.
const QUATERNION_TOLERANCE: f64 = 1e-6;
/// Within this a quaternion is used as it is, bit for bit: its error shows in no result.
const QUATERNION_ROUNDING: f64 = 1e-14;
/// Entries of a floating root in a vector of velocities.
const ROOT: usize = 6;

/// The joints behind the entries of vectors.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    nq: usize,
    floating: bool,
    /// Name of the joint of every entry of a vector of velocities.
    pub(super) joints: Vec<String>,
    /// Gear ratio at each of these, 1 where there is no drive.
    ratios: Vec<f64>,
    has_elastic: bool,
    /// Names of the modes of links that bend.
    pub(super) modes: Vec<String>,
}

impl Layout {
    pub(super) fn of(robot: &Robot, model: &Model<f64>) -> Self {
        let mut joints = Vec::with_capacity(model.nv());
        let mut ratios = Vec::with_capacity(model.nv());
        for (joint, body) in robot.joints.iter().zip(model.bodies()) {
            for _ in 0..body.joint.nv() {
                joints.push(joint.name.clone());
                ratios.push(body.drive.as_ref().map_or(1.0, |d| d.rotor.gear_ratio));
            }
        }
        let has_elastic = model.bodies().iter().any(|b| b.is_elastic());
        let modes = robot.mode_names();
        Self { nq: model.nq(), floating: robot.is_floating(), joints, ratios, has_elastic, modes }
    }

    /// Number of velocity coordinates of the joints.
    pub(super) fn nv(&self) -> usize {
        self.joints.len()
    }

    /// Entries of a floating root, which lead.
    pub(super) fn root(&self) -> usize {
        if self.floating { ROOT } else { 0 }
    }

    /// The joint or the mode behind entry `k` of a vector over all coordinates, for an error message.
    pub(super) fn owner(&self, k: usize) -> String {
        match self.joints.get(k) {
            Some(joint) => format!("joint `{joint}`"),
            None => format!("mode `{}`", self.modes.get(k - self.joints.len()).map_or("", String::as_str)),
        }
    }

    /// Whether any joint has a motor coordinate of its own.
    pub(super) fn has_elastic(&self) -> bool {
        self.has_elastic
    }

    /// The order of a vector's entries, for an error message.
    fn order(&self, root: &str) -> String {
        let skip = if self.floating { ROOT } else { 0 };
        let mut names: Vec<&str> = if self.floating && !root.is_empty() { vec![root] } else { Vec::new() };
        names.extend(self.joints.iter().skip(skip).map(String::as_str));
        names.join(", ")
    }
}

/// Turns arrays as given into arrays as the algorithms take them, and back.
pub(super) struct Arrays<'a> {
    pub(super) layout: &'a Layout,
    pub(super) motor_side: bool,
}

impl Arrays<'_> {
    /// `q`; the quaternion of a floating root must be a unit quaternion and is freed of rounding to fewer digits.
    pub(super) fn positions(&self, given: Option<&[f64]>) -> Result<Vec<f64>, Error> {
        let Layout { nq, floating, .. } = *self.layout;
        let order = || self.layout.order("x y z qx qy qz qw of the root");
        let Some(given) = given else {
            return Err(fault(
                "q",
                "the positions are missing",
                format!("give {nq} numbers, in this order: {}", order()),
            ));
        };
        if given.len() != nq {
            let problem = format!("{} entries are given, but {nq} are expected", given.len());
            return Err(fault("q", problem, format!("give one entry per coordinate, in this order: {}", order())));
        }
        finite("q", given)?;
        let mut q = given.to_vec();
        if floating {
            unit_quaternion(&mut q[3..7])?;
        }
        Ok(q)
    }

    /// A vector over all velocity coordinates; zeros where it is neither given nor needed.
    pub(super) fn joints(&self, key: &str, given: Option<&[f64]>, needed: bool) -> Result<Vec<f64>, Error> {
        self.vector(key, given, needed, "", false)
    }

    /// A vector over the motors, reflected to the link side; zeros where it is neither given nor needed.
    pub(super) fn motors(&self, key: &str, given: Option<&[f64]>, needed: bool) -> Result<Vec<f64>, Error> {
        let v = self.vector(key, given, needed, ", since the robot has elastic joints in this model", true)?;
        Ok(self.over_ratio(v))
    }

    /// Motor torques, reflected to the link side.
    pub(super) fn torques(&self, key: &str, given: &[f64]) -> Result<Vec<f64>, Error> {
        Ok(self.times_ratio(self.vector(key, Some(given), true, "", true)?))
    }

    /// Generalised forces on the link side.
    pub(super) fn loads(&self, key: &str, given: Option<&[f64]>) -> Result<Vec<f64>, Error> {
        self.vector(key, given, false, "", true)
    }

    /// A vector over the modes of links that bend; zeros where it is not given.
    pub(super) fn modes(&self, key: &str, given: Option<&[f64]>) -> Result<Vec<f64>, Error> {
        let names = &self.layout.modes;
        let Some(given) = given else { return Ok(vec![0.0; names.len()]) };
        finite(key, given)?;
        if given.len() == names.len() {
            return Ok(given.to_vec());
        }
        let remedy = match names.is_empty() {
            true => format!("leave `{key}` out: no link of the robot bends"),
            false => format!("give one entry per mode, in this order: {}", names.join(", ")),
        };
        Err(fault(key, format!("{} entries are given, but {} are expected", given.len(), names.len()), remedy))
    }

    /// From reflected motions to the user's, from the user's torques to reflected ones.
    pub(super) fn times_ratio(&self, v: Vec<f64>) -> Vec<f64> {
        v.iter().enumerate().map(|(k, x)| x * self.ratio(k)).collect()
    }

    /// From the user's motions to reflected ones, from reflected torques to the user's.
    pub(super) fn over_ratio(&self, v: Vec<f64>) -> Vec<f64> {
        v.iter().enumerate().map(|(k, x)| x / self.ratio(k)).collect()
    }

    /// Gear ratios, 1 for all where everything is on the link side.
    pub(super) fn ratio(&self, k: usize) -> f64 {
        if self.motor_side { self.layout.ratios.get(k).copied().unwrap_or(1.0) } else { 1.0 }
    }

    /// `or_joints_only`: whether the six entries of a floating root may be left out.
    fn vector(
        &self,
        key: &str,
        given: Option<&[f64]>,
        needed: bool,
        why: &str,
        or_joints_only: bool,
    ) -> Result<Vec<f64>, Error> {
        let nv = self.layout.nv();
        let optional_root = or_joints_only && self.layout.floating;
        let order = || self.layout.order("wx wy wz vx vy vz of the root");
        let Some(given) = given else {
            if needed {
                let remedy = format!("give {nv} numbers, in this order: {}", order());
                return Err(fault(key, format!("it is missing, and needed{why}"), remedy));
            }
            return Ok(vec![0.0; nv]);
        };
        finite(key, given)?;
        if given.len() == nv {
            return Ok(given.to_vec());
        }
        if optional_root && given.len() + ROOT == nv {
            let mut v = vec![0.0; ROOT];
            v.extend_from_slice(given);
            return Ok(v);
        }
        let or = if optional_root { format!(", or {} without the root,", nv - ROOT) } else { String::new() };
        let problem = format!("{} entries are given, but {nv}{or} are expected", given.len());
        Err(fault(key, problem, format!("give one entry per joint, in this order: {}", order())))
    }
}

/// Frees the quaternion of a floating root, entries 3 to 6 of `q`, of its rounding to fewer digits.
///
/// # Errors
/// Anything that is not a unit quaternion.
pub fn unit_quaternion(quaternion: &mut [f64]) -> Result<(), Error> {
    let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
    if (norm - 1.0).abs() > QUATERNION_TOLERANCE {
        let problem = format!("the quaternion of the root has length {norm}, not 1");
        return Err(fault("q", problem, "give a unit quaternion qx qy qz qw after the position x y z"));
    }
    if (norm - 1.0).abs() > QUATERNION_ROUNDING {
        quaternion.iter_mut().for_each(|x| *x /= norm);
    }
    Ok(())
}

/// Refuses infinities and NaN that a program passes; JSON has none.
fn finite(key: &str, given: &[f64]) -> Result<(), Error> {
    match given.iter().position(|x| !x.is_finite()) {
        Some(i) => {
            Err(fault(&format!("{key}[{i}]"), format!("{} is not a finite number", given[i]), "give a finite number"))
        }
        None => Ok(()),
    }
}
