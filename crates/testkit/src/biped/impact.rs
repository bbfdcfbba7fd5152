//! The double impact that ends a step: the tip `e` comes to rest on the ground, the tip `b` stays (eq. 20 to 22).

use super::{Biped, Links, OverLinks, Planar};
use core::f64::consts::PI;
use nalgebra::{SMatrix, SVector};

/// What the impact leaves.
#[derive(Clone, Copy, Debug)]
pub struct Impact {
    /// `θ̇⁺` [rad/s].
    pub rate: Links,
    /// `P_l`: impulse of the ground on the tip `b`, which has stood on it [N s]. It pulls where its second entry is negative:
    /// then the foot would have left the ground, and the impact is a single one.
    pub standing: Planar,
    /// Impulse of the ground on the tip `e`, which lands [N s].
    pub landing: Planar,
}

impl Biped {
    /// `W(θ)` of eq. 21: what the jumps of the angular velocities ask of the links' moments about their far joints when
    /// impulses are passed on from the tip `b` [kg m²]. The terms below the diagonal are negative, and printed positive.
    pub fn impact_matrix(&self, theta: &Links) -> OverLinks {
        let beyond_centre = |i: usize| self.mass[i] * (self.reach(i) - self.centre[i]);
        OverLinks::from_fn(|i, j| {
            if i == j {
                return self.inertia[i] - self.centre[i] * beyond_centre(i);
            }
            if i < j {
                return 0.0;
            }
            let between: f64 = self.mass[j + 1..i].iter().sum();
            let arm = self.reach(i) * self.mass[j] * self.centre[j]
                + beyond_centre(i) * self.reach(j)
                + self.reach(i) * between * self.reach(j);
            -arm * (theta[i] - theta[j]).cos()
        })
    }

    /// The plastic impact of the tip `e` while the tip `b` stands (eq. 21), and by the balance of momentum of the whole biped
    /// the impulse that eq. 21 does not contain.
    ///
    /// # Panics
    /// If all links are in line.
    pub fn double_impact(&self, theta: &Links, rate: &Links) -> Impact {
        let (w, j) = (self.impact_matrix(theta), self.constraint_jacobian(theta));
        let mut matrix = SMatrix::<f64, 7, 7>::zeros();
        matrix.fixed_view_mut::<5, 5>(0, 0).copy_from(&w);
        matrix.fixed_view_mut::<5, 2>(0, 5).copy_from(&j.transpose());
        matrix.fixed_view_mut::<2, 5>(5, 0).copy_from(&j);
        let mut right = SVector::<f64, 7>::zeros();
        right.fixed_rows_mut::<5>(0).copy_from(&(w * rate));
        let x = matrix.full_piv_lu().solve(&right).expect("legs that are not all in line");
        let after: Links = x.fixed_rows::<5>(0).into();
        let standing: Planar = x.fixed_rows::<2>(5).into();
        let jump = after - rate;
        let gained = (0..5).map(|i| self.centre_jacobian(i, theta) * jump * self.mass[i]).sum::<Planar>();
        Impact { rate: after, standing, landing: gained - standing }
    }

    /// `∂(x_ci, y_ci)/∂θ` of eq. 1 [m].
    pub fn centre_jacobian(&self, i: usize, theta: &Links) -> SMatrix<f64, 2, 5> {
        SMatrix::from_fn(|row, j| {
            let arm = match j {
                _ if j < i => self.reach(j),
                _ if j == i => self.centre[i],
                _ => 0.0,
            };
            arm * if row == 0 { theta[j].cos() } else { -theta[j].sin() }
        })
    }
}

/// The same pose seen from the other tip: the legs exchange their names and the directions along them turn round (eq. 22).
///
/// Half turns are taken back where a leg begins to stand, so that a standing leg has angles near 0 after any number of steps;
/// the paper adds one everywhere, which is the same pose.
pub fn relabelled(theta: &Links) -> Links {
    Links::from([theta[4] - PI, theta[3] - PI, theta[2], theta[1] + PI, theta[0] + PI])
}

/// The velocities of [`relabelled`] angles (eq. 22) [rad/s].
pub fn relabelled_rate(rate: &Links) -> Links {
    Links::from([rate[4], rate[3], rate[2], rate[1], rate[0]])
}
