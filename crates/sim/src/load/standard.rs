//! The standard part of a URDF, read by urdf-rs.
//!
//! urdf-rs refuses files that other tools take (a limit without velocity, an undeclared prefix), drops words of a vector
//! that are no numbers, and knows no lines. So every element is checked here first, with its line, and urdf-rs gets the
//! elements that concern dynamics, written out in full.

use super::nearest::nearest;
use super::xml::{Xml, child, children};
use crate::error::Error;
use roxmltree::Node;
use std::fmt::Write;

const JOINT_TYPES: [&str; 7] = ["revolute", "continuous", "prismatic", "fixed", "floating", "planar", "spherical"];
const MOMENTS: [&str; 6] = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];

/// The elements of a URDF in urdf-rs's types, links and joints each in the order of the file.
pub(crate) fn read(xml: &Xml<'_>) -> Result<urdf_rs::Robot, Error> {
    let root = xml.root();
    let mut out = String::from("<robot");
    // Any name will do here: the caller takes it from the element.
    attributes(&mut out, &[("name", Some("robot")), ("version", root.attribute("version"))]);
    out.push('>');
    for link in children(root, "link") {
        copy_link(xml, link, &mut out)?;
    }
    for joint in children(root, "joint") {
        copy_joint(xml, joint, &mut out)?;
    }
    out.push_str("</robot>");
    urdf_rs::read_from_string(&out)
        .map_err(|e| xml.error(root, format!("urdf-rs cannot read it: {e}"), "compare it with the URDF specification"))
}

fn copy_link(xml: &Xml<'_>, link: Node<'_, '_>, out: &mut String) -> Result<(), Error> {
    out.push_str("<link");
    attributes(out, &[("name", Some(name(xml, link)?))]);
    out.push('>');
    if let Some(inertial) = child(link, "inertial") {
        let part = |name: &'static str| {
            child(inertial, name).ok_or_else(|| {
                xml.error(
                    inertial,
                    format!("<inertial> has no <{name}>"),
                    format!("add <{name}>, or take <inertial> out"),
                )
            })
        };
        let (mass, inertia) = (part("mass")?, part("inertia")?);
        xml.number(mass, "value", xml.attribute(mass, "value")?)?;
        let mut moments = Vec::new();
        for moment in MOMENTS {
            let text = xml.attribute(inertia, moment)?;
            xml.number(inertia, moment, text)?;
            moments.push((moment, Some(text)));
        }
        out.push_str("<inertial>");
        copy_origin(xml, inertial, out)?;
        out.push_str("<mass");
        attributes(out, &[("value", mass.attribute("value"))]);
        out.push_str("/><inertia");
        attributes(out, &moments);
        out.push_str("/></inertial>");
    }
    out.push_str("</link>");
    Ok(())
}

fn copy_joint(xml: &Xml<'_>, joint: Node<'_, '_>, out: &mut String) -> Result<(), Error> {
    let kind = xml.attribute(joint, "type")?;
    if !JOINT_TYPES.contains(&kind) {
        let near = nearest(kind, JOINT_TYPES).unwrap_or_default();
        let remedy = format!("the nearest known one is `{near}`; known are {}", JOINT_TYPES.join(", "));
        return Err(xml.error(joint, format!("`{kind}` is no joint type"), remedy));
    }
    out.push_str("<joint");
    attributes(out, &[("name", Some(name(xml, joint)?)), ("type", Some(kind))]);
    out.push('>');
    copy_origin(xml, joint, out)?;
    for end in ["parent", "child"] {
        let node = child(joint, end)
            .ok_or_else(|| xml.error(joint, format!("it has no <{end}>"), format!("add <{end} link=\"…\"/>")))?;
        let _ = write!(out, "<{end}");
        attributes(out, &[("link", Some(xml.attribute(node, "link")?))]);
        out.push_str("/>");
    }
    if let Some(axis) = child(joint, "axis") {
        xml.attribute(axis, "xyz")?;
        xml.numbers::<3>(axis, "xyz")?;
        out.push_str("<axis");
        attributes(out, &[("xyz", axis.attribute("xyz"))]);
        out.push_str("/>");
    }
    copy_limit(xml, joint, out)?;
    if let Some(dynamics) = child(joint, "dynamics") {
        for key in ["damping", "friction"] {
            xml.numbers::<1>(dynamics, key)?;
        }
        out.push_str("<dynamics");
        attributes(out, &["damping", "friction"].map(|key| (key, dynamics.attribute(key))));
        out.push_str("/>");
    }
    if let Some(mimic) = child(joint, "mimic") {
        out.push_str("<mimic");
        attributes(out, &[("joint", Some(xml.attribute(mimic, "joint")?))]);
        out.push_str("/>");
    }
    out.push_str("</joint>");
    Ok(())
}

/// Limits in full: what is absent is no limit, except that a range with one end given starts or ends at 0, as specified.
fn copy_limit(xml: &Xml<'_>, joint: Node<'_, '_>, out: &mut String) -> Result<(), Error> {
    let Some(limit) = child(joint, "limit") else { return Ok(()) };
    let mut given = ["lower", "upper", "effort", "velocity"].map(|key| (key, limit.attribute(key)));
    for (key, _) in given {
        if xml.limit(limit, key)?.is_some_and(|x| x < 0.0) && matches!(key, "effort" | "velocity") {
            let problem = format!("the limit `{key}` is negative");
            return Err(xml.error(limit, problem, "give its magnitude, or leave it out where there is no limit"));
        }
    }
    let one_end = given[0].1.is_some() != given[1].1.is_some();
    for (key, text) in &mut given {
        *text = text.or(Some(match *key {
            "lower" | "upper" if one_end => "0",
            "lower" => "-inf",
            _ => "inf",
        }));
    }
    out.push_str("<limit");
    attributes(out, &given);
    out.push_str("/>");
    Ok(())
}

fn copy_origin(xml: &Xml<'_>, node: Node<'_, '_>, out: &mut String) -> Result<(), Error> {
    let Some(origin) = child(node, "origin") else { return Ok(()) };
    xml.numbers::<3>(origin, "xyz")?;
    xml.numbers::<3>(origin, "rpy")?;
    xml.numbers::<4>(origin, "quat_xyzw")?;
    out.push_str("<origin");
    attributes(out, &["xyz", "rpy", "quat_xyzw"].map(|key| (key, origin.attribute(key))));
    out.push_str("/>");
    Ok(())
}

/// The name of a link or joint, which must not be empty.
fn name<'n>(xml: &Xml<'_>, node: Node<'n, '_>) -> Result<&'n str, Error> {
    let name = xml.attribute(node, "name")?;
    if name.trim().is_empty() {
        return Err(xml.error(node, "its name is empty", "give it a name of its own"));
    }
    Ok(name)
}

fn attributes(out: &mut String, pairs: &[(&str, Option<&str>)]) {
    for (key, value) in pairs {
        let Some(value) = value else { continue };
        let _ = write!(out, " {key}=\"");
        for c in value.chars() {
            match c {
                '&' => out.push_str("&amp;"),
                '<' => out.push_str("&lt;"),
                '>' => out.push_str("&gt;"),
                '"' => out.push_str("&quot;"),
                other => out.push(other),
            }
        }
        out.push('"');
    }
}
