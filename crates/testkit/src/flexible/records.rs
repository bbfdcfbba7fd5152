//! Records of a robot with flexible links in storage of the tests.

use super::{BendingLink, Particle, Seats};
use crate::Lowered;
use gyroflex::Scalar;
use gyroflex::model::{
    AssumedMode, Fidelity, FlexibleLink, FlexibleModel, FlexibleRecords, ModePair, ModelError, RobotSpec, Seat,
    Station, StationShape,
};
use gyroflex::spatial::{Mat3, Vec3};

/// Owns what a [`FlexibleModel`] borrows.
#[derive(Clone, Debug)]
pub struct LoweredFlexible<T> {
    rigid: Lowered<T>,
    links: Vec<FlexibleLink<T>>,
    modes: Vec<AssumedMode<T>>,
    pairs: Vec<ModePair<T>>,
    stations: Vec<Station<T>>,
    shapes: Vec<StationShape<T>>,
    shortenings: Vec<Vec3<T>>,
    seats: Vec<Seat>,
}

impl<T: Scalar> LoweredFlexible<T> {
    /// Sums the integrals over the clouds, lowers the description and rounds every number to the scalar.
    ///
    /// # Errors
    /// Whatever the core finds wrong with the description.
    pub fn new(
        spec: &RobotSpec<'_>,
        links: &[BendingLink],
        seats: &[Seats],
        fidelity: Fidelity,
    ) -> Result<Self, ModelError> {
        let rigid = Lowered::<f64>::new(spec, fidelity)?;
        let mut r = described(spec, links, seats);
        FlexibleRecords {
            links: &mut r.links,
            modes: &mut r.modes,
            pairs: &mut r.pairs,
            stations: &mut r.stations,
            shapes: &mut r.shapes,
            shortenings: &mut r.shortenings,
            seats: &mut r.seats,
        }
        .lower(spec, rigid.view())?;
        Ok(Self {
            rigid: Lowered::new(spec, fidelity)?,
            links: r.links.iter().map(FlexibleLink::cast).collect(),
            modes: r.modes.iter().map(AssumedMode::cast).collect(),
            pairs: r.pairs.iter().map(ModePair::cast).collect(),
            stations: r.stations.iter().map(Station::cast).collect(),
            shapes: r.shapes.iter().map(StationShape::cast).collect(),
            shortenings: r.shortenings.iter().map(|s| s.map(T::from_f64)).collect(),
            seats: r.seats,
        })
    }

    /// The view the algorithms take.
    pub fn view(&self) -> FlexibleModel<'_, T> {
        FlexibleModel::new(
            self.rigid.view(),
            &self.links,
            &self.modes,
            &self.pairs,
            &self.stations,
            &self.shapes,
            &self.shortenings,
            &self.seats,
        )
    }
}

/// The records as a user writes them.
struct Described {
    links: Vec<FlexibleLink<f64>>,
    modes: Vec<AssumedMode<f64>>,
    pairs: Vec<ModePair<f64>>,
    stations: Vec<Station<f64>>,
    shapes: Vec<StationShape<f64>>,
    shortenings: Vec<Vec3<f64>>,
    seats: Vec<Seat>,
}

fn described(spec: &RobotSpec<'_>, links: &[BendingLink], seats: &[Seats]) -> Described {
    let mut out = Described {
        links: Vec::new(),
        modes: Vec::new(),
        pairs: Vec::new(),
        stations: Vec::new(),
        shapes: Vec::new(),
        shortenings: Vec::new(),
        seats: Vec::new(),
    };
    let mut first_station = vec![0; spec.bodies.len()];
    for link in links {
        let n = link.modes();
        first_station[link.body] = out.stations.len();
        out.links.push(FlexibleLink::new(link.body as u16, n as u16, link.sections.len() as u16, link.stiffening));
        for j in 0..n {
            let phi = |p: &Particle| p.shapes.displacement[j];
            out.modes.push(AssumedMode {
                momentum: vectors(&link.cloud, phi),
                moments: matrices(&link.cloud, |p| Mat3::outer(p.at, phi(p))),
            });
            for k in 0..n {
                let s = |p: &Particle| p.shapes.shortening.get(j * n + k).copied().unwrap_or(Vec3::zero());
                out.pairs.push(ModePair {
                    moments: matrices(&link.cloud, |p| Mat3::outer(phi(p), p.shapes.displacement[k])),
                    stiffness: link.stiffness[(j, k)],
                    damping: link.damping[(j, k)],
                    shortening: vectors(&link.cloud, s),
                    shortening_moments: matrices(&link.cloud, |p| Mat3::outer(p.at, s(p))),
                });
            }
        }
        for section in &link.sections {
            out.stations.push(Station::new(section.at, section.lump));
            let moves = section.shapes.displacement.iter().zip(&section.turns);
            out.shapes.extend(moves.map(|(phi, psi)| StationShape { displacement: *phi, rotation: *psi }));
            out.shortenings.extend(&section.shapes.shortening);
        }
    }
    for (body, seats) in spec.bodies.iter().zip(seats) {
        let station = |on: Option<usize>, k: Option<usize>| Some((first_station[on?] + k?) as u16);
        let mount = body.drive.and_then(|d| d.rotor.mount.body);
        out.seats.push(Seat {
            parent: station(body.parent, seats.joint),
            rotor: station(mount, seats.rotor),
            ..Seat::default()
        });
    }
    out
}

/// `Σ v dm`.
fn vectors(cloud: &[Particle], v: impl Fn(&Particle) -> Vec3<f64>) -> Vec3<f64> {
    cloud.iter().fold(Vec3::zero(), |sum, p| sum + v(p) * p.mass)
}

/// `Σ a dm`.
fn matrices(cloud: &[Particle], a: impl Fn(&Particle) -> Mat3<f64>) -> Mat3<f64> {
    cloud.iter().fold(Mat3::zero(), |sum, p| sum + a(p).scale(p.mass))
}
