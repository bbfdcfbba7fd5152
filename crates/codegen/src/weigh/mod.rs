//! Terms weighed and dropped: simpler equations for a motion, with what they cost.
//!
//! Cetinkunt and Book 1988 name it as what explicit equations are good for: one sees which terms matter, and drops the others. A term
//! here is one of `M_l`, of `S`, of the potential energy of gravity, or an entry of stiffness or damping, *with all that it does*: a
//! term of inertia has its Coriolis and centrifugal forces, a term of the potential its gravity torques. It is kept or dropped as a whole. So
//! what is left is a mechanical system again: its inertia matrix is symmetric, `Ṁ − 2C` is skew, energy is conserved. Where all terms
//! of `S` are too small, the reduced model (Spong 1987) appears by itself.
//!
//! Stiffness of transmissions and friction are not weighed: without its spring a joint is none.

mod contribution;
mod definite;
mod rank;
mod simplify;

pub use rank::{Place, Weight, rank};
pub use simplify::{Report, Simplified, simplify};

use crate::explicit::ExplicitModel;

/// A state and accelerations of a robot, as the library takes them; every vector has as many entries as the robot has velocities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// Positions of joints, then modal coordinates [rad or m].
    pub q: Vec<f64>,
    /// Their velocities.
    pub qd: Vec<f64>,
    /// Motor positions, reflected [rad or m]; read at elastic joints only, as are the other vectors of motors.
    pub theta: Vec<f64>,
    /// Motor velocities, reflected.
    pub thetad: Vec<f64>,
    /// Accelerations of joints and modes.
    pub qdd: Vec<f64>,
    /// Motor accelerations, reflected.
    pub thetadd: Vec<f64>,
}

impl Motion {
    /// Positions and the nominal values of kept parameters: what a term is evaluated at.
    fn inputs(&self, model: &ExplicitModel) -> Vec<f64> {
        self.q.iter().copied().chain(model.options().kept.iter().map(|p| p.nominal())).collect()
    }
}
