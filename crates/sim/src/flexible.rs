//! The links of a robot that bend: their beams, what sits on them, and the records of the core.

use crate::beam::{Beam, Boundary, Integrals, ModeFigures};
use crate::robot::Link;
use gyroflex::model::{AssumedMode, FlexibleLink, FlexibleRecords, ModePair, Seat, Station, StationShape};
use gyroflex::spatial::{SpatialInertia, Transform, Vec3};

/// All links of a robot that bend; none for most robots.
#[derive(Clone, Debug, Default)]
pub struct Flexible {
    /// In the order of their bodies.
    pub links: Vec<Flexure>,
    /// Where each body's joint sits; one per body, none for a robot whose links do not bend.
    pub seats: Vec<SeatPlaces>,
}

/// A link that bends: a beam, a hub at its root, and stations with all that is fixed to it.
#[derive(Clone, Debug)]
pub struct Flexure {
    /// Name of the link.
    pub name: String,
    /// Index of its body.
    pub body: usize,
    /// The beam, along x of its own frame.
    pub beam: Beam,
    /// Pose of the beam's frame in the link's frame.
    pub placement: Transform<f64>,
    /// Integrals over the beam, about the link's origin in the link's axes.
    pub integrals: Integrals,
    /// Inertia at rest of what is on no station, beam and hub, about the link's origin.
    pub inertia: SpatialInertia<f64>,
    /// What each mode is on its own.
    pub modes: Vec<ModeInfo>,
    /// Its cross-sections of interest, the tip first.
    pub stations: Vec<StationInfo>,
}

/// A mode, for reports.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeInfo {
    /// Its name, such as `upper.bending_y1`.
    pub name: String,
    /// Whose eigenfunction it is; `None` for a shape from a table.
    pub boundary: Option<Boundary>,
    /// Stiffness, masses and frequency on its own.
    pub figures: ModeFigures,
}

/// A cross-section that something is fixed to, or the tip.
#[derive(Clone, Debug, PartialEq)]
pub struct StationInfo {
    /// Its name, such as `upper.tip`.
    pub name: String,
    /// Distance from the beam's root [m].
    pub x: f64,
    /// Inertia at rest of what is fixed to it, about the link's origin in the link's axes.
    pub inertia: SpatialInertia<f64>,
}

/// A station: of which flexible link, and which of its stations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index of the flexible link.
    pub link: usize,
    /// Index among its stations.
    pub station: usize,
}

/// Where a joint and its rotor sit; `None` where no link that bends carries them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SeatPlaces {
    /// The joint.
    pub joint: Option<Place>,
    /// Its rotor.
    pub rotor: Option<Place>,
}

/// The core's records of all flexible links, in the links' frames.
#[derive(Clone, Debug, Default)]
pub struct FlexibleTables {
    /// One per flexible link.
    pub links: Vec<FlexibleLink<f64>>,
    /// The modes of all links.
    pub modes: Vec<AssumedMode<f64>>,
    /// `n × n` per link.
    pub pairs: Vec<ModePair<f64>>,
    /// The stations of all links.
    pub stations: Vec<Station<f64>>,
    /// `n` per station.
    pub shapes: Vec<StationShape<f64>>,
    /// `n × n` per station of a link with geometric stiffening.
    pub shortenings: Vec<Vec3<f64>>,
    /// One per body.
    pub seats: Vec<Seat>,
}

/// Stations closer than this part of the beam's length are one.
const SAME_PLACE: f64 = 1e-9;

impl Flexible {
    /// Whether no link bends.
    pub fn is_empty(&self) -> bool {
        self.links.is_empty()
    }

    /// Number of modal coordinates.
    pub fn modes(&self) -> usize {
        self.links.iter().map(|l| l.modes.len()).sum()
    }

    /// The modes' names, in the order of the modal coordinates.
    pub fn mode_names(&self) -> impl Iterator<Item = &str> {
        self.links.iter().flat_map(|l| &l.modes).map(|m| m.name.as_str())
    }

    /// The stations' names, in the order of the core's records.
    pub fn station_names(&self) -> impl Iterator<Item = &str> {
        self.links.iter().flat_map(|l| &l.stations).map(|s| s.name.as_str())
    }

    /// Index of the flexible link that a body is.
    pub fn of_body(&self, body: Option<usize>) -> Option<usize> {
        self.links.iter().position(|l| Some(l.body) == body)
    }

    /// Index of a station among all of the robot.
    pub fn station_index(&self, place: Place) -> usize {
        self.links[..place.link].iter().map(|l| l.stations.len()).sum::<usize>() + place.station
    }

    /// The place on a link that bends that carries `links[link]`: where the first fixed joint on the way to it is. `None` where the
    /// link's body does not bend, the place of the link's own points is that of the point itself.
    pub fn place_of(&self, links: &[Link], link: usize, point: Vec3<f64>) -> Option<(usize, f64)> {
        let index = self.of_body(links[link].body)?;
        let flexure = &self.links[index];
        let mut point = point;
        let mut at = &links[link];
        while at.name != flexure.name {
            point = at.placement.point(Vec3::zero());
            at = links.iter().find(|l| Some(&l.name) == at.parent.as_ref())?;
        }
        Some((index, flexure.project(point)))
    }

    /// The core's records.
    pub fn tables(&self) -> FlexibleTables {
        let mut all = FlexibleTables::default();
        for link in &self.links {
            let (n, stations) = (link.modes.len(), &link.stations);
            let stiffening = link.beam.stiffening;
            all.links.push(FlexibleLink::new(link.body as u16, n as u16, stations.len() as u16, stiffening));
            all.modes.extend(&link.integrals.modes);
            all.pairs.extend(&link.integrals.pairs);
            for station in stations {
                all.stations.push(Station::new(link.position(station.x), station.inertia));
                all.shapes.extend((0..n).map(|j| link.shape(j, station.x)));
                if stiffening {
                    let pairs = (0..n * n).map(|p| link.shortening(p / n, p % n, station.x));
                    all.shortenings.extend(pairs);
                }
            }
        }
        let index = |place: Option<Place>| place.map(|p| self.station_index(p) as u16);
        let seat = |seat: &SeatPlaces| Seat { parent: index(seat.joint), rotor: index(seat.rotor), link: None };
        all.seats = self.seats.iter().map(seat).collect();
        all
    }
}

impl Flexure {
    /// Its whole inertia at rest about the link's origin, without rotors of their own mass.
    pub fn total_inertia(&self) -> SpatialInertia<f64> {
        self.stations.iter().fold(self.inertia, |sum, station| sum + station.inertia)
    }

    /// The link's frame coordinates of the beam's axis at `x` [m].
    pub fn position(&self, x: f64) -> Vec3<f64> {
        self.placement.point(Vec3::new(x, 0.0, 0.0))
    }

    /// The `x` of the cross-section next to a point of the link [m].
    pub fn project(&self, point: Vec3<f64>) -> f64 {
        let along = self.placement.inverse().point(point).x;
        let x = along.clamp(0.0, self.beam.length);
        // Rounding of the pose must not make two stations of the tip.
        let near = |end: f64| (x - end).abs() <= SAME_PLACE * self.beam.length;
        [0.0, self.beam.length].into_iter().find(|end| near(*end)).unwrap_or(x)
    }

    /// How mode `j` moves the cross-section at `x`, in the link's axes.
    pub fn shape(&self, j: usize, x: f64) -> StationShape<f64> {
        let StationShape { displacement, rotation } = self.beam.section(j, x);
        let turn = self.placement.rotation();
        StationShape { displacement: turn * displacement, rotation: turn * rotation }
    }

    /// `s_jk` at `x`: how modes `j` and `k` together shorten the beam up to there, in the link's axes [1/m].
    pub fn shortening(&self, j: usize, k: usize, x: f64) -> Vec3<f64> {
        self.placement.rotation() * Vec3::new(-self.beam.shortening(j, k, x), 0.0, 0.0)
    }

    /// Multiplies every mass and inertia of the link by a factor; stiffness and damping stay.
    pub(crate) fn scale_mass(&mut self, factor: f64) {
        self.beam.mass_per_length.scale(factor);
        self.beam.polar_inertia_per_length.scale(factor);
        self.beam.modes.iter_mut().for_each(|mode| mode.lumped *= factor);
        self.integrals.scale_mass(factor);
        self.inertia = self.inertia.map(|x| x * factor);
        self.stations.iter_mut().for_each(|station| station.inertia = station.inertia.map(|x| x * factor));
        for (j, mode) in self.modes.iter_mut().enumerate() {
            mode.figures = self.beam.figures(j, &self.integrals);
        }
    }

    /// The station at `x`, a new one called `name` if there is none.
    pub fn station_at(&mut self, x: f64, name: &str) -> usize {
        let near = |s: &StationInfo| (s.x - x).abs() <= SAME_PLACE * self.beam.length;
        if let Some(station) = self.stations.iter().position(near) {
            return station;
        }
        let name = format!("{}.{name}", self.name);
        self.stations.push(StationInfo { name, x, inertia: SpatialInertia::zero() });
        self.stations.len() - 1
    }
}

impl FlexibleTables {
    /// The records as the core lowers them, in place.
    pub fn records(&mut self) -> FlexibleRecords<'_> {
        FlexibleRecords {
            links: &mut self.links,
            modes: &mut self.modes,
            pairs: &mut self.pairs,
            stations: &mut self.stations,
            shapes: &mut self.shapes,
            shortenings: &mut self.shortenings,
            seats: &mut self.seats,
        }
    }
}
