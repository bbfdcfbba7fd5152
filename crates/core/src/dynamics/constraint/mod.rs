//! Robots whose links are held: feet on the ground, hands on an object, closed loops, joints that follow others.
//!
//! A constraint `Φ(q) = 0` exerts `Jᵀ λ`, `J = ∂Φ/∂q`, with the multipliers `λ` that keep it:
//!
//! ```text
//! M q̈ = u + Jᵀ λ,    J q̈ + J̇ q̇ = −2 ω Φ̇ − ω² Φ
//! ```
//!
//! The right-hand side (Baumgarte 1972) draws back what integration lets drift. In elastic models the rotors follow the links by
//! equations of their own (PHYSICS §3), so `M` and `u` are those that the articulated-body algorithm sees, and a constraint holds links only.
//!
//! `J M⁻¹ Jᵀ` is made of what that algorithm has at hand: a unit force of a constraint is carried from its body to the base, each joint
//! on the way taking its part (extended force propagators: Wensing, Featherstone & Orin 2012). That costs O(n) for each constraint, and no
//! matrix over the joints is made. Then `λ` comes from a system of as many equations as there are constrained directions
//! ([`Regularisation`] says what becomes of those that depend on others), and the accelerations follow in the last sweep as always.

mod anchor;
mod forward;
mod frames;
mod impact;
mod inverse;
mod jacobian;
mod joint_space;
mod propagate;
mod solve;
mod spec;

pub use forward::{Constrained, ConstrainedScratch, constrained_aba, constrained_forward_dynamics};
pub use frames::SupportScratch;
pub use impact::{Impact, impact, impact_aba};
pub use inverse::{TorqueDistribution, constrained_inverse_dynamics, constrained_inverse_len};
pub use jacobian::{ConstraintMotion, constraint_motion};
pub use joint_space::constrained_joint_matrix_len;
pub use propagate::{ConstraintScratch, PropagatedScratch};
pub use solve::{Regularisation, Solved};
pub use spec::{
    Anchor, Constraint, ConstraintError, Contact, Directions, Hold, constraint_matrix_len, constraint_rows,
    propagated_len,
};
