//! Where a rotor sits.

use super::file::MountFile;
use super::merge::Merge;
use super::nearest::nearest;
use super::pose::{direction, pose};
use super::tree::{JointElement, Tree};
use crate::error::Error;
use crate::robot::Link;
use gyroflex::model::MountSpec;

/// The links of the robot and the bodies they belong to.
pub(crate) struct Places<'a> {
    pub(crate) tree: &'a Tree,
    /// In the order of the tree's links.
    pub(crate) links: &'a [Link],
}

/// The mount of a rotor on the body that carries its link.
pub(crate) fn place(
    merge: &mut Merge<'_>,
    joint: &JointElement,
    file: Option<&MountFile>,
    places: &Places<'_>,
) -> Result<MountSpec, Error> {
    let default = MountFile::default();
    let file = file.unwrap_or(&default);
    let link = match &file.link {
        None => joint.parent,
        Some(name) => places.links.iter().position(|l| l.name == *name).ok_or_else(|| {
            let near = nearest(name, places.links.iter().map(|l| l.name.as_str())).unwrap_or("none");
            let remedy = format!("name a link of the URDF; the nearest one is `{near}`");
            merge.fault("rotor.mount.link", format!("there is no link `{name}`"), remedy)
        })?,
    };
    let carrier = &places.links[link];
    // Without a pose on another link, the mount frame is the joint frame.
    let at_joint = link == joint.parent && file.xyz.is_none() && file.rpy.is_none();
    let local = if at_joint { joint.origin } else { pose(file.xyz.unwrap_or_default(), file.rpy.unwrap_or_default()) };
    let axis = match file.axis {
        Some(axis) => direction(axis)
            .ok_or_else(|| merge.fault("rotor.mount.axis", "the spin axis is zero", "give its direction"))?,
        None if at_joint => joint.axis,
        None => {
            let problem =
                "the mount frame is not the joint frame, so that the joint axis says nothing about the spin axis";
            return Err(merge.fault("rotor.mount", problem, "add `axis: [x, y, z]`, in the axes of the mount frame"));
        }
    };
    let given = merge.keys.is_some_and(|k| k.has(&format!("{}.rotor.mount", merge.path)));
    let source = if given { merge.at("rotor.mount") } else { "default".to_owned() };
    let frame = if at_joint { "at the joint".to_owned() } else { format!("at {:?}", local.pos.to_array()) };
    let link_name = &places.tree.links[link].name;
    merge.row("rotor.mount", format!("`{link_name}`, {frame}, axis {:?}", axis.to_array()), "", source);
    Ok(MountSpec { body: carrier.body, placement: local.after(carrier.placement), axis })
}
