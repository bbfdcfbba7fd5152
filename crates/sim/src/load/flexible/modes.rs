//! The modes of a beam, from eigenfunctions and from tables.

use super::file::{BoundaryName, DampingFile, FlexibleLinkFile, ModesFile, ShapeFile};
use super::number::{Numbers, stretch};
use crate::beam::{Beam, BeamMode, Boundary, Deflection, Profile, Resistance, Shape, Table};
use crate::error::Error;
use crate::flexible::StationInfo;
use gyroflex::spatial::{Transform, Vec3};

/// A mode's name on its link, such as `bending_y1`, and its boundary.
pub(super) type Named = (String, Option<Boundary>);

/// More eigenfunctions of one kind describe nothing: beams are not slender to their short waves.
const MOST_MODES: usize = 64;
/// What a shape may have where its boundary says zero, as part of its largest value.
const ZERO: f64 = 1e-6;
/// A part of the declared generalised mass by which a shape may miss it.
const SAME_MASS: f64 = 0.01;

/// What the file says, kind by kind.
pub(super) fn kinds(file: &FlexibleLinkFile) -> impl Iterator<Item = (Deflection, &ModesFile)> {
    let files = [&file.bending_y, &file.bending_z, &file.torsion, &file.extension];
    Deflection::ALL.into_iter().zip(files).filter_map(|(deflection, modes)| Some((deflection, modes.as_ref()?)))
}

/// Gives a beam its modes, and says what they are called.
pub(super) fn read(
    beam: &mut Beam,
    file: &FlexibleLinkFile,
    stations: &[StationInfo],
    placement: Transform<f64>,
    numbers: &Numbers<'_>,
) -> Result<Vec<Named>, Error> {
    let mut named = Vec::new();
    for (deflection, modes) in kinds(file) {
        let kind = Kind { deflection, modes, numbers, key: deflection.name() };
        let resistance = modes.stiffness.as_ref();
        let resistance =
            resistance.map(|s| numbers.profile(&kind.key("stiffness"), s, beam.length, true)).transpose()?;
        let (more, boundary) = match &modes.shapes {
            Some(shapes) => (kind.tables(beam, shapes, resistance, stations, placement)?, None),
            None => {
                let boundary = kind.boundary()?;
                (kind.eigenfunctions(beam, boundary, resistance)?, Some(boundary))
            }
        };
        let damping = kind.damping(more.len())?;
        for (i, (mode, damping_ratio)) in more.into_iter().zip(damping).enumerate() {
            named.push((format!("{}{}", deflection.name(), i + 1), boundary));
            beam.modes.push(BeamMode { damping_ratio, ..mode });
        }
    }
    if beam.modes.is_empty() {
        let problem = "it has no modes, so that it cannot bend";
        let remedy = "give `bending_y`, `bending_z`, `torsion` or `extension`, or take the link out";
        return Err(numbers.keys.error(numbers.key, problem, remedy));
    }
    Ok(named)
}

/// The modes of one kind.
struct Kind<'a> {
    deflection: Deflection,
    modes: &'a ModesFile,
    numbers: &'a Numbers<'a>,
    key: &'static str,
}

impl Kind<'_> {
    fn key(&self, name: &str) -> String {
        format!("{}.{name}", self.key)
    }

    fn error(&self, name: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        self.numbers.error(&self.key(name), problem, remedy)
    }

    fn boundary(&self) -> Result<Boundary, Error> {
        let name = self.modes.boundary.unwrap_or(BoundaryName::ClampedFree);
        match (name, &self.modes.tip) {
            (BoundaryName::ClampedMass, None) => {
                let remedy = "add `tip: {mass: …, inertia: …}`, or let the boundary be `clamped_free`";
                return Err(self.error("boundary", "`clamped_mass` needs the body at the tip", remedy));
            }
            (BoundaryName::ClampedMass, Some(tip)) => {
                self.numbers.not_negative(&self.key("tip.mass"), tip.mass)?;
                self.numbers.not_negative(&self.key("tip.inertia"), tip.inertia)?;
                if tip.first_moment * tip.first_moment > tip.mass * tip.inertia {
                    let problem = "no body of this mass and inertia has its centre so far from the tip";
                    let remedy = "give at least `first_moment`² / `mass` as `inertia`, which is about the tip";
                    return Err(self.error("tip.inertia", problem, remedy));
                }
            }
            (_, Some(_)) => {
                let remedy = "let the boundary be `clamped_mass`, or take it out";
                return Err(self.error("tip", "only `clamped_mass` reads it", remedy));
            }
            (BoundaryName::ClampedPinned | BoundaryName::PinnedPinned, None) if !self.deflection.bends() => {
                let problem = "a rod is clamped or free, pins are for bending";
                let remedy = "give `clamped_free`, `clamped_clamped` or `clamped_mass`";
                return Err(self.error("boundary", problem, remedy));
            }
            _ => {}
        }
        Ok(name.with(self.modes.tip))
    }

    fn eigenfunctions(
        &self,
        beam: &Beam,
        boundary: Boundary,
        resistance: Option<Profile>,
    ) -> Result<Vec<BeamMode>, Error> {
        let count = self.modes.modes.unwrap_or(1);
        if count == 0 || count > MOST_MODES {
            let problem = format!("{count} modes are not between 1 and {MOST_MODES}");
            return Err(self.error(
                "modes",
                problem,
                "give how many eigenfunctions to take, or take the whole entry out",
            ));
        }
        let Some(stiffness) = resistance else { return Err(self.no_stiffness()) };
        let torsion = self.deflection == Deflection::Torsion;
        if torsion && beam.polar_inertia_per_length.total(beam.length) <= 0.0 {
            let problem = "torsion turns cross-sections, and those of this beam have no inertia";
            return Err(self.error("modes", problem, "give the beam `polar_inertia_per_length` [kg m]"));
        }
        let shapes = beam.inertia_per_length().eigenmodes(self.deflection, boundary, count);
        let mode = |(shape, lumped): (Shape, f64)| BeamMode {
            deflection: self.deflection,
            shape,
            resistance: Resistance::Stiffness(stiffness.clone()),
            damping_ratio: 0.0,
            lumped,
        };
        Ok(shapes.unwrap_or_default().into_iter().map(mode).collect())
    }

    fn no_stiffness(&self) -> Error {
        let what = match self.deflection {
            Deflection::Torsion => "G J [N m²]",
            Deflection::Extension => "E A [N]",
            _ => "E I [N m²]",
        };
        self.numbers.error(self.key, "the key `stiffness` is missing", format!("give {what}"))
    }

    fn tables(
        &self,
        beam: &Beam,
        shapes: &[ShapeFile],
        resistance: Option<Profile>,
        stations: &[StationInfo],
        placement: Transform<f64>,
    ) -> Result<Vec<BeamMode>, Error> {
        for (name, given) in [("modes", self.modes.modes.is_some()), ("tip", self.modes.tip.is_some())] {
            if given {
                let problem = "it has no effect beside `shapes`, which are one mode each";
                return Err(self.error(name, problem, "keep one of the two"));
            }
        }
        if shapes.is_empty() {
            return Err(self.error("shapes", "it has no shapes", "list one per mode, or take it out"));
        }
        let mut modes = Vec::with_capacity(shapes.len());
        for (i, file) in shapes.iter().enumerate() {
            let key = format!("shapes[{i}]");
            let shape = Shape::Table(self.table(beam, file, &key)?);
            let own = beam.inertia_per_length().modal_mass(self.deflection, &shape);
            let lumped = lumped_mass(self.deflection, &shape, stations, placement);
            if let Some(declared) = file.modal_mass {
                self.numbers.positive(&self.key(&format!("{key}.modal_mass")), declared)?;
                let is = own + lumped;
                if (is - declared).abs() > SAME_MASS * declared {
                    let problem = format!("the generalised mass of the shape is {is}, not {declared}");
                    let remedy = format!("multiply the shape by {}, or correct the mass", (declared / is).sqrt());
                    return Err(self.error(&format!("{key}.modal_mass"), problem, remedy));
                }
            }
            let resistance = match (file.frequency, &resistance) {
                (Some(frequency), _) => {
                    self.numbers.positive(&self.key(&format!("{key}.frequency")), frequency)?;
                    Resistance::Frequency(frequency)
                }
                (None, Some(profile)) => Resistance::Stiffness(profile.clone()),
                (None, None) => return Err(self.no_stiffness()),
            };
            modes.push(BeamMode { deflection: self.deflection, shape, resistance, damping_ratio: 0.0, lumped });
        }
        Ok(modes)
    }

    /// A shape that meets its boundary.
    fn table(&self, beam: &Beam, file: &ShapeFile, key: &str) -> Result<Table, Error> {
        let (rows, key) = (&file.table, format!("{key}.table"));
        let remedy = "list points [x, displacement] or [x, displacement, slope]";
        let columns = rows.first().map_or(0, Vec::len);
        if !matches!(columns, 2 | 3) || rows.iter().any(|row| row.len() != columns) {
            return Err(self.error(&key, "its rows are not all of two or of three numbers", remedy));
        }
        let x: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        self.numbers.span(&self.key(&key), &x, beam.length)?;
        let clamped = self.deflection.bends() && self.modes.boundary != Some(BoundaryName::PinnedPinned);
        let table = if columns == 3 {
            let mut points: Vec<[f64; 3]> = rows.iter().map(|r| [r[0], r[1], r[2]]).collect();
            stretch(&mut points, beam.length);
            Table::with_slopes(points)
        } else {
            let mut points: Vec<[f64; 2]> = rows.iter().map(|r| [r[0], r[1]]).collect();
            stretch(&mut points, beam.length);
            Table::spline(&points, clamped)
        };
        let most = rows.iter().fold(0.0_f64, |most, row| most.max(row[1].abs()));
        if most == 0.0 {
            return Err(self.error(&key, "the shape is zero everywhere", "give its displacements"));
        }
        for (place, x, what, is, limit) in self.conditions(&table, beam.length, clamped) {
            if is.abs() > limit * most {
                let problem = format!("its {what} at the {place}, x = {x} m, is {is}, but its boundary makes it zero");
                let remedy = "take rigid motion out of the shape, or name its `boundary`; \
                              a clamped root moves and turns with the link's frame";
                return Err(self.error(&key, problem, remedy));
            }
        }
        Ok(table)
    }

    /// What the boundary makes zero: place, x, what, how large it is, and how large it may be as part of the largest displacement.
    fn conditions(
        &self,
        table: &Table,
        length: f64,
        clamped: bool,
    ) -> Vec<(&'static str, f64, &'static str, f64, f64)> {
        let what = if self.deflection == Deflection::Torsion { "angle" } else { "displacement" };
        let mut all = vec![("root", 0.0, what, table.derivative(0.0, 0), ZERO)];
        if clamped {
            all.push(("root", 0.0, "slope", table.derivative(0.0, 1), ZERO / length));
            // A spline is told that its slope is zero: the parabola through its first points says whether it is.
            if let [a, b, c, ..] = table.points() {
                let (h, k) = (b[0] - a[0], c[0] - b[0]);
                let (first, second) = ((b[1] - a[1]) / h, (c[1] - b[1]) / k);
                let slope = first - h * (second - first) / (h + k);
                if slope.abs() > 0.5 * first.abs() {
                    all.push(("root", 0.0, "slope", slope, 1e-3 / length));
                }
            }
        }
        let at_tip = |k: usize, what, limit: f64| ("tip", length, what, table.derivative(length, k), limit);
        if let Some(BoundaryName::ClampedClamped | BoundaryName::ClampedPinned | BoundaryName::PinnedPinned) =
            self.modes.boundary
        {
            all.push(at_tip(0, what, ZERO));
        }
        if self.modes.boundary == Some(BoundaryName::ClampedClamped) && self.deflection.bends() {
            all.push(at_tip(1, "slope", 1e-3 / length));
        }
        all
    }

    fn damping(&self, count: usize) -> Result<Vec<f64>, Error> {
        let all = match &self.modes.damping {
            None => vec![0.0; count],
            Some(DampingFile::All(ratio)) => vec![*ratio; count],
            Some(DampingFile::Each(each)) if each.len() == count => each.clone(),
            Some(DampingFile::Each(each)) => {
                let problem = format!("{} damping ratios stand beside {count} modes", each.len());
                return Err(self.error("damping", problem, "give one number for all, or one per mode"));
            }
        };
        all.iter().try_for_each(|ratio| self.numbers.not_negative(&self.key("damping"), *ratio))?;
        Ok(all)
    }
}

/// Modal mass of the lumped masses of a link.
fn lumped_mass(deflection: Deflection, shape: &Shape, stations: &[StationInfo], placement: Transform<f64>) -> f64 {
    let into_beam = placement.inverse();
    let one = |station: &StationInfo| {
        // About the cross-section's centre, in the beam's axes.
        let about = station.inertia.seen_from_parent(into_beam).moved(Vec3::new(-station.x, 0.0, 0.0));
        let (value, slope) = (shape.derivative(station.x, 0), shape.derivative(station.x, 1));
        let (u, psi) = (deflection.direction().scale(value), deflection.rotation(value, slope));
        about.mass * u.dot(u) + 2.0 * about.first_moment.dot(u.cross(psi)) + psi.dot(about.rotational * psi)
    };
    stations.iter().map(one).sum()
}
