//! Spatial vector algebra (Featherstone, *Rigid Body Dynamics Algorithms*, chapter 2), one type a file.

mod articulated;
mod force;
mod inertia;
mod matrix;
mod motion;
pub(crate) mod screw;
mod symmetric;
mod transform;
mod vector;

pub use articulated::ArticulatedInertia;
pub use force::Force;
pub use inertia::SpatialInertia;
pub use matrix::Mat3;
pub use motion::Motion;
pub use symmetric::SymMat3;
pub use transform::Transform;
pub use vector::Vec3;
