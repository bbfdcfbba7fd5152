//! Explicit equations: every entry of the inertia matrix and the potential energy as a sum of terms.
//!
//! A term is a coefficient times powers of kept parameters, modal coordinates and sliding joints, times one sine or cosine of whole
//! multiples of angles for each group of parallel joints (`monomial.rs`). Products within a group become sums, so that
//! `sin² + cos² = 1` needs no saying, and equal expressions are equal sums. Terms can be counted, weighed,
//! dropped and printed: what Cetinkunt and Book 1988 want explicit equations for.

mod build;
mod compose;
mod error;
mod expand;
mod functions;
mod layout;
mod lump;
mod model;
mod monomial;
mod parts;
mod signature;
mod solve;
mod sum;
mod traced;
mod velocity;

pub use error::NotExplicit;
pub use layout::{Input, Layout};
pub(crate) use lump::{Lump, Unit, rational};
pub use model::{Coordinate, DriveLaw, ExplicitModel, JointLaw, Options, TransmissionLaw};
pub use monomial::{Harmonic, Monomial};
pub use sum::Sum;
pub use velocity::{Speed, VelocityTerm};
