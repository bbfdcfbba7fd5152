//! What URDF dialects say about motors: `<transmission>` of ROS and its `motorInertia`, and Drake's tags.

use super::nearest::nearest;
use super::tree::Tree;
use super::xml::{Xml, children};
use crate::error::{Error, Warning};
use roxmltree::Node;
use std::collections::{BTreeMap, HashMap};

/// A number with the place it comes from.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tagged {
    pub(crate) value: f64,
    /// File, line and tag.
    pub(crate) source: String,
}

/// What the tags say about the drive of one joint. Several entries mean several tags.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tags {
    /// Rotor turns per joint turn.
    pub(crate) gear_ratio: Vec<Tagged>,
    /// Rotor inertia, motor side [kg m²].
    pub(crate) rotor_inertia: Vec<Tagged>,
}

/// The tags of all joints that have any.
pub(crate) type TagsByJoint = HashMap<String, Tags>;

/// Reads all dialects.
pub(crate) fn read(xml: &Xml<'_>, tree: &Tree, warnings: &mut Vec<Warning>) -> Result<TagsByJoint, Error> {
    let mut all = TagsByJoint::new();
    let mut unsupported: BTreeMap<String, (usize, Warning)> = BTreeMap::new();
    for transmission in children(xml.root(), "transmission") {
        let kind = kind(transmission);
        let joints: Vec<_> = children(transmission, "joint").collect();
        let actuators: Vec<_> = children(transmission, "actuator").collect();
        if !is_simple(&kind) || joints.len() != 1 || actuators.len() > 1 {
            let first = xml.warning(transmission, "");
            unsupported.entry(kind).or_insert((0, first)).0 += 1;
            continue;
        }
        let Some(name) = joints[0].attribute("name") else {
            return Err(xml.error(joints[0], "the joint of a transmission has no name", "write <joint name=\"…\">"));
        };
        if !tree.joints.iter().any(|j| j.name == name) {
            let near = nearest(name, tree.joints.iter().map(|j| j.name.as_str())).unwrap_or("none");
            let message = format!("ignored: the file has no joint `{name}`; the nearest one is `{near}`");
            warnings.push(xml.warning(transmission, message));
            continue;
        }
        let tags = all.entry(name.to_owned()).or_default();
        for place in [Some(transmission), Some(joints[0]), actuators.first().copied()].into_iter().flatten() {
            collect(xml, place, tags)?;
        }
    }
    for (kind, (count, mut first)) in unsupported {
        let times = if count == 1 { String::new() } else { format!(", like {} more of this type", count - 1) };
        first.message =
            format!("ignored{times}: only simple transmissions from one motor to one joint are read, not `{kind}`");
        warnings.push(first);
    }
    for joint in children(xml.root(), "joint") {
        let Some(name) = joint.attribute("name") else { continue };
        let mut tags = Tags::default();
        collect(xml, joint, &mut tags)?;
        for actuator in children(joint, "actuator") {
            collect(xml, actuator, &mut tags)?;
        }
        if !tags.gear_ratio.is_empty() || !tags.rotor_inertia.is_empty() {
            let entry = all.entry(name.to_owned()).or_default();
            entry.gear_ratio.extend(tags.gear_ratio);
            entry.rotor_inertia.extend(tags.rotor_inertia);
        }
    }
    Ok(all)
}

/// Takes the motor numbers directly below a node.
fn collect(xml: &Xml<'_>, place: Node<'_, '_>, tags: &mut Tags) -> Result<(), Error> {
    for node in place.children().filter(Node::is_element) {
        let tag = xml.qualified(node);
        let into = match tag {
            "mechanicalReduction" | "mechanical_reduction" | "drake:gear_ratio" => &mut tags.gear_ratio,
            "motorInertia" | "motor_inertia" | "drake:rotor_inertia" => &mut tags.rotor_inertia,
            _ => continue,
        };
        let text = node.attribute("value").or(node.text()).unwrap_or("");
        let value = xml.number(node, tag, text)?;
        into.push(Tagged { value, source: format!("{} <{tag}>", xml.at(node)) });
    }
    Ok(())
}

/// The type of a transmission: an element in ROS, an attribute in older files; files for Drake may leave it out.
fn kind(transmission: Node<'_, '_>) -> String {
    let element = children(transmission, "type").next().and_then(|t| t.text());
    element.or(transmission.attribute("type")).unwrap_or("").trim().to_owned()
}

fn is_simple(kind: &str) -> bool {
    kind.is_empty() || kind.rsplit(['/', ':']).next() == Some("SimpleTransmission")
}

impl Tags {
    /// Whether nothing is said.
    pub(crate) fn is_empty(&self) -> bool {
        self.gear_ratio.is_empty() && self.rotor_inertia.is_empty()
    }

    /// Where the first tag stands.
    pub(crate) fn first_source(&self) -> Option<&String> {
        self.gear_ratio.first().or(self.rotor_inertia.first()).map(|t| &t.source)
    }
}
