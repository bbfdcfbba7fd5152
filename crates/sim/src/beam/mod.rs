//! Beams that bend, twist and stretch: mode shapes, and the integrals over them that the dynamics of flexible links are made of.
//!
//! Pure mathematics, no files. A beam lies along x from its root at 0. Its deflection is a sum of assumed modes: eigenfunctions of a
//! uniform beam under a [`Boundary`], or shapes from a table. Eigenfunctions are positive just beyond the root and normalised so that
//! the modal mass, of the beam and of the body at its tip if the boundary has one, is the mass of the beam: deflections and modal
//! coordinates are then of the same size, and `K_jj` is the beam's mass times `ω²`. In torsion it is the beam's polar inertia, and the
//! modal coordinate an angle.

mod bending;
mod boundary;
mod integrals;
mod profile;
mod quadrature;
mod rod;
mod shape;
mod table;

pub use bending::Bending;
pub use boundary::{Boundary, TipBody};
pub use integrals::{Beam, BeamError, Integrals, ModeFigures};
pub use profile::Profile;
pub use quadrature::{composite, gauss_legendre};
pub use rod::Rod;
pub use shape::{BeamMode, Deflection, Inertia, Resistance, Shape, frequency};
pub use table::Table;
