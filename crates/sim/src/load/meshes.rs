//! Mesh files: dynamics does not need them, but a viewer will.

use super::source::FileSource;
use super::xml::Xml;
use crate::error::Warning;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// So many missing files are named one by one.
const NAMED: usize = 3;

/// Warns of mesh files that are not there. Of packages that cannot be found one warning tells, whatever they hold.
pub(crate) fn check(xml: &Xml<'_>, files: &dyn FileSource, urdf: &Path) -> Vec<Warning> {
    let folder = urdf.parent().unwrap_or(Path::new(""));
    let mut missing: BTreeMap<&str, Warning> = BTreeMap::new();
    let mut packages: BTreeMap<&str, (usize, Warning)> = BTreeMap::new();
    for mesh in xml.root().descendants().filter(|n| n.has_tag_name("mesh")) {
        let Some(name) = mesh.attribute("filename") else { continue };
        let found = match name.strip_prefix("package://").or_else(|| name.strip_prefix("model://")) {
            Some(rest) => {
                let package = rest.split('/').next().unwrap_or(rest);
                match package_root(files, folder, package) {
                    Some(root) => files.exists(&root.join(rest.get(package.len() + 1..).unwrap_or(""))),
                    None => {
                        packages.entry(package).or_insert_with(|| (0, xml.warning(mesh, ""))).0 += 1;
                        continue;
                    }
                }
            }
            None => files.exists(&folder.join(name.strip_prefix("file://").unwrap_or(name))),
        };
        if !found {
            missing.entry(name).or_insert_with(|| xml.warning(mesh, ""));
        }
    }
    let more = missing.len().saturating_sub(NAMED);
    let mut warnings: Vec<Warning> = missing
        .into_iter()
        .take(NAMED)
        .map(|(name, at)| Warning {
            message: format!("the mesh file `{name}` is missing; dynamics does not need it"),
            ..at
        })
        .collect();
    if let (Some(last), true) = (warnings.last_mut(), more > 0) {
        last.message += &format!(" ({more} more are missing)");
    }
    if let Some((_, (_, first))) = packages.iter().next() {
        let meshes: usize = packages.values().map(|(count, _)| count).sum();
        let names: Vec<&str> = packages.keys().copied().collect();
        warnings.push(Warning {
            message: format!(
                "{meshes} meshes are in the package{} `{}`, which no folder around the URDF holds; dynamics does not need them",
                if names.len() == 1 { "" } else { "s" },
                names.join("`, `")
            ),
            ..first.clone()
        });
    }
    warnings
}

/// The folder of a package: one of this name among or beside the folders that the URDF is in.
fn package_root(files: &dyn FileSource, folder: &Path, package: &str) -> Option<PathBuf> {
    let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let around = [folder.to_owned(), absolute];
    let mut places = around.iter().flat_map(|f| f.ancestors());
    places.find_map(|place| {
        if place.file_name().is_some_and(|n| n == package) {
            return Some(place.to_owned());
        }
        let beside = place.join(package);
        files.exists(&beside).then_some(beside)
    })
}
