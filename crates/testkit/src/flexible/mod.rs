//! Robots with links that bend, from their points alone: an oracle that shares no recursion and no integral with the core.
//!
//! A flexible link is a *cloud* of point masses on a rigid hub. A particle that rests at `x` sits, in the link's frame, at
//! `x + u1 + u2`, `u1 = Σ φ_j η_j` (Cetinkunt & Book 1988, eq. 1), with geometric stiffening `u2 = ½ Σ s_jk η_j η_k`. What the core
//! is given as integrals (eq. 20, 25, 26) are sums over the cloud, which the oracle never takes: its kinetic energy is
//!
//! ```text
//! T = Σ dm (½ |ṙ1|² + ṙ0·d/dt (R u2)),    r1 = p + R (x + u1),   r0 = p + R x
//! ```
//!
//! and its potential `−Σ dm g·(p + R (x + u1 + u2)) + ½ ηᵀ K η`: of what is of second order in the deflection, only products with
//! something of order zero count. What is fixed to a cross-section, a lump of mass, a joint, a rotor, is carried by a Cayley rotation, exactly.
//! Rotors are bodies of their own that turn by `N θ`. All is written as positions in any number type; velocities, inertia
//! matrix and forces are derivatives of them ([`lagrange`]).

pub mod lagrange;
mod oracle;
pub mod paper;
mod points;
mod pose;
mod records;

pub use oracle::FlexibleOracle;
pub use records::LoweredFlexible;

use gyroflex::spatial::{SpatialInertia, Vec3};
use nalgebra::DMatrix;

/// A link that bends, of `n` modes. Its body's inertia in the description is that of hub, cloud and lumps at rest.
#[derive(Clone, Debug)]
pub struct BendingLink {
    /// Index of the body.
    pub body: usize,
    /// What moves with the link's frame, about its origin.
    pub hub: SpatialInertia<f64>,
    /// What bends.
    pub cloud: Vec<Particle>,
    /// Where things are fixed.
    pub sections: Vec<Section>,
    /// `K` [N/m], symmetric.
    pub stiffness: DMatrix<f64>,
    /// `D` [N s/m], symmetric.
    pub damping: DMatrix<f64>,
    /// Whether the shapes have shortenings.
    pub stiffening: bool,
}

/// A point mass of a flexible link.
#[derive(Clone, Debug)]
pub struct Particle {
    /// [kg]
    pub mass: f64,
    /// Where it rests, in the link's frame [m].
    pub at: Vec3<f64>,
    /// How it moves.
    pub shapes: Shapes,
}

/// A cross-section of a flexible link.
#[derive(Clone, Debug)]
pub struct Section {
    /// Where it rests, in the link's frame [m].
    pub at: Vec3<f64>,
    /// How it moves.
    pub shapes: Shapes,
    /// `ψ_j`: how it turns [rad/m].
    pub turns: Vec<Vec3<f64>>,
    /// What is fixed to it, at rest, about the link's origin.
    pub lump: SpatialInertia<f64>,
}

/// Displacement of a point by the modal coordinates, in the link's axes.
#[derive(Clone, Debug)]
pub struct Shapes {
    /// `φ_j` [–].
    pub displacement: Vec<Vec3<f64>>,
    /// `s_jk` by rows, symmetric [1/m]; empty without geometric stiffening.
    pub shortening: Vec<Vec3<f64>>,
}

/// On which sections of flexible links a joint and its rotor sit, counted within the link; `None` where no flexible link carries them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seats {
    /// Of the joint.
    pub joint: Option<usize>,
    /// Of its rotor.
    pub rotor: Option<usize>,
}

impl BendingLink {
    /// `n`.
    pub fn modes(&self) -> usize {
        self.stiffness.nrows()
    }
}
