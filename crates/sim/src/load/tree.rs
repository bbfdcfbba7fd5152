//! The links and joints of a URDF as a tree.

use super::nearest::nearest;
use super::pose::{direction, pose};
use super::standard;
use super::xml::{Xml, child, children};
use crate::error::Error;
use gyroflex::spatial::{Transform, Vec3};
use std::collections::HashMap;
use urdf_rs::JointType;

/// A URDF whose joints form one tree.
#[derive(Debug)]
pub(crate) struct Tree {
    /// The robot's name, if the file gives one.
    pub(crate) name: Option<String>,
    /// In the order of the file.
    pub(crate) links: Vec<LinkElement>,
    /// In the order of the file.
    pub(crate) joints: Vec<JointElement>,
    /// Index of the root link.
    pub(crate) root: usize,
}

/// A `<link>`.
#[derive(Debug)]
pub(crate) struct LinkElement {
    pub(crate) name: String,
    /// File and line.
    pub(crate) at: String,
    /// `None` where the file gives no `<inertial>`, which means no mass.
    pub(crate) inertial: Option<urdf_rs::Inertial>,
    /// Index of the joint that carries it; `None` for the root.
    pub(crate) parent_joint: Option<usize>,
    /// Indices of the joints it carries, in the order of the file.
    pub(crate) child_joints: Vec<usize>,
}

/// A `<joint>`.
#[derive(Debug)]
pub(crate) struct JointElement {
    pub(crate) name: String,
    /// File and line.
    pub(crate) at: String,
    pub(crate) kind: JointType,
    /// Index of the parent link.
    pub(crate) parent: usize,
    /// Index of the child link.
    pub(crate) child: usize,
    /// Pose of the joint frame in the parent link's frame.
    pub(crate) origin: Transform<f64>,
    /// Unit axis; the x-axis for joints that have none.
    pub(crate) axis: Vec3<f64>,
    /// Limits as written, infinite where there is none; `None` without `<limit>`.
    pub(crate) limit: Option<urdf_rs::JointLimit>,
    pub(crate) dynamics: Option<urdf_rs::Dynamics>,
    /// File and line of `<dynamics>`.
    pub(crate) dynamics_at: String,
    /// Name of the joint it mimics.
    pub(crate) mimics: Option<String>,
}

impl JointElement {
    /// Whether the link behind it moves with its own coordinate.
    pub(crate) fn moves(&self) -> bool {
        self.kind != JointType::Fixed
    }
}

/// Reads links and joints and checks that they form one tree.
pub(crate) fn read(xml: &Xml<'_>) -> Result<Tree, Error> {
    let standard = standard::read(xml)?;
    let root = xml.root();
    let name = root.attribute("name").map(str::trim).filter(|n| !n.is_empty()).map(str::to_owned);
    let mut links = Vec::new();
    let mut by_name = HashMap::new();
    for (node, link) in children(root, "link").zip(standard.links) {
        if let Some(first) = by_name.insert(link.name.clone(), links.len()) {
            let first: &LinkElement = &links[first];
            let problem = format!("another link of this name is at {}", first.at);
            return Err(xml.error(node, problem, "give every link a name of its own"));
        }
        let inertial = child(node, "inertial").is_some().then_some(link.inertial);
        let at = xml.at(node);
        links.push(LinkElement { name: link.name, at, inertial, parent_joint: None, child_joints: Vec::new() });
    }
    let mut joints: Vec<JointElement> = Vec::new();
    let mut joint_names = HashMap::new();
    for (node, joint) in children(root, "joint").zip(standard.joints) {
        if let Some(first) = joint_names.insert(joint.name.clone(), joints.len()) {
            let problem = format!("another joint of this name is at {}", joints[first].at);
            return Err(xml.error(node, problem, "give every joint a name of its own"));
        }
        let end = |name: &str, which: &str| {
            by_name.get(name).copied().ok_or_else(|| {
                let near = nearest(name, links.iter().map(|l| l.name.as_str()));
                let near = near.map_or_else(String::new, |n| format!("; the nearest one is `{n}`"));
                xml.error(
                    node,
                    format!("its {which} link `{name}` is not in the file"),
                    format!("name a link of the file{near}"),
                )
            })
        };
        let (parent, child_link) = (end(&joint.parent.link, "parent")?, end(&joint.child.link, "child")?);
        let index = joints.len();
        if let Some(other) = links[child_link].parent_joint {
            let problem = format!("link `{}` already hangs on joint `{}`", links[child_link].name, joints[other].name);
            return Err(xml.error(
                node,
                problem,
                "a link has one parent: closed loops are not supported, cut the loop at one joint",
            ));
        }
        // Files often give fixed joints an axis of zero; it means nothing there.
        let axis = match direction(joint.axis.xyz.0) {
            Some(axis) => axis,
            None if joint.joint_type == JointType::Fixed => Vec3::new(1.0, 0.0, 0.0),
            None => {
                let (node, remedy) =
                    (child(node, "axis").unwrap_or(node), "give its direction, such as <axis xyz=\"0 0 1\"/>");
                return Err(xml.error(node, "the joint axis is zero", remedy));
            }
        };
        links[child_link].parent_joint = Some(index);
        links[parent].child_joints.push(index);
        joints.push(JointElement {
            name: joint.name,
            at: xml.at(node),
            kind: joint.joint_type,
            parent,
            child: child_link,
            origin: pose(joint.origin.xyz.0, joint.origin.rpy.0),
            axis,
            limit: child(node, "limit").is_some().then_some(joint.limit),
            dynamics: joint.dynamics,
            dynamics_at: child(node, "dynamics").map_or_else(String::new, |d| xml.at(d)),
            mimics: joint.mimic.map(|m| m.joint),
        });
    }
    let root = find_root(xml, &links, &joints)?;
    Ok(Tree { name, links, joints, root })
}

/// The one link that hangs on no joint and from which all others can be reached.
fn find_root(xml: &Xml<'_>, links: &[LinkElement], joints: &[JointElement]) -> Result<usize, Error> {
    let roots: Vec<usize> = (0..links.len()).filter(|i| links[*i].parent_joint.is_none()).collect();
    let robot = xml.root();
    let (root, more) = match roots.as_slice() {
        [] if links.is_empty() => {
            return Err(xml.error(
                robot,
                "it has no links",
                "give the URDF of a robot; an unexpanded xacro file has none",
            ));
        }
        [] => {
            let (problem, remedy) = (
                "every link has a parent: the joints form a loop",
                "cut the loop at one joint, so that one link is the root",
            );
            return Err(xml.error(robot, problem, remedy));
        }
        [root, more @ ..] => (*root, more),
    };
    if let [second, rest @ ..] = more {
        let (a, b) = (&links[root], &links[*second]);
        let others = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
        let mut error = xml.error(
            robot,
            format!(
                "links `{}` ({}) and `{}` ({}){others} have no parent: the robot is in pieces",
                a.name, a.at, b.name, b.at
            ),
            format!("connect them, for instance by a fixed joint from `{}` to `{}`", a.name, b.name),
        );
        error.file.clone_from(&b.at);
        error.element = format!("link `{}`", b.name);
        return Err(error);
    }
    let mut reached = vec![false; links.len()];
    let mut open = vec![root];
    while let Some(link) = open.pop() {
        reached[link] = true;
        open.extend(links[link].child_joints.iter().map(|j| joints[*j].child));
    }
    if let Some(lost) = reached.iter().position(|r| !r) {
        let mut error = xml.error(
            robot,
            format!("it cannot be reached from the root link `{}`: its joints form a loop", links[root].name),
            "cut the loop at one joint and hang the rest on the root",
        );
        error.file.clone_from(&links[lost].at);
        error.element = format!("link `{}`", links[lost].name);
        return Err(error);
    }
    Ok(root)
}
