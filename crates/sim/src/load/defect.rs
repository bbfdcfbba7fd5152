//! Errors of the core in the user's words: joint, link, key, remedy.

use super::merge::place_of;
use crate::error::{Error, ErrorKind};
use crate::robot::Robot;
use gyroflex::model::{Defect, ModelError};

/// The error with the names behind its index. `file` is where the joint is described.
pub(crate) fn explain(e: &ModelError, robot: &Robot, file: String) -> Error {
    let joint = robot.joints.get(e.body);
    let name = joint.map_or("", |j| j.name.as_str());
    let child = joint.map_or("", |j| j.child_link.as_str());
    let key = key(&e.defect);
    // A number of a drive stands where the table says it came from.
    let row = key.and_then(|k| robot.table.iter().find(|r| r.joint == name && r.key.starts_with(k)));
    let place = row.map(|r| place_of(&r.source)).filter(|s| *s != "default");
    let element = match (&e.defect, key) {
        _ if joint.is_none() => String::new(),
        (Defect::InertiaNotPositive | Defect::MasslessInertia | Defect::RotorLargerThanLink, _) => {
            format!("link `{child}`")
        }
        (_, Some(key)) => format!("joint `{name}`, {key}"),
        (_, None) => format!("joint `{name}` (link `{child}`)"),
    };
    // Some of the core's texts end in a remedy of their own.
    let text = e.defect.to_string();
    let problem = text.split("; ").next().unwrap_or(&text).to_owned();
    Error {
        kind: ErrorKind::Model,
        file: place.map_or(file, str::to_owned),
        element,
        problem,
        remedy: remedy(&e.defect).to_owned(),
    }
}

/// The key of the drives YAML that a defect is about.
fn key(defect: &Defect) -> Option<&'static str> {
    match defect {
        Defect::ZeroGearRatio => Some("gear_ratio"),
        Defect::MountNotAncestor | Defect::RemoteRigidRotor => Some("rotor.mount"),
        Defect::RotorTooFlat { .. } => Some("rotor.transverse_inertia"),
        Defect::SpringTableNotIncreasing => Some("transmission.table"),
        Defect::TransmissionErrorTooSteep(_) => Some("transmission.error"),
        Defect::NotFinite(what)
        | Defect::NotUnit(what, _)
        | Defect::Negative(what, _)
        | Defect::NotPositive(what, _) => {
            let keys = [
                ("gear ratio", "gear_ratio"),
                ("rotor's transverse", "rotor.transverse_inertia"),
                ("rotor's inertia", "rotor.inertia"),
                ("rotor's mass", "rotor.mass"),
                ("rotor", "rotor.mount"),
                ("cubic", "transmission.cubic"),
                ("stiffness", "transmission.stiffness"),
                ("damping", "transmission.damping"),
                ("transmission", "transmission"),
                ("iction", "friction"),
                ("Stribeck", "friction"),
            ];
            keys.into_iter().find(|(word, _)| what.contains(word)).map(|(_, key)| key)
        }
        _ => None,
    }
}

fn remedy(defect: &Defect) -> &'static str {
    match defect {
        Defect::ParentNotBefore => "list bodies so that parents come first",
        Defect::FloatingNotAtRoot => "let only the root float",
        Defect::BesideFloating => "hang it on a body of the robot",
        Defect::NotFinite(_) => "give a finite number",
        Defect::NotUnit(..) => "give a direction of length 1",
        Defect::NotARotation(_) => "give an orthonormal, right-handed matrix",
        Defect::Negative(..) => "give zero or a positive number",
        Defect::NotPositive(what, _) if what.contains("stiffness") => {
            "give a positive stiffness, or `transmission: rigid` for a gear that does not give"
        }
        Defect::NotPositive(..) => "give a positive number",
        Defect::InertiaNotPositive => {
            "check the signs of the products of inertia, and that the inertia is about the centre of mass"
        }
        Defect::MasslessInertia => "give the link a mass, or take its moment of mass and its inertia out",
        Defect::NothingToMove => "give the links it moves a mass and an inertia, or make the joint fixed",
        Defect::RotorLargerThanLink => {
            "give `rotor.mass`, if the URDF does not contain the rotor, so that it is added; \
             else check the inertias, or `rotor.mount`"
        }
        Defect::ZeroGearRatio => "give rotor turns per joint turn, 1 for a direct drive",
        Defect::MountNotAncestor => "name the joint's parent link, or one further in towards the root",
        Defect::RotorTooFlat { .. } => "give at least half of `rotor.inertia`, or leave it out",
        Defect::SpringTableNotIncreasing => "list points [deflection, torque], both columns strictly increasing",
        Defect::TransmissionErrorTooSteep(_) => "make `amplitude` or `cycles_per_rotor_turn` smaller",
        Defect::RemoteRigidRotor => {
            "name the joint's parent link in `rotor.mount`, or give its `transmission` a stiffness"
        }
        Defect::FlexibleRecords(_) | Defect::NoStation => {
            "describe the link under `flexible_links` of the robot's YAML"
        }
        Defect::TooFewKnots | Defect::TooFewBodies => "the robot is too large: at most 65534 joints and spring points",
    }
}
