//! The planar five-link biped of Mu and Wu in closed form.
//!
//! X. Mu and Q. Wu, "Development of a complete dynamic model of a planar five-link biped and sliding mode control of its
//! locomotion during the double support phase", International Journal of Control 77 (2004) 789–799. Equation numbers here
//! are theirs. Where a printed formula contradicts the text around it the right one is derived and used; the list of those
//! places is in `robots/biped5/README.md`.
//!
//! The links are a serial chain from the tip `b` of one leg to the tip `e` of the other: shank 1, thigh 2, trunk 3, thigh 4,
//! shank 5. `θ_i` is the absolute angle of link `i` [rad], from the upward vertical, clockwise, of the direction from joint
//! `i` to joint `i + 1`: a standing leg has angles near 0, one that hangs has angles near π. The trunk carries the next thigh at
//! its own joint, which is `a_3 = 0`. Forces and positions are in the vertical plane, x forward and y up.
//!
//! No algorithm of the core is used: explicit sums and dense solutions, and eq. 1 once, in any scalar.

mod chain;
mod double_support;
mod impact;
mod positions;
mod relative;
mod single_support;
mod trunk;

pub use double_support::{DoubleSupport, Outputs, ReducedForm};
pub use impact::{Impact, relabelled, relabelled_rate};
pub use relative::{RelativeForm, joint_rates, relative_angles, segment_angles, segment_rates, segment_torques};
pub use trunk::{Stance, TrunkRooted};

use nalgebra::{SMatrix, SVector};

/// One number per link.
pub type Links = SVector<f64, 5>;
/// A matrix over the links' angles.
pub type OverLinks = SMatrix<f64, 5, 5>;
/// A point, force or impulse in the plane: forward, up.
pub type Planar = SVector<f64, 2>;
/// How a point in the plane, or a force on it, depends on the links' angles.
pub type PlanarJacobian = SMatrix<f64, 2, 5>;

/// The parameters of the five links, in the order of the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Biped {
    /// `m_i`: mass [kg].
    pub mass: [f64; 5],
    /// `I_i`: moment of inertia about the centre of mass [kg m²].
    pub inertia: [f64; 5],
    /// `l_i`: length [m].
    pub length: [f64; 5],
    /// `d_i`: from joint `i` to the centre of mass [m].
    pub centre: [f64; 5],
    /// `a_i`: whether the next link hangs on the far end of this one, 1, or on its joint, 0.
    pub carries: [f64; 5],
    /// Acceleration of gravity [m/s²].
    pub gravity: f64,
}

impl Biped {
    /// Table 1 of the paper. It prints one moment of inertia for all links, and no gravity: that is the project's usual one.
    pub const MU_WU: Self = Self {
        mass: [2.23, 5.28, 14.79, 5.28, 2.23],
        inertia: [0.033; 5],
        length: [0.332, 0.302, 0.486, 0.302, 0.332],
        centre: [0.189, 0.236, 0.282, 0.066, 0.143],
        carries: [1.0, 1.0, 0.0, 1.0, 1.0],
        gravity: 9.81,
    };

    /// `a_i l_i`: from joint `i` to joint `i + 1` [m].
    fn reach(&self, i: usize) -> f64 {
        self.carries[i] * self.length[i]
    }

    /// Mass of the links from `first` to the end of the chain [kg].
    fn mass_from(&self, first: usize) -> f64 {
        self.mass[first..].iter().sum()
    }
}
