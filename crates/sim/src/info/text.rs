//! The same for people.

use super::{DriveInfo, Info, JointInfo};
use crate::inverse::SmoothnessTable;
use crate::modes::Mode;
use std::fmt;

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.gravity;
        writeln!(f, "{}, {} model, gravity [{x}, {y}, {z}] m/s²", self.name, self.model)?;
        let (joints, links) = (self.joints.len(), self.links.len());
        writeln!(f, "joints: {joints}, links: {links}, moving mass: {} kg", digits(self.moving_mass))?;
        writeln!(f, "entries of q: {}, of qd, tau and all others: {}", self.nq, self.nv)?;

        writeln!(f, "\nJoints, in coordinate order")?;
        table(
            f,
            &["q", "joint", "type", "parent", "child", "limits", "link mass [kg]"],
            self.joints.iter().map(joint),
        )?;
        writeln!(f, "\nDrives (link side where not said otherwise)")?;
        let head = [
            "joint",
            "gear ratio",
            "J motor [kg m²]",
            "B [kg m²]",
            "K [N m/rad]",
            "D [N m s/rad]",
            "rotor on",
            "mass [kg]",
        ];
        table(f, &head, self.joints.iter().filter_map(|j| Some(drive(&j.name, j.drive.as_ref()?))))?;
        if !self.flexible_links.is_empty() {
            writeln!(f, "\nLinks that bend: assumed modes, after the joints in coordinate order")?;
            let head = ["mode", "boundary", "K [N/m]", "mass [kg]", "frequency [Hz]", "damping ratio"];
            let rows = self.flexible_links.iter().flat_map(|l| &l.modes).map(|m| {
                let [k, mass, frequency, ratio] = [m.stiffness, m.mass, m.frequency, m.damping_ratio].map(digits);
                vec![m.name.clone(), m.boundary.unwrap_or("table").to_owned(), k, mass, frequency, ratio]
            });
            table(f, &head, rows)?;
        }
        if let Some(modes) = &self.modes {
            let of = if self.flexible_links.is_empty() { "transmissions" } else { "transmissions and links" };
            writeln!(f, "\nModes of the {of} at the zero pose, the fastest first")?;
            table(f, &["frequency [Hz]", "moves most"], modes.modes.iter().rev().map(mode))?;
        }
        writeln!(f, "\nDerivatives of q(t) that the inverse of a model needs")?;
        match &self.smoothness {
            Some(needed) => smoothness(f, needed)?,
            None if self.flexible_links.is_empty() => writeln!(f, "  accelerations are enough: no joint is elastic")?,
            None => writeln!(f, "  accelerations are enough: the links' modes are integrated along the motion")?,
        }
        writeln!(f, "\nFrames")?;
        let frames = self.links.iter().map(|l| {
            let moved_by = l.moved_by.clone().unwrap_or_else(|| "does not move".to_owned());
            vec![l.name.clone(), l.parent.clone().unwrap_or_default(), moved_by]
        });
        table(f, &["link", "parent", "moved by"], frames)?;
        writeln!(f, "\nWhere the numbers come from")?;
        let entries = self
            .table
            .iter()
            .map(|e| vec![e.joint.clone(), e.key.clone(), e.value.clone(), e.unit.to_owned(), e.source.clone()]);
        table(f, &["joint", "key", "value", "unit", "source"], entries)?;
        for (i, warning) in self.warnings.iter().enumerate() {
            writeln!(f, "{}{warning}", if i == 0 { "\nWarnings\n  " } else { "  " })?;
        }
        Ok(())
    }
}

fn joint(j: &JointInfo) -> Vec<String> {
    let limits = j.limits.map_or_else(|| "-".to_owned(), |[a, b]| format!("{} … {}", digits(a), digits(b)));
    let place = j.q_index.to_string();
    vec![place, j.name.clone(), j.kind.clone(), j.parent.clone(), j.child.clone(), limits, digits(j.link_mass)]
}

fn mode(m: &Mode) -> Vec<String> {
    vec![digits(m.frequency), m.moves_most()]
}

fn smoothness(f: &mut fmt::Formatter<'_>, needed: &SmoothnessTable) -> fmt::Result {
    let rows = needed.joints.iter().map(|j| vec![j.joint.clone(), j.complete.to_string(), j.reduced.to_string()]);
    table(f, &["joint", "complete", "reduced"], rows)?;
    let SmoothnessTable { undamped, damped, .. } = needed;
    writeln!(f, "  complete, at most: {damped} if every transmission were damped, {undamped} if none were")?;
    match needed.without_slight_couplings {
        Some(fewer) => {
            writeln!(f, "  complete, at most: {fewer} without couplings below a thousandth of their natural size")
        }
        None => Ok(()),
    }
}

fn drive(name: &str, d: &DriveInfo) -> Vec<String> {
    let (stiffness, damping) = match &d.transmission {
        None => ("rigid".to_owned(), "-".to_owned()),
        Some(t) => (t.stiffness.map_or_else(|| "table".to_owned(), digits), digits(t.damping)),
    };
    let mass = d.rotor.mass.map_or_else(|| "in the link".to_owned(), digits);
    let [ratio, inertia, reflected] = [d.gear_ratio, d.rotor.inertia, d.reflected_inertia].map(digits);
    vec![name.to_owned(), ratio, inertia, reflected, stiffness, damping, d.rotor.mount_link.clone(), mass]
}

/// Six significant digits, which is more than a data sheet has; `--json` has all.
fn digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}").parse().unwrap_or(x);
    if rounded != 0.0 && !(1e-3..1e7).contains(&rounded.abs()) { format!("{rounded:e}") } else { rounded.to_string() }
}

/// Columns as wide as their widest cell.
fn table(f: &mut fmt::Formatter<'_>, head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> fmt::Result {
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return writeln!(f, "  none");
    }
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0).max(head[c].chars().count());
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let head: Vec<String> = head.iter().map(|h| (*h).to_owned()).collect();
    for row in std::iter::once(&head).chain(&rows) {
        let cells = row.iter().zip(&widths).map(|(cell, w)| format!("{cell:<w$}"));
        writeln!(f, "  {}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
    }
    Ok(())
}
