//! The same in the angles between the links (eq. 23 to 28): `q_1` is the ankle's, the others are joints 2 to 5.

use super::{Biped, Links, OverLinks, PlanarJacobian};

/// `D_q q̈ + N_q = T_q + J_qᵀ λ` (eq. 23 and 24).
#[derive(Clone, Copy, Debug)]
pub struct RelativeForm {
    /// `D_q` (eq. 28a) [kg m²].
    pub inertia_matrix: OverLinks,
    /// `H_q`, already multiplied by the velocities, and `G_q` (eq. 28b and c) [N m].
    pub bias: Links,
    /// `J_q` (eq. 28d) [m].
    pub constraint_jacobian: PlanarJacobian,
}

/// `q = M θ`: differences of neighbours (eq. 25) [rad].
pub fn relative_angles(theta: &Links) -> Links {
    Links::from_fn(|i, _| theta[i] - if i == 0 { 0.0 } else { theta[i - 1] })
}

/// `q̇ = M θ̇` [rad/s]; likewise for accelerations.
pub fn joint_rates(rate: &Links) -> Links {
    relative_angles(rate)
}

/// `θ = M⁻¹ q`: running sums [rad].
pub fn segment_angles(q: &Links) -> Links {
    Links::from_fn(|i, _| q.iter().take(i + 1).sum())
}

/// `θ̇ = M⁻¹ q̇` [rad/s]; likewise for accelerations.
pub fn segment_rates(qd: &Links) -> Links {
    segment_angles(qd)
}

/// `T_θ = Mᵀ T_q`: a joint's torque acts on its own link and back on the one before (eq. 27) [N m].
pub fn segment_torques(joint: &Links) -> Links {
    Links::from_fn(|i, _| joint[i] - joint.get(i + 1).copied().unwrap_or(0.0))
}

/// `M⁻¹`.
fn summing() -> OverLinks {
    OverLinks::from_fn(|i, j| if j <= i { 1.0 } else { 0.0 })
}

impl Biped {
    /// The equations of motion in joint angles, at `q` and `q̇`.
    pub fn relative_form(&self, q: &Links, qd: &Links) -> RelativeForm {
        let (theta, rate, sum) = (segment_angles(q), segment_rates(qd), summing());
        RelativeForm {
            inertia_matrix: sum.transpose() * self.inertia_matrix(&theta) * sum,
            bias: sum.transpose() * self.bias(&theta, &rate),
            constraint_jacobian: self.constraint_jacobian(&theta) * sum,
        }
    }
}
