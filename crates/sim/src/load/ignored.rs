//! Tags and attributes of a URDF without effect here, each kind reported once.

use super::nearest::nearest;
use super::xml::Xml;
use crate::error::Warning;
use roxmltree::Node;
use std::collections::HashMap;

/// An element that is read: the children and attributes that have an effect, or are known to need none.
struct Known {
    children: &'static [&'static str],
    attributes: &'static [&'static str],
}

/// What is known of an element below `<robot>`; `None` where nothing inside is looked at.
fn known(tag: &str) -> Option<Known> {
    let (children, attributes): (&[&str], &[&str]) = match tag {
        "robot" => (&["link", "joint", "material", "transmission"], &["name", "version"]),
        "link" => (&["inertial", "visual", "collision"], &["name"]),
        "inertial" => (&["origin", "mass", "inertia"], &[]),
        "mass" => (&[], &["value"]),
        "inertia" => (&[], &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"]),
        "joint" => {
            (&["origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "actuator"], &["name", "type"])
        }
        "origin" => (&[], &["xyz", "rpy", "quat_xyzw"]),
        "parent" | "child" => (&[], &["link"]),
        "axis" => (&[], &["xyz"]),
        "limit" => (&[], &["lower", "upper", "effort", "velocity"]),
        "dynamics" => (&[], &["damping", "friction"]),
        "mimic" => (&[], &["joint", "multiplier", "offset"]),
        "transmission" | "actuator" => (&["type", "joint", "actuator", "hardwareInterface"], &["name", "type"]),
        _ => return None,
    };
    Some(Known { children, attributes })
}

/// Tags that the dialects' reader takes, wherever a motor may be described.
const MOTOR_TAGS: [&str; 6] = [
    "mechanicalReduction",
    "mechanical_reduction",
    "motorInertia",
    "motor_inertia",
    "drake:gear_ratio",
    "drake:rotor_inertia",
];

/// One warning for every kind of thing without effect, at its first place.
pub(crate) fn report(xml: &Xml<'_>) -> Vec<Warning> {
    let mut kinds = Kinds { xml, order: Vec::new(), index: HashMap::new() };
    visit(&mut kinds, xml.root(), "robot");
    kinds.order.into_iter().map(|k| k.warning()).collect()
}

/// Below `<robot>` a URDF is at most six levels deep, and only known elements are entered.
fn visit(kinds: &mut Kinds<'_, '_>, node: Node<'_, '_>, tag: &'static str) {
    let Some(known) = known(tag) else { return };
    for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
        let name = attribute.name();
        if !known.attributes.contains(&name) {
            kinds.note(node, format!("`{name}` of <{tag}>"), reason(tag, name, known.attributes));
        }
    }
    let mut seen: Vec<&str> = Vec::new();
    for child in node.children().filter(Node::is_element) {
        let name = kinds.xml.qualified(child);
        if let Some(known_child) = known.children.iter().find(|c| **c == name) {
            let many = matches!(*known_child, "link" | "joint" | "material" | "transmission" | "visual" | "collision");
            if (!many || tag == "joint") && seen.contains(known_child) {
                kinds.note(child, format!("the second <{name}> of <{tag}>"), "the first one counts".to_owned());
                continue;
            }
            seen.push(known_child);
            // Of a transmission's joint only the name is of interest.
            let inner = if tag == "transmission" && *known_child == "joint" { "actuator" } else { *known_child };
            visit(kinds, child, inner);
        } else if !(MOTOR_TAGS.contains(&name) && matches!(tag, "joint" | "transmission" | "actuator")) {
            kinds.note(child, format!("<{name}> in <{tag}>"), reason(tag, name, known.children));
        }
    }
}

/// Why something has no effect, or what to do instead.
fn reason(tag: &str, name: &str, known: &[&str]) -> String {
    match (tag, name) {
        ("dynamics", "stiffness" | "K" | "spring_stiffness" | "spring_reference" | "springref") => {
            "dialects mean a spring beside the joint by it, not the series spring of a drive; \
             give that as `transmission: {stiffness: …}` in the robot's YAML"
                .to_owned()
        }
        ("dynamics", "rotor_inertia" | "armature") => "dialects disagree whether it is reflected through the gear; \
             give `rotor: {inertia: …}` and `gear_ratio` in the robot's YAML"
            .to_owned(),
        ("dynamics", _) => "give `friction: {link: {viscous: …, coulomb: …}}` in the robot's YAML".to_owned(),
        ("limit" | "transmission" | "actuator" | "link" | "joint" | "robot", _) => {
            let near = nearest(name, known.iter().copied()).filter(|n| strsim::damerau_levenshtein(n, name) <= 2);
            near.map_or_else(String::new, |n| format!("is `{n}` meant?"))
        }
        _ => nearest(name, known.iter().copied()).map_or_else(String::new, |n| format!("is `{n}` meant?")),
    }
}

struct Kinds<'x, 'i> {
    xml: &'x Xml<'i>,
    order: Vec<Kind>,
    index: HashMap<String, usize>,
}

struct Kind {
    what: String,
    reason: String,
    count: usize,
    first: Warning,
}

impl Kinds<'_, '_> {
    fn note(&mut self, node: Node<'_, '_>, what: String, reason: String) {
        let next = self.order.len();
        let at = *self.index.entry(what.clone()).or_insert(next);
        if at == next {
            self.order.push(Kind { what, reason, count: 0, first: self.xml.warning(node, "") });
        }
        self.order[at].count += 1;
    }
}

impl Kind {
    fn warning(self) -> Warning {
        let times = if self.count == 1 { String::new() } else { format!(" ({} times, first here)", self.count) };
        let reason = if self.reason.is_empty() { String::new() } else { format!("; {}", self.reason) };
        Warning { message: format!("ignored: {}{times}{reason}", self.what), ..self.first }
    }
}
