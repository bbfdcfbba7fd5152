//! Robots with links that bend: assumed modes in the recursions (Cetinkunt & Book 1988; Jain & Rodriguez 1992 for the recursion).
//!
//! Between two passes over the joints nothing is new but this: what hangs on a flexible link hangs on one of its stations, and the
//! link's modes are eliminated in place, as a joint is. The cost is linear in the number of links, cubic in the modes of each.
//!
//! Kinematics: deflections are linear in the modal coordinates, the rotation of a station is Cayley's of a vector linear in them, exact as a
//! rotation. What is not small of second order in the deflection is so only with the shortening of a bent beam counted, an option of
//! each link. Cross-sections have no rotary inertia of their own.

mod aba;
mod across;
mod energy;
mod hybrid;
mod inward;
mod link;
mod matrix;
mod modes;
mod outward;
mod rnea;
mod scratch;
mod station;

pub use aba::flexible_aba;
pub use energy::{FlexiblePlacements, flexible_energy, flexible_placements, flexible_power, flexible_velocities};
pub use hybrid::flexible_hybrid;
pub use matrix::{FlexibleMatrices, flexible_mass_matrix};
pub use rnea::flexible_rnea;
pub use scratch::{
    FlexibleBody, FlexibleMode, FlexibleScratch, FlexibleStation, flexible_matrix_len, flexible_shapes_len,
};
