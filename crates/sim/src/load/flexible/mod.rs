//! Links that bend, from the robot's YAML: beams, and what sits on them.

mod attach;
mod file;
mod modes;
mod number;

pub use file::{
    AtFile, AtName, BodyFile, BoundaryName, DampingFile, FlexibleLinkFile, InertiaFile, LumpFile, ModesFile,
    OriginFile, ProfileFile, ShapeFile, TipFile,
};

use super::file::DriveFile;
use super::inertial;
use super::nearest::nearest;
use super::pose::pose;
use super::tree::Tree;
use super::yaml::Keys;
use crate::beam::{Beam, BeamError, Profile};
use crate::error::{Error, Warning};
use crate::flexible::{Flexure, ModeInfo, StationInfo};
use crate::robot::{Entry, Robot};
use file::AtFile as At;
use gyroflex::model::TransmissionSpec;
use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};
use number::Numbers;
use std::collections::BTreeMap;

/// What the YAML says of links that bend, and what it needs to be put on a robot.
pub(super) struct FlexibleFiles<'a> {
    pub(super) links: &'a BTreeMap<String, FlexibleLinkFile>,
    pub(super) drives: &'a BTreeMap<String, DriveFile>,
    pub(super) tree: &'a Tree,
    pub(super) keys: &'a Keys,
}

/// A part of the mass by which URDF and beam may differ without a word.
const SAME_MASS: f64 = 0.01;

impl FlexibleFiles<'_> {
    /// Makes the links of a rigid robot bend; their URDF inertias are replaced.
    pub(super) fn put_on(&self, robot: &mut Robot) -> Result<(), Error> {
        let mut links = Vec::new();
        for (name, file) in self.links {
            let key = format!("flexible_links.{name}");
            let body = self.body(robot, name, &key)?;
            links.push((body, name, file, key));
        }
        links.sort_by_key(|(body, ..)| *body);
        for (body, name, file, key) in links {
            let flexure = self.flexure(name, body, file, &key)?;
            self.compare_masses(robot, &flexure, &key);
            tell(robot, &flexure, file, self.keys, &key);
            robot.flexible.links.push(flexure);
        }
        let modes = robot.flexible.modes();
        if modes > usize::from(u16::MAX) {
            let problem = format!("{modes} modes are more than {}", u16::MAX);
            return Err(self.keys.error("flexible_links", problem, "take fewer modes, or bend fewer links"));
        }
        if !robot.flexible.is_empty() {
            self.refuse_remote_rotors(robot)?;
            self.attach(robot);
        }
        Ok(())
    }

    /// The body that a link is, which must be the link its joint moves.
    fn body(&self, robot: &Robot, name: &str, key: &str) -> Result<usize, Error> {
        let Some(link) = robot.links.iter().find(|l| l.name == name) else {
            let near = nearest(name, robot.joints.iter().map(|j| j.child_link.as_str()));
            let near = near.map_or_else(String::new, |n| format!("; the nearest one that moves is `{n}`"));
            let problem = format!("there is no link `{name}`");
            return Err(self.keys.error(key, problem, format!("name a link of the URDF{near}")));
        };
        let Some(body) = link.body else {
            let problem = format!("link `{name}` is fixed to the world, and only links that move can bend");
            return Err(self.keys.error(key, problem, "name a link that a joint moves"));
        };
        let carrier = &robot.joints[body].child_link;
        if carrier != name {
            let problem = format!("link `{name}` is fixed to link `{carrier}`, and is one body with it");
            return Err(self.keys.error(key, problem, format!("let `{carrier}` bend, `{name}` moves with its tip")));
        }
        Ok(body)
    }

    /// The recursions of robots that bend know no rigidly geared rotor but on the joint's parent.
    fn refuse_remote_rotors(&self, robot: &Robot) -> Result<(), Error> {
        for (body, joint) in robot.bodies.iter().zip(&robot.joints) {
            let Some(drive) = body.drive else { continue };
            let on = drive.rotor.mount.body;
            if matches!(drive.transmission, TransmissionSpec::Rigid) && on.is_some() && on != body.parent {
                let problem = "its gear is rigid and its rotor not on the parent link, which robots with links that bend cannot have";
                let remedy = "mount it on the joint's parent link, or give `transmission` its stiffness";
                return Err(self.keys.error(&format!("drives.{}.rotor.mount", joint.name), problem, remedy));
            }
        }
        Ok(())
    }

    fn flexure(&self, name: &str, body: usize, file: &FlexibleLinkFile, key: &str) -> Result<Flexure, Error> {
        let numbers = Numbers { keys: self.keys, key };
        numbers.positive("length", file.length)?;
        let length = file.length;
        let mass_per_length = numbers.profile("mass_per_length", &file.mass_per_length, length, true)?;
        let polar_inertia_per_length = match &file.polar_inertia_per_length {
            Some(polar) => numbers.profile("polar_inertia_per_length", polar, length, false)?,
            None => Profile::Constant(0.0),
        };
        let placement = pose(file.origin.xyz, file.origin.rpy);
        let stations = self.lumps(name, file, placement, &numbers)?;
        let mut beam = Beam {
            length,
            mass_per_length,
            polar_inertia_per_length,
            modes: Vec::new(),
            stiffening: file.geometric_stiffening,
        };
        let named = modes::read(&mut beam, file, &stations, placement, &numbers)?;
        let points = file.quadrature_points.unwrap_or_else(|| beam.enough_points());
        beam.check(points).map_err(|e| defect(&e, &named, &numbers))?;
        let own = beam.integrals(points);
        let modes = named.into_iter().enumerate().map(|(j, (mode, boundary))| ModeInfo {
            name: format!("{name}.{mode}"),
            boundary,
            figures: beam.figures(j, &own),
        });
        let modes = modes.collect();
        let integrals = own.seen_from_parent(placement);
        let hub = match &file.hub {
            Some(hub) => rigid_body(hub.mass, hub.xyz, hub.inertia, &numbers, "hub")?,
            None => SpatialInertia::zero(),
        };
        let inertia = integrals.inertia + hub;
        Ok(Flexure { name: name.to_owned(), body, beam, placement, integrals, inertia, modes, stations })
    }

    /// The tip, and a station for every lumped mass.
    fn lumps(
        &self,
        name: &str,
        file: &FlexibleLinkFile,
        placement: Transform<f64>,
        numbers: &Numbers<'_>,
    ) -> Result<Vec<StationInfo>, Error> {
        let station = |x: f64, name: String| StationInfo { name, x, inertia: SpatialInertia::zero() };
        let mut stations = vec![station(file.length, format!("{name}.tip"))];
        for (i, lump) in file.masses.iter().enumerate() {
            let key = format!("masses[{i}]");
            let x = match lump.at {
                At::Named(AtName::Tip) => file.length,
                At::Distance(x) if (0.0..=file.length).contains(&x) => x,
                At::Distance(x) => {
                    let problem = format!("{x} m is not on the beam, which is {} m long", file.length);
                    return Err(numbers.error(
                        &format!("{key}.at"),
                        problem,
                        "give a distance from its root, or `tip`",
                    ));
                }
            };
            let own = rigid_body(lump.mass, lump.xyz, lump.inertia, numbers, &key)?;
            let inertia = own.moved(Vec3::new(x, 0.0, 0.0)).seen_from_parent(placement);
            let index = stations.iter().position(|s| (s.x - x).abs() <= 1e-9 * file.length).unwrap_or_else(|| {
                stations.push(station(x, format!("{name}.mass{}", i + 1)));
                stations.len() - 1
            });
            stations[index].inertia = stations[index].inertia + inertia;
        }
        Ok(stations)
    }

    /// A warning where the URDF has another mass than what replaces it.
    fn compare_masses(&self, robot: &mut Robot, flexure: &Flexure, key: &str) {
        let Some(link) = self.tree.links.iter().find(|l| l.name == flexure.name) else { return };
        let Some(inertial) = &link.inertial else { return };
        // To the milligram: what rounding adds is not worth reading.
        let [urdf, here] = [inertial.mass.value, flexure.total_inertia().mass].map(|m| (m * 1e6).round() / 1e6);
        if (urdf - here).abs() > SAME_MASS * urdf.abs().max(here) {
            let message = format!(
                "beam, hub and masses weigh {here} kg, but the URDF gives the link {urdf} kg ({}); what stands here counts",
                link.at
            );
            robot.warnings.push(Warning { file: self.keys.locate(key), element: key.to_owned(), message });
        }
    }
}

/// A rigid body about the origin of the frame that its numbers are given in.
fn rigid_body(
    mass: f64,
    xyz: [f64; 3],
    inertia: InertiaFile,
    numbers: &Numbers<'_>,
    key: &str,
) -> Result<SpatialInertia<f64>, Error> {
    numbers.not_negative(&format!("{key}.mass"), mass)?;
    let [xx, yy, zz, xy, xz, yz] = inertia.six();
    let about_com = SymMat3 { xx, yy, zz, xy, xz, yz };
    if let Some(problem) = inertial::unphysical(&about_com) {
        let remedy = "give one moment about every axis, or [ixx, iyy, izz, ixy, ixz, iyz] about the centre of mass";
        return Err(numbers.error(&format!("{key}.inertia"), problem, remedy));
    }
    Ok(SpatialInertia::from_com(mass, Vec3::from(xyz), about_com))
}

/// What is wrong with a beam, in the words of its file.
fn defect(e: &BeamError, modes: &[modes::Named], numbers: &Numbers<'_>) -> Error {
    let name = |j: usize| modes.get(j).map_or("", |(name, _)| name.as_str());
    let kind = |j: usize| name(j).trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
    match e {
        BeamError::TooFewPoints(needed) => numbers.error(
            "quadrature_points",
            "so few points do not integrate the highest mode".to_owned(),
            format!("give at least {needed}, or leave it out"),
        ),
        BeamError::Massless(j) => numbers.error(
            &kind(*j),
            format!("mode `{}` moves no mass", name(*j)),
            "give `polar_inertia_per_length`, the inertia that torsion turns, or leave the mode out",
        ),
        BeamError::Dependent(j) => numbers.error(
            &kind(*j),
            format!("mode `{}` is a sum of the modes before it", name(*j)),
            "take it out: it adds no deflection that they do not have",
        ),
    }
}

/// Rows of the merged table.
fn tell(robot: &mut Robot, flexure: &Flexure, file: &FlexibleLinkFile, keys: &Keys, key: &str) {
    let joint = &robot.joints[flexure.body].name;
    let profile = |p: &ProfileFile| match p {
        ProfileFile::Constant(value) => value.to_string(),
        ProfileFile::Table(points) => format!("{} points", points.len()),
    };
    let mut row = |name: &str, value: String, unit: &'static str| {
        let at = format!("{key}.{name}");
        let source = if keys.has(&at) { keys.locate(&at) } else { "default".to_owned() };
        robot.table.push(Entry { joint: joint.clone(), key: format!("flexible.{name}"), value, unit, source });
    };
    row("length", file.length.to_string(), "m");
    row("mass_per_length", profile(&file.mass_per_length), "kg/m");
    if let Some(polar) = &file.polar_inertia_per_length {
        row("polar_inertia_per_length", profile(polar), "kg m");
    }
    for (deflection, modes) in modes::kinds(file) {
        let kind = deflection.name();
        if let Some(stiffness) = &modes.stiffness {
            let unit = if kind == "extension" { "N" } else { "N m²" };
            row(&format!("{kind}.stiffness"), profile(stiffness), unit);
        }
        match &modes.shapes {
            Some(shapes) => row(&format!("{kind}.shapes"), format!("{} tables", shapes.len()), ""),
            None => {
                let boundary = modes.boundary.unwrap_or(BoundaryName::ClampedFree).with(modes.tip);
                row(&format!("{kind}.boundary"), boundary.name().to_owned(), "");
                row(&format!("{kind}.modes"), modes.modes.unwrap_or(1).to_string(), "");
            }
        }
        let damping = match &modes.damping {
            Some(DampingFile::Each(each)) => format!("{each:?}"),
            Some(DampingFile::All(all)) => all.to_string(),
            None => "0".to_owned(),
        };
        row(&format!("{kind}.damping"), damping, "");
    }
    row("geometric_stiffening", file.geometric_stiffening.to_string(), "");
}
