//! The records of links that bend: assumed modes, their integrals and the places where something is fixed.
//!
//! A point of a flexible link that rests at `x` sits at `x + Σ φ_j(x) η_j` (Cetinkunt & Book 1988, eq. 1): `η` are the modal
//! coordinates, `φ_j` the assumed modes. What the recursions need of the modes are integrals over the link's mass (eq. 20,
//! 25–29) and the values at its *stations*, the cross-sections that carry joints, rotors and lumped masses.
//!
//! With geometric stiffening a point moves, besides, by `½ Σ s_jk(x) η_j η_k`: a bent beam is shorter than a straight one, by
//! `s_jk = −e ∫₀ˣ φ'_j·φ'_k` along its axis `e`.

use super::{Body, Model};
use crate::Scalar;
use crate::spatial::{Mat3, SpatialInertia, SymMat3, Vec3};

/// A link that bends: the modes, pairs of modes and stations of one body, which follow those of the link before.
#[derive(Clone, Copy, Debug)]
pub struct FlexibleLink<T> {
    /// Index of the body.
    pub body: u16,
    /// `n`: number of its modes.
    pub modes: u16,
    /// Number of its stations.
    pub stations: u16,
    /// Whether its shortening counts (geometric stiffening).
    pub stiffening: bool,
    /// Index of its first mode.
    pub(crate) first_mode: u32,
    /// Index of its first pair of modes.
    pub(crate) first_pair: u32,
    /// Index of its first station.
    pub(crate) first_station: u32,
    /// Index of its first station's first shape.
    pub(crate) first_shape: u32,
    /// Index of its first station's first shortening.
    pub(crate) first_shortening: u32,
    /// Inertia at rest of all that is not fixed to a station, about the body's origin.
    pub(crate) inertia: SpatialInertia<T>,
}

/// One mode of a flexible link, integrated over the mass that moves with it. `x` is measured from the link's origin, all in the
/// link's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssumedMode<T> {
    /// `∫ φ_j dm` (eq. 26) [kg].
    pub momentum: Vec3<T>,
    /// `∫ x φ_jᵀ dm` (eq. 20.b) [kg m].
    pub moments: Mat3<T>,
}

/// Two modes `j, k` of a flexible link, or one twice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModePair<T> {
    /// `∫ φ_j φ_kᵀ dm` (eq. 20.c) [kg]; its trace is the modal mass.
    pub moments: Mat3<T>,
    /// `K_jk` (eq. 29) [N/m], symmetric.
    pub stiffness: T,
    /// `D_jk` [N s/m], symmetric.
    pub damping: T,
    /// `∫ s_jk dm` [kg/m], symmetric; zero without geometric stiffening.
    pub shortening: Vec3<T>,
    /// `∫ x s_jkᵀ dm` [kg], symmetric in `j, k`; zero without geometric stiffening.
    pub shortening_moments: Mat3<T>,
}

/// A cross-section of a flexible link: what is fixed to it moves with it as a rigid body.
#[derive(Clone, Copy, Debug)]
pub struct Station<T> {
    /// Where it is at rest, in the link's frame [m].
    pub position: Vec3<T>,
    /// Inertia at rest of what is fixed to it, about the link's origin in the link's axes.
    pub inertia: SpatialInertia<T>,
    /// `Σ J n nᵀ` of the elastic rotors that it carries [kg m²]; written by lowering.
    pub rotors: SymMat3<T>,
}

/// How one mode moves a station, in the link's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StationShape<T> {
    /// `φ_j` at the station [–].
    pub displacement: Vec3<T>,
    /// `ψ_j`: rotation of the cross-section [rad/m].
    pub rotation: Vec3<T>,
}

/// Which stations a joint has to do with; one record per body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seat {
    /// The station that the joint sits on; `None` where the parent does not bend.
    pub parent: Option<u16>,
    /// The station that carries the joint's rotor; `None` where no link that bends carries it.
    pub rotor: Option<u16>,
    /// The flexible link that the body is; written by lowering.
    pub link: Option<u16>,
}

/// A robot some of whose links bend.
///
/// Modal coordinates follow those of the joints: `q` has [`FlexibleModel::nq`] entries, the last [`FlexibleModel::modes`] of them
/// `η` in the order of links and modes; `qd`, `tau` and every other vector over the joints has [`FlexibleModel::nv`]. A mode counts
/// as a joint without a drive: its entries of `theta` and `thetad` are not read, its entry of `tau` is a generalised force.
#[derive(Clone, Copy, Debug)]
pub struct FlexibleModel<'a, T> {
    pub(crate) rigid: Model<'a, T>,
    pub(crate) links: &'a [FlexibleLink<T>],
    pub(crate) modes: &'a [AssumedMode<T>],
    pub(crate) pairs: &'a [ModePair<T>],
    pub(crate) stations: &'a [Station<T>],
    pub(crate) shapes: &'a [StationShape<T>],
    pub(crate) shortenings: &'a [Vec3<T>],
    pub(crate) seats: &'a [Seat],
}

/// The records of all flexible links, in the caller's storage: in the user's link frames before
/// [`FlexibleRecords::lower`](FlexibleRecords::lower), in those of the recursions after it.
#[derive(Debug)]
pub struct FlexibleRecords<'s> {
    /// One per flexible link, in the order of their bodies.
    pub links: &'s mut [FlexibleLink<f64>],
    /// `n` per link.
    pub modes: &'s mut [AssumedMode<f64>],
    /// `n × n` per link, by rows.
    pub pairs: &'s mut [ModePair<f64>],
    /// Those of a link in any order.
    pub stations: &'s mut [Station<f64>],
    /// `n` per station.
    pub shapes: &'s mut [StationShape<f64>],
    /// `s_jk` at the station, `n × n` by rows per station of a link with stiffening, none for others [1/m].
    pub shortenings: &'s mut [Vec3<f64>],
    /// One per body.
    pub seats: &'s mut [Seat],
}

impl<'a, T: Scalar> FlexibleModel<'a, T> {
    /// A view of records that [`FlexibleRecords::lower`] wrote, possibly cast to another scalar since.
    #[expect(clippy::too_many_arguments)]
    pub const fn new(
        rigid: Model<'a, T>,
        links: &'a [FlexibleLink<T>],
        modes: &'a [AssumedMode<T>],
        pairs: &'a [ModePair<T>],
        stations: &'a [Station<T>],
        shapes: &'a [StationShape<T>],
        shortenings: &'a [Vec3<T>],
        seats: &'a [Seat],
    ) -> Self {
        Self { rigid, links, modes, pairs, stations, shapes, shortenings, seats }
    }

    /// The robot whose links do not bend.
    pub fn rigid(&self) -> Model<'a, T> {
        self.rigid
    }

    /// The links that bend, in the order of their bodies.
    pub fn links(&self) -> &'a [FlexibleLink<T>] {
        self.links
    }

    /// The modes' integrals.
    pub fn mode_records(&self) -> &'a [AssumedMode<T>] {
        self.modes
    }

    /// The pairs of modes, `n × n` by rows for each link.
    pub fn pairs(&self) -> &'a [ModePair<T>] {
        self.pairs
    }

    /// The stations, link by link.
    pub fn stations(&self) -> &'a [Station<T>] {
        self.stations
    }

    /// How every mode moves every station, `n` for each station.
    pub fn shapes(&self) -> &'a [StationShape<T>] {
        self.shapes
    }

    /// `s_jk` at every station of a link with stiffening, `n × n` by rows for each [1/m].
    pub fn shortenings(&self) -> &'a [Vec3<T>] {
        self.shortenings
    }

    /// What every joint and its rotor sit on, one record per body.
    pub fn seats(&self) -> &'a [Seat] {
        self.seats
    }

    /// Number of modal coordinates.
    pub fn modes(&self) -> usize {
        self.modes.len()
    }

    /// Length of `q`: of the joints, then of the modes.
    pub fn nq(&self) -> usize {
        self.rigid.nq + self.modes.len()
    }

    /// Length of `qd` and of every other vector over joints and modes.
    pub fn nv(&self) -> usize {
        self.rigid.nv + self.modes.len()
    }

    /// The same robot under another gravity.
    pub fn with_gravity(self, gravity: Vec3<T>) -> Self {
        Self { rigid: self.rigid.with_gravity(gravity), ..self }
    }

    /// The flexible link that body `i` is.
    #[inline(always)]
    pub(crate) fn link_of(&self, i: usize) -> Option<&'a FlexibleLink<T>> {
        self.links.get(usize::from(self.seats.get(i)?.link?))
    }
}

impl<T: Scalar> FlexibleLink<T> {
    /// A link to describe: body, number of modes and of stations, and whether its shortening counts.
    pub fn new(body: u16, modes: u16, stations: u16, stiffening: bool) -> Self {
        Self {
            body,
            modes,
            stations,
            stiffening,
            first_mode: 0,
            first_pair: 0,
            first_station: 0,
            first_shape: 0,
            first_shortening: 0,
            inertia: SpatialInertia::zero(),
        }
    }

    /// Number of its modes.
    #[inline(always)]
    pub fn n(&self) -> usize {
        self.modes.into()
    }

    /// Its modal coordinates among all.
    #[inline(always)]
    pub fn mode_range(&self) -> core::ops::Range<usize> {
        let first = self.first_mode as usize;
        first..first + self.n()
    }

    /// Its pairs of modes among all.
    #[inline(always)]
    pub fn pair_range(&self) -> core::ops::Range<usize> {
        let first = self.first_pair as usize;
        first..first + self.n() * self.n()
    }

    /// Its stations among all.
    #[inline(always)]
    pub fn station_range(&self) -> core::ops::Range<usize> {
        let first = self.first_station as usize;
        first..first + usize::from(self.stations)
    }

    /// The shapes of its station `k`, counted from its first, among all.
    #[inline(always)]
    pub(crate) fn shape_range(&self, k: usize) -> core::ops::Range<usize> {
        let first = self.first_shape as usize + k * self.n();
        first..first + self.n()
    }

    /// The shortenings at its station `k`, counted from its first, among all; empty without stiffening.
    #[inline(always)]
    pub(crate) fn shortening_range(&self, k: usize) -> core::ops::Range<usize> {
        if !self.stiffening {
            return 0..0;
        }
        let pairs = self.n() * self.n();
        let first = self.first_shortening as usize + k * pairs;
        first..first + pairs
    }

    fn map<U>(&self, mut f: impl FnMut(T) -> U) -> FlexibleLink<U> {
        FlexibleLink {
            body: self.body,
            modes: self.modes,
            stations: self.stations,
            stiffening: self.stiffening,
            first_mode: self.first_mode,
            first_pair: self.first_pair,
            first_station: self.first_station,
            first_shape: self.first_shape,
            first_shortening: self.first_shortening,
            inertia: self.inertia.map(&mut f),
        }
    }
}

/// The same records in another scalar, every number rounded to it.
impl FlexibleLink<f64> {
    /// The same link in another scalar.
    pub fn cast<U: Scalar>(&self) -> FlexibleLink<U> {
        self.map(U::from_f64)
    }
}

impl AssumedMode<f64> {
    /// The same mode in another scalar.
    pub fn cast<U: Scalar>(&self) -> AssumedMode<U> {
        AssumedMode { momentum: self.momentum.map(U::from_f64), moments: self.moments.map(U::from_f64) }
    }
}

impl ModePair<f64> {
    /// The same pair in another scalar.
    pub fn cast<U: Scalar>(&self) -> ModePair<U> {
        ModePair {
            moments: self.moments.map(U::from_f64),
            stiffness: U::from_f64(self.stiffness),
            damping: U::from_f64(self.damping),
            shortening: self.shortening.map(U::from_f64),
            shortening_moments: self.shortening_moments.map(U::from_f64),
        }
    }
}

impl Station<f64> {
    /// A station that carries nothing but what is said later.
    pub fn new(position: Vec3<f64>, inertia: SpatialInertia<f64>) -> Self {
        Self { position, inertia, rotors: SymMat3::zero() }
    }

    /// The same station in another scalar.
    pub fn cast<U: Scalar>(&self) -> Station<U> {
        Station {
            position: self.position.map(U::from_f64),
            inertia: self.inertia.map(U::from_f64),
            rotors: self.rotors.map(U::from_f64),
        }
    }
}

impl StationShape<f64> {
    /// The same shape in another scalar.
    pub fn cast<U: Scalar>(&self) -> StationShape<U> {
        StationShape { displacement: self.displacement.map(U::from_f64), rotation: self.rotation.map(U::from_f64) }
    }
}

/// What the recursions ask of a body that may carry stations.
impl<T: Scalar> Body<T> {
    /// Whether the body's joint has a rotor behind a rigid gear that is not on its parent.
    pub(crate) fn has_remote_rigid_rotor(&self) -> bool {
        self.rigid_rotor().is_some_and(|rotor| rotor.mount.is_some() && rotor.mount != self.parent)
    }
}
