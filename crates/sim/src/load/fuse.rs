//! Links that are rigidly connected become one body.

use super::inertial;
use super::tree::{JointElement, Tree};
use super::{LoadOptions, Mimic};
use crate::error::{Error, ErrorKind, Warning};
use crate::robot::Link;
use gyroflex::model::{BodySpec, Friction, JointKind};
use gyroflex::spatial::{SpatialInertia, Transform, Vec3};
use urdf_rs::JointType;

/// The moving bodies of a robot, without drives and friction.
#[derive(Debug)]
pub(crate) struct Bodies {
    /// Depth first from the root, the children of a link in the order of the file.
    pub(crate) bodies: Vec<BodySpec>,
    /// The joint in the tree that moves each body; `None` for a floating root.
    pub(crate) joints: Vec<Option<usize>>,
    /// All links, in the order of the file.
    pub(crate) links: Vec<Link>,
}

/// Walks the tree from its root and adds every link to the body that carries it. With a fixed base, links fused to the root
/// belong to the world, and their masses do not matter.
pub(crate) fn fuse(tree: &Tree, options: &LoadOptions, warnings: &mut Vec<Warning>) -> Result<Bodies, Error> {
    let mut out = Bodies { bodies: Vec::new(), joints: Vec::new(), links: Vec::new() };
    let mut places: Vec<(Option<usize>, Transform<f64>)> = vec![(None, Transform::identity()); tree.links.len()];
    if options.floating {
        places[tree.root].0 = Some(0);
        out.joints.push(None);
        out.bodies.push(body(None, JointKind::Floating, Vec3::z_axis(), Transform::identity()));
    }
    let mut open = vec![tree.root];
    while let Some(index) = open.pop() {
        let link = &tree.links[index];
        if let Some(joint_index) = link.parent_joint.filter(|j| tree.joints[*j].moves()) {
            let joint = &tree.joints[joint_index];
            let kind = joint_kind(tree, joint, options, warnings)?;
            let (parent, placement) = places[index];
            places[index] = (Some(out.bodies.len()), Transform::identity());
            out.joints.push(Some(joint_index));
            out.bodies.push(body(parent, kind, joint.axis, placement));
        }
        let (carrier, place) = places[index];
        if let Some(carrier) = carrier {
            let sum = &mut out.bodies[carrier].inertia;
            *sum = *sum + inertial::inertia(link).seen_from_parent(place);
        }
        for joint_index in &link.child_joints {
            let joint = &tree.joints[*joint_index];
            places[joint.child] = (carrier, joint.origin.after(place));
        }
        open.extend(link.child_joints.iter().rev().map(|j| tree.joints[*j].child));
    }
    for (link, (carrier, _)) in tree.links.iter().zip(&places) {
        if let Some(carrier) = carrier {
            inertial::check(link, &out.bodies[*carrier].inertia, warnings)?;
        }
    }
    for joint in tree.joints.iter().filter(|j| !j.moves()) {
        if let Some(leader) = &joint.mimics {
            let message = format!("it is fixed, so that its <mimic> of joint `{leader}` has no effect");
            warnings.push(Warning { file: joint.at.clone(), element: format!("joint `{}`", joint.name), message });
        }
    }
    out.links = tree
        .links
        .iter()
        .zip(places)
        .map(|(link, (body, placement))| Link {
            name: link.name.clone(),
            body,
            placement,
            parent: link.parent_joint.map(|j| tree.links[tree.joints[j].parent].name.clone()),
        })
        .collect();
    Ok(out)
}

fn joint_kind(
    tree: &Tree,
    joint: &JointElement,
    options: &LoadOptions,
    warnings: &mut Vec<Warning>,
) -> Result<JointKind, Error> {
    let fault = |problem: String, remedy: String| Error {
        kind: ErrorKind::Urdf,
        file: joint.at.clone(),
        element: format!("joint `{}`", joint.name),
        problem,
        remedy,
    };
    let kind = match joint.kind {
        JointType::Prismatic => JointKind::Prismatic,
        JointType::Floating if joint.parent == tree.root => {
            let child = &tree.links[joint.child].name;
            return Err(fault(
                "a joint of type `floating` inside the tree is not supported".to_owned(),
                format!(
                    "take the joint and its parent out, so that `{child}` is the root, and load with a floating root"
                ),
            ));
        }
        JointType::Floating | JointType::Planar | JointType::Spherical => {
            let name = match joint.kind {
                JointType::Planar => "planar",
                JointType::Floating => "floating",
                _ => "spherical",
            };
            return Err(fault(
                format!("joints of type `{name}` are not supported"),
                "write it as a chain of revolute and prismatic joints through small links, or fix it".to_owned(),
            ));
        }
        _ => JointKind::Revolute,
    };
    let Some(leader) = &joint.mimics else { return Ok(kind) };
    if options.mimic == Some(Mimic::Independent) {
        warnings.push(Warning {
            file: joint.at.clone(),
            element: format!("joint `{}`", joint.name),
            message: format!("it moves on its own: its coupling to joint `{leader}` is dropped, as asked for"),
        });
        return Ok(kind);
    }
    Err(fault(
        format!("it mimics joint `{leader}`, and such couplings are not supported"),
        "make it `fixed`, take <mimic> out, or ask for independent joints (`mimic: independent` in the robot's YAML)"
            .to_owned(),
    ))
}

fn body(parent: Option<usize>, joint: JointKind, axis: Vec3<f64>, placement: Transform<f64>) -> BodySpec {
    BodySpec {
        parent,
        joint,
        axis,
        placement,
        inertia: SpatialInertia::zero(),
        friction: Friction::none(),
        drive: None,
    }
}
