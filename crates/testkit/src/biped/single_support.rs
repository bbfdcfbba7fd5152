//! The single support phase: a chain on the pinned tip `b` (eq. 4 and 5).

use super::{Biped, Links, OverLinks};
use core::cmp::Ordering;

impl Biped {
    /// `p_ij`: what `D` and `H` are made of (below eq. 5) [kg m²].
    pub fn inertial_term(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        let beyond = self.mass_from(j + 1);
        match i.cmp(&j) {
            Ordering::Equal => {
                self.inertia[i] + self.mass[i] * self.centre[i].powi(2) + beyond * self.reach(i) * self.length[i]
            }
            _ => self.reach(i) * (self.mass[j] * self.centre[j] + beyond * self.reach(j)),
        }
    }

    /// `D(θ)`: the inertia matrix (eq. 5a) [kg m²].
    pub fn inertia_matrix(&self, theta: &Links) -> OverLinks {
        OverLinks::from_fn(|i, j| self.inertial_term(i, j) * (theta[i] - theta[j]).cos())
    }

    /// `H(θ, θ̇)`: the centrifugal terms, to be multiplied by `θ̇` (eq. 5b) [kg m²/s].
    pub fn velocity_matrix(&self, theta: &Links, rate: &Links) -> OverLinks {
        OverLinks::from_fn(|i, j| self.inertial_term(i, j) * (theta[i] - theta[j]).sin() * rate[j])
    }

    /// `G(θ)`: gravity on the side of the inertia (eq. 5c) [N m]. Angles are from the upward vertical, where the
    /// potential energy has its maximum: the sign is negative, and printed without it.
    pub fn gravity_torques(&self, theta: &Links) -> Links {
        let weight = |i: usize| self.gravity * (self.mass[i] * self.centre[i] + self.mass_from(i + 1) * self.reach(i));
        Links::from_fn(|i, _| -weight(i) * theta[i].sin())
    }

    /// `N = H θ̇ + G` (below eq. 8) [N m].
    pub fn bias(&self, theta: &Links, rate: &Links) -> Links {
        self.velocity_matrix(theta, rate) * rate + self.gravity_torques(theta)
    }

    /// `θ̈` of the biped on the pinned tip `b`, from torques on the segments (eq. 4) [rad/s²].
    pub fn single_support(&self, theta: &Links, rate: &Links, torque: &Links) -> Links {
        let d = self.inertia_matrix(theta).cholesky().expect("an inertia matrix is positive definite");
        d.solve(&(torque - self.bias(theta, rate)))
    }

    /// Kinetic energy while the tip `b` rests (eq. 3) [J].
    pub fn kinetic(&self, theta: &Links, rate: &Links) -> f64 {
        0.5 * rate.dot(&(self.inertia_matrix(theta) * rate))
    }
}
