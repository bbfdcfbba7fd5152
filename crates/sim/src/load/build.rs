//! Tree, tags and YAML become a robot.

use super::dialects::{Tags, TagsByJoint};
use super::drives;
use super::file::{DriveFile, RobotFile};
use super::flexible::FlexibleFiles;
use super::fuse::{Bodies, fuse};
use super::held::HeldFiles;
use super::merge::{Merge, place_of};
use super::mount::Places;
use super::nearest::nearest;
use super::tree::{JointElement, Tree};
use super::yaml::{Keys, Yaml};
use super::{LoadOptions, defect};
use crate::error::{Error, Warning};
use crate::flexible::Flexible;
use crate::robot::{Joint, Robot};
use gyroflex::model::Fidelity;
use gyroflex::spatial::Vec3;
use urdf_rs::JointType;

/// Gravity where nobody says otherwise [m/s²].
const GRAVITY: [f64; 3] = [0.0, 0.0, -9.81];

/// Puts the robot together; `options` already contain what the YAML says.
pub(crate) fn build(
    tree: &Tree,
    tags: &TagsByJoint,
    yaml: Option<&Yaml<RobotFile>>,
    options: &LoadOptions,
    fallback_name: &str,
    mut warnings: Vec<Warning>,
) -> Result<Robot, Error> {
    let Bodies { mut bodies, joints: joint_of_body, links } = fuse(tree, options, &mut warnings)?;
    let keys = yaml.map(|y| &y.keys);
    if let Some(yaml) = yaml {
        check_drives(tree, yaml)?;
    }
    let places = Places { tree, links: &links };
    let (mut table, mut spring_tables, mut joints) = (Vec::new(), Vec::new(), Vec::new());
    let (no_drive, no_tags) = (DriveFile::default(), Tags::default());
    for (body, index) in bodies.iter_mut().zip(&joint_of_body) {
        let Some(joint) = index.map(|j| &tree.joints[j]) else {
            joints.push(floating_root(tree));
            continue;
        };
        let file = yaml.and_then(|y| y.value.drives.get(&joint.name)).unwrap_or(&no_drive);
        let joint_tags = tags.get(&joint.name).unwrap_or(&no_tags);
        let path = format!("drives.{}", joint.name);
        let mut merge = Merge { table: &mut table, keys, joint: &joint.name, path };
        let driven = drives::merge(&mut merge, joint, file, joint_tags, &places, &mut spring_tables)?;
        body.drive = driven.drive;
        body.friction = driven.friction;
        joints.push(describe(tree, joint, driven.max_torque, &mut warnings));
    }
    warn_of_idle_tags(tree, tags, &joint_of_body, &bodies, &mut warnings);
    let name = tree.name.clone().unwrap_or_else(|| fallback_name.to_owned());
    if joints.is_empty() {
        let message =
            "nothing moves: the robot has no joint but fixed ones, and its root is fixed to the world".to_owned();
        let root = &tree.links[tree.root];
        warnings.push(Warning { file: root.at.clone(), element: format!("link `{}`", root.name), message });
    }
    let mut robot = Robot {
        name,
        joints,
        bodies,
        spring_tables,
        gravity: Vec3::from(options.gravity.unwrap_or(GRAVITY)),
        fidelity: options.model.unwrap_or(Fidelity::Complete),
        links,
        table,
        warnings,
        sources: Vec::new(),
        payload: None,
        contacts: Vec::new(),
        held: Vec::new(),
        flexible: Flexible::default(),
    };
    if let Some(yaml) = yaml {
        let RobotFile { flexible_links, drives, .. } = &yaml.value;
        FlexibleFiles { links: flexible_links, drives, tree, keys: &yaml.keys }.put_on(&mut robot)?;
    }
    if let Some(yaml) = yaml {
        let RobotFile { contacts, constraints, couplings, .. } = &yaml.value;
        HeldFiles { contacts, constraints, couplings }.put_on(&mut robot, &yaml.keys)?;
    }
    if let Some((yaml, payload)) = yaml.and_then(|y| Some((y, y.value.payload.as_ref()?))) {
        payload.put_on(&mut robot, &yaml.keys, "payload")?;
    }
    robot.spec().validate().map_err(|e| {
        let joint = joint_of_body.get(e.body).copied().flatten();
        let at = joint.map_or(&tree.links[tree.root].at, |j| &tree.joints[j].at);
        defect::explain(&e, &robot, at.clone())
    })?;
    Ok(robot)
}

/// Every entry under `drives` must belong to a joint that moves.
fn check_drives(tree: &Tree, yaml: &Yaml<RobotFile>) -> Result<(), Error> {
    for name in yaml.value.drives.keys() {
        let path = format!("drives.{name}");
        let moving = tree.joints.iter().filter(|j| j.moves()).map(|j| j.name.as_str());
        let near = match nearest(name, moving) {
            Some(near) => format!("the nearest joint that moves is `{near}`"),
            None => "the robot has no joint that moves".to_owned(),
        };
        match tree.joints.iter().find(|j| j.name == *name) {
            None => return Err(unknown(&yaml.keys, &path, format!("the URDF has no joint `{name}`"), near)),
            Some(joint) if !joint.moves() => {
                let problem = format!("joint `{name}` is fixed ({}), and a fixed joint has no drive", joint.at);
                return Err(unknown(&yaml.keys, &path, problem, near));
            }
            Some(_) => {}
        }
    }
    Ok(())
}

fn unknown(keys: &Keys, path: &str, problem: String, near: String) -> Error {
    keys.error(path, problem, format!("name a joint of the URDF; {near}"))
}

/// Names and limits of a joint. A limit of zero effort or velocity is what files write who know none.
fn describe(tree: &Tree, joint: &JointElement, max_torque: Option<f64>, warnings: &mut Vec<Warning>) -> Joint {
    let limit = joint.limit.as_ref();
    let range = limit.map(|l| [l.lower, l.upper]).filter(|_| joint.kind != JointType::Continuous);
    let mut warn = |message: String| {
        warnings.push(Warning { file: joint.at.clone(), element: format!("joint `{}`", joint.name), message });
    };
    if let Some([lower, upper]) = range.filter(|[lower, upper]| lower > upper) {
        warn(format!("its lower limit {lower} is above its upper limit {upper}; both are ignored"));
    }
    let one_sided = range.filter(|[lower, upper]| lower.is_finite() != upper.is_finite());
    if one_sided.is_some() {
        warn("only one of its limits is finite; both are ignored".to_owned());
    }
    Joint {
        name: joint.name.clone(),
        urdf_type: match joint.kind {
            JointType::Prismatic => "prismatic",
            JointType::Continuous => "continuous",
            _ => "revolute",
        }
        .to_owned(),
        parent_link: tree.links[joint.parent].name.clone(),
        child_link: tree.links[joint.child].name.clone(),
        limits: range.filter(|[lower, upper]| lower <= upper && lower.is_finite() && upper.is_finite()),
        max_velocity: limit.map(|l| l.velocity).filter(|v| v.is_finite() && *v > 0.0),
        max_torque,
    }
}

/// The joint of a floating root, named `root` unless the URDF uses that name.
fn floating_root(tree: &Tree) -> Joint {
    let mut name = "root".to_owned();
    while tree.joints.iter().any(|j| j.name == name) {
        name.push('_');
    }
    Joint {
        name,
        urdf_type: "floating".to_owned(),
        parent_link: "world".to_owned(),
        child_link: tree.links[tree.root].name.clone(),
        limits: None,
        max_velocity: None,
        max_torque: None,
    }
}

/// Gear ratios of the URDF change nothing where no rotor turns, nor any tag at joints that do not move: one warning each.
fn warn_of_idle_tags(
    tree: &Tree,
    tags: &TagsByJoint,
    joint_of_body: &[Option<usize>],
    bodies: &[gyroflex::model::BodySpec],
    warnings: &mut Vec<Warning>,
) {
    let driven = |name: &str| {
        let body = joint_of_body.iter().position(|j| j.is_some_and(|j| tree.joints[j].name == name));
        body.is_some_and(|b| bodies[b].drive.is_some())
    };
    let idle: Vec<&JointElement> =
        tree.joints.iter().filter(|j| tags.get(&j.name).is_some_and(|t| !t.is_empty()) && !driven(&j.name)).collect();
    let Some(first) = idle.first() else { return };
    let source = tags.get(&first.name).and_then(Tags::first_source).unwrap_or(&first.at);
    let others = if idle.len() == 1 { String::new() } else { format!(" and those of {} more joints", idle.len() - 1) };
    warnings.push(Warning {
        file: place_of(source).to_owned(),
        element: format!("joint `{}`", first.name),
        message: format!("its gear ratio{others} has no effect: no rotor inertia is given that the gear could turn"),
    });
}
