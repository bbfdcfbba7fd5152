//! What holds a robot beside its joints, as a file says it: constraints, coupled joints, and points that may touch the ground.

use super::nearest::nearest;
use super::pose::pose;
use super::yaml::Keys;
use crate::error::Error;
use crate::robot::{ContactPoint, HeldPart, Robot};
use gyroflex::dynamics::{Anchor, Directions, Frame, Hold};
use gyroflex::spatial::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A point of a link that the ground may hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactFile {
    /// Name of the link.
    pub link: String,
    /// The point, in the link's frame [m]; default: its origin.
    #[serde(default)]
    pub point: [f64; 3],
}

/// A frame of a link held to the world or to another link: what closes a loop, or holds a robot that stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConstraintFile {
    /// Name of the link.
    pub link: String,
    /// Origin of the frame in the link's frame [m]; default: its origin.
    #[serde(default)]
    pub xyz: [f64; 3],
    /// Roll, pitch and yaw of the frame in the link's frame, as in URDF [rad].
    #[serde(default)]
    pub rpy: [f64; 3],
    /// What it is held to.
    #[serde(default)]
    pub to: AnchorFile,
    /// Which of the frame's motions are held, in the axes of what it is held to.
    pub directions: DirectionsFile,
    /// How fast errors of position and velocity are drawn back, critically damped [rad/s].
    #[serde(default = "stabilisation")]
    pub stabilisation: f64,
}

/// What a frame is held to: a frame of a link, or of the world.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AnchorFile {
    /// Name of the link; default: the world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub link: Option<String>,
    /// Its origin in the link's frame, or in the world [m].
    #[serde(default)]
    pub xyz: [f64; 3],
    /// Its roll, pitch and yaw there, as in URDF [rad].
    #[serde(default)]
    pub rpy: [f64; 3],
}

/// Motions of a frame: all, those of its origin, those of its origin along x and z, or a list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "`all`, `point`, `planar_point` or a list of x, y, z, rx, ry, rz")]
pub enum DirectionsFile {
    /// By a name.
    Named(DirectionsName),
    /// One by one.
    Listed(Vec<Direction>),
}

/// Names of sets of motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DirectionsName {
    /// All six.
    All,
    /// The three of the frame's origin.
    Point,
    /// Those of the frame's origin along x and z: for robots that move in that plane.
    PlanarPoint,
}

/// A motion: along an axis, or about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Direction {
    /// About x.
    Rx,
    /// About y.
    Ry,
    /// About z.
    Rz,
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z.
    Z,
}

/// A joint that follows another one: `q_joint = ratio q_follows + offset`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CouplingFile {
    /// Name of the joint.
    pub joint: String,
    /// Name of the joint that it follows.
    pub follows: String,
    /// How much of the other joint's motion it makes.
    pub ratio: f64,
    /// Where it is while the other one is at zero [rad or m].
    #[serde(default)]
    pub offset: f64,
    /// How fast errors are drawn back, critically damped [rad/s].
    #[serde(default = "stabilisation")]
    pub stabilisation: f64,
}

/// Draws errors back within some tens of milliseconds, and is stable at steps of a millisecond.
fn stabilisation() -> f64 {
    100.0
}

impl DirectionsFile {
    fn directions(&self) -> Directions {
        match self {
            Self::Named(DirectionsName::All) => Directions::ALL,
            Self::Named(DirectionsName::Point) => Directions::POINT,
            Self::Named(DirectionsName::PlanarPoint) => Directions::PLANAR_POINT,
            Self::Listed(list) => {
                let listed: Vec<usize> = list.iter().map(|d| *d as usize).collect();
                Directions::of(&listed)
            }
        }
    }
}

/// What a robot YAML says of all this.
pub(super) struct HeldFiles<'a> {
    pub(super) contacts: &'a BTreeMap<String, ContactFile>,
    pub(super) constraints: &'a BTreeMap<String, ConstraintFile>,
    pub(super) couplings: &'a BTreeMap<String, CouplingFile>,
}

impl HeldFiles<'_> {
    /// Puts it on a robot whose links are known.
    pub(super) fn put_on(&self, robot: &mut Robot, keys: &Keys) -> Result<(), Error> {
        for (name, file) in self.contacts {
            let key = format!("contacts.{name}");
            finite(keys, &key, &file.point)?;
            let link = find_link(robot, keys, &format!("{key}.link"), &file.link)?;
            let (Some(body), point) =
                (robot.links[link].body, robot.links[link].placement.point(Vec3::from(file.point)))
            else {
                let problem = format!("link `{}` does not move: it touches the ground always or never", file.link);
                return Err(keys.error(&format!("{key}.link"), problem, "name a link that moves, or take it out"));
            };
            robot.contacts.push(ContactPoint { name: name.clone(), body, point });
        }
        for (name, file) in self.constraints {
            let part = constraint(robot, keys, name, file)?;
            robot.held.push(part);
        }
        for (name, file) in self.couplings {
            let key = format!("couplings.{name}");
            finite(keys, &key, &[file.ratio, file.offset])?;
            rate(keys, &key, file.stabilisation)?;
            let (joint, follows) = (
                find_joint(robot, keys, &format!("{key}.joint"), &file.joint)?,
                find_joint(robot, keys, &format!("{key}.follows"), &file.follows)?,
            );
            if joint == follows {
                let problem = format!("joint `{}` follows itself", file.joint);
                return Err(keys.error(&format!("{key}.follows"), problem, "name another joint"));
            }
            let hold = Hold::Joints { joint, follows, ratio: file.ratio, offset: file.offset };
            robot.held.push(HeldPart { name: name.clone(), hold, stabilisation: file.stabilisation });
        }
        Ok(())
    }
}

fn constraint(robot: &Robot, keys: &Keys, name: &str, file: &ConstraintFile) -> Result<HeldPart, Error> {
    let key = format!("constraints.{name}");
    let numbers: Vec<f64> = [file.xyz, file.rpy, file.to.xyz, file.to.rpy].concat();
    finite(keys, &key, &numbers)?;
    rate(keys, &key, file.stabilisation)?;
    let directions = file.directions.directions();
    if directions.count() == 0 {
        return Err(keys.error(&format!("{key}.directions"), "nothing is held", "list a direction, or take it out"));
    }
    let place = |key: &str, link: &str, xyz, rpy| {
        let at = find_link(robot, keys, key, link)?;
        Ok::<_, Error>((robot.links[at].body, pose(xyz, rpy).after(robot.links[at].placement)))
    };
    let link_key = format!("{key}.link");
    let (body, placement) = place(&link_key, &file.link, file.xyz, file.rpy)?;
    let Some(body) = body else {
        let problem = format!("link `{}` does not move", file.link);
        return Err(keys.error(&link_key, problem, "name a link that moves, or take the constraint out"));
    };
    let anchor = match &file.to.link {
        None => Anchor { body: None, placement: pose(file.to.xyz, file.to.rpy) },
        Some(link) => {
            let (body, placement) = place(&format!("{key}.to.link"), link, file.to.xyz, file.to.rpy)?;
            Anchor { body, placement }
        }
    };
    if anchor.body == Some(body) {
        let problem = "both frames are on links that never move against each other";
        return Err(keys.error(&key, problem, "name links with a joint between them"));
    }
    let hold = Hold::Frame { frame: Frame { body, placement }, anchor, directions };
    Ok(HeldPart { name: name.to_owned(), hold, stabilisation: file.stabilisation })
}

fn rate(keys: &Keys, key: &str, stabilisation: f64) -> Result<(), Error> {
    if stabilisation.is_finite() && stabilisation >= 0.0 {
        return Ok(());
    }
    let problem = format!("{stabilisation} is not zero or a number above it");
    Err(keys.error(&format!("{key}.stabilisation"), problem, "give a rate in rad/s"))
}

fn finite(keys: &Keys, key: &str, numbers: &[f64]) -> Result<(), Error> {
    match numbers.iter().find(|x| !x.is_finite()) {
        Some(x) => Err(keys.error(key, format!("{x} is not a finite number"), "give finite numbers")),
        None => Ok(()),
    }
}

fn find_link(robot: &Robot, keys: &Keys, key: &str, link: &str) -> Result<usize, Error> {
    robot.links.iter().position(|l| l.name == *link).ok_or_else(|| {
        let near = nearest(link, robot.links.iter().map(|l| l.name.as_str())).unwrap_or("none");
        keys.error(key, format!("there is no link `{link}`"), format!("the nearest one is `{near}`"))
    })
}

fn find_joint(robot: &Robot, keys: &Keys, key: &str, joint: &str) -> Result<usize, Error> {
    let found = robot.joints.iter().position(|j| j.name == *joint && j.urdf_type != "floating");
    found.ok_or_else(|| {
        let near = nearest(joint, robot.joints.iter().map(|j| j.name.as_str())).unwrap_or("none");
        keys.error(
            key,
            format!("there is no joint `{joint}` of one degree of freedom"),
            format!("the nearest one is `{near}`"),
        )
    })
}
