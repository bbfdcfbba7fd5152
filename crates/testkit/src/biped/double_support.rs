//! The double support phase: both tips pinned (eq. 6 to 19).

use super::{Biped, Links, OverLinks, Planar, PlanarJacobian};
use nalgebra::{SMatrix, SVector};

/// What the constrained biped does.
#[derive(Clone, Copy, Debug)]
pub struct DoubleSupport {
    /// `θ̈` [rad/s²].
    pub acceleration: Links,
    /// `λ`: force of the ground on the tip `e`, forward and up [N].
    pub force: Planar,
}

/// Hip and trunk, `p = (x_h, y_h, θ_3)` seen from the tip `b` (eq. 9), and how they move.
#[derive(Clone, Copy, Debug)]
pub struct Outputs {
    /// `p` [m, m, rad].
    pub value: SVector<f64, 3>,
    /// `R = ∂p/∂θ` (eq. 10).
    pub jacobian: SMatrix<f64, 3, 5>,
    /// `Ṙ` (eq. 11).
    pub jacobian_rate: SMatrix<f64, 3, 5>,
}

/// `p̈ = B ṗ + C (T_θ − N)` (eq. 19).
#[derive(Clone, Copy, Debug)]
pub struct ReducedForm {
    /// `B` [1/s], in mixed units.
    pub rate_matrix: SMatrix<f64, 3, 3>,
    /// `C`, the inverse of an inertia.
    pub torque_matrix: SMatrix<f64, 3, 5>,
}

impl Biped {
    /// `(x_e − x_b − L, y_e − y_b)`: what is zero while both tips stand on level ground `L` apart (eq. 6) [m].
    pub fn constraint(&self, theta: &Links, step: f64) -> Planar {
        let tip = self.joint(5, &(*theta).into());
        Planar::new(tip[0] - step, tip[1])
    }

    /// `J = ∂Φ/∂θ` (below eq. 7) [m].
    pub fn constraint_jacobian(&self, theta: &Links) -> PlanarJacobian {
        PlanarJacobian::from_fn(|row, i| self.reach(i) * if row == 0 { theta[i].cos() } else { -theta[i].sin() })
    }

    /// `J̇` (eq. 13) [m/s].
    pub fn constraint_jacobian_rate(&self, theta: &Links, rate: &Links) -> PlanarJacobian {
        PlanarJacobian::from_fn(|row, i| {
            -self.reach(i) * rate[i] * if row == 0 { theta[i].sin() } else { theta[i].cos() }
        })
    }

    /// `p`, `R` and `Ṙ` (eq. 9 to 11). The hip is the end of link 2 and the last output the trunk, `θ_3`.
    pub fn outputs(&self, theta: &Links, rate: &Links) -> Outputs {
        let hip = self.joint(2, &(*theta).into());
        let rows = |tip: PlanarJacobian, trunk: f64| {
            SMatrix::<f64, 3, 5>::from_fn(|row, i| match (row, i) {
                (0 | 1, 0 | 1) => tip[(row, i)],
                (2, 2) => trunk,
                _ => 0.0,
            })
        };
        Outputs {
            value: SVector::from([hip[0], hip[1], theta[2]]),
            jacobian: rows(self.constraint_jacobian(theta), 1.0),
            jacobian_rate: rows(self.constraint_jacobian_rate(theta, rate), 0.0),
        }
    }

    /// `θ̈` and `λ` from torques on the segments: eq. 7 and 13 as one dense system.
    ///
    /// # Panics
    /// If all links are in line, where the constraint loses a rank.
    pub fn double_support(&self, theta: &Links, rate: &Links, torque: &Links) -> DoubleSupport {
        let (j, j_rate) = (self.constraint_jacobian(theta), self.constraint_jacobian_rate(theta, rate));
        let mut matrix = SMatrix::<f64, 7, 7>::zeros();
        matrix.fixed_view_mut::<5, 5>(0, 0).copy_from(&self.inertia_matrix(theta));
        matrix.fixed_view_mut::<5, 2>(0, 5).copy_from(&-j.transpose());
        matrix.fixed_view_mut::<2, 5>(5, 0).copy_from(&j);
        let mut right = SVector::<f64, 7>::zeros();
        right.fixed_rows_mut::<5>(0).copy_from(&(torque - self.bias(theta, rate)));
        right.fixed_rows_mut::<2>(5).copy_from(&(-j_rate * rate));
        let x = matrix.full_piv_lu().solve(&right).expect("legs that are not all in line");
        DoubleSupport { acceleration: x.fixed_rows::<5>(0).into(), force: x.fixed_rows::<2>(5).into() }
    }

    /// The forms of eq. 15 to 19 without multipliers, in the outputs' velocities.
    ///
    /// # Panics
    /// If a leg is straight, where hip and trunk do not determine the knees.
    pub fn reduced_form(&self, theta: &Links, rate: &Links) -> ReducedForm {
        let Outputs { jacobian: r, jacobian_rate: r_rate, .. } = self.outputs(theta, rate);
        let (j, j_rate) = (self.constraint_jacobian(theta), self.constraint_jacobian_rate(theta, rate));
        let mut both = OverLinks::zeros();
        both.fixed_view_mut::<3, 5>(0, 0).copy_from(&r);
        both.fixed_view_mut::<2, 5>(3, 0).copy_from(&j);
        let inverse = both.try_inverse().expect("legs that are not straight");
        let from_outputs: SMatrix<f64, 5, 3> = inverse.fixed_columns::<3>(0).into();
        let mobility = self.inertia_matrix(theta).try_inverse().expect("an inertia matrix is regular");
        let (sa1, sa2) = (r_rate * from_outputs, j_rate * from_outputs);
        let (sb1, sb2) = (r * mobility, j * mobility);
        let (sc1, sc2) = (sb1 * j.transpose(), sb2 * j.transpose());
        let through = sc1 * sc2.try_inverse().expect("legs that are not all in line");
        ReducedForm { rate_matrix: sa1 - through * sa2, torque_matrix: sb1 - through * sb2 }
    }

    /// The velocity nearest to `rate` in the metric of the inertia that keeps the tip `e` at rest (eq. 12) [rad/s].
    pub fn standing_rate(&self, theta: &Links, rate: &Links) -> Links {
        let j = self.constraint_jacobian(theta);
        let mobility = self.inertia_matrix(theta).try_inverse().expect("an inertia matrix is regular");
        let at_tip = (j * mobility * j.transpose()).try_inverse().expect("legs that are not all in line");
        rate - mobility * j.transpose() * at_tip * j * rate
    }
}
