//! Spatial vector algebra (Featherstone, *Rigid Body Dynamics Algorithms*, chapter 2), one type a file.

mod articulated;
mod branch;
mod coriolis;
mod force;
mod inertia;
mod joint_transform;
mod matrix;
mod motion;
mod released;
pub(crate) mod screw;
mod symmetric;
mod transform;
mod turn;
mod vector;

pub use articulated::ArticulatedInertia;
pub use branch::Branch;
pub use coriolis::Coriolis;
pub use force::Force;
pub use inertia::SpatialInertia;
pub use joint_transform::JointTransform;
pub use matrix::Mat3;
pub use motion::Motion;
pub use released::ReleasedInertia;
pub use symmetric::SymMat3;
pub use transform::Transform;
pub use turn::Turn;
pub use vector::Vec3;
