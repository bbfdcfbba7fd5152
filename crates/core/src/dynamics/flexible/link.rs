//! One flexible link by itself: inertia at the present deflection, and the forces that its motion needs.
//!
//! With `r = x + Σ φ_j η_j` and `B_j = ∫ r φ_jᵀ dm` (Cetinkunt & Book 1988, eq. 20 put together), everything is linear in `B_j`:
//! the link's second moments are `W = ∫ x xᵀ + sym Σ η_j (A_j + B_j)`, the coupling of mode and link is `[∫ r × φ_j; ∫ φ_j]`.
//!
//! Geometric stiffening adds `½ Σ s_jk η_j η_k` to `r`, of which products with another deflection are left out of the kinetic
//! energy: `∫ (v + ω × x)·(u̇₂ + ω × u₂) dm` is what is kept. So `s_jk` enters `B_j` beside `φ_j φ_kᵀ`, but not the modal masses.

use super::scratch::{FlexibleBody, FlexibleMode};
use crate::Scalar;
use crate::dynamics::aba_base::centripetal;
use crate::model::{AssumedMode, FlexibleLink, FlexibleModel, ModePair};
use crate::spatial::{Force, Mat3, SpatialInertia, SymMat3, Vec3};

/// One link's own records and modal coordinates.
pub(super) struct Deflected<'a, P, T> {
    link: &'a FlexibleLink<P>,
    modes: &'a [AssumedMode<P>],
    pairs: &'a [ModePair<P>],
    eta: &'a [T],
    etad: &'a [T],
}

impl<'a, T: Scalar> Deflected<'a, T::Param, T> {
    /// `eta` and `etad` are those of all links.
    pub(super) fn of(
        model: &FlexibleModel<'a, T::Param>,
        link: &'a FlexibleLink<T::Param>,
        eta: &'a [T],
        etad: &'a [T],
    ) -> Self {
        let modes = link.mode_range();
        Self {
            link,
            modes: &model.modes[modes.clone()],
            pairs: &model.pairs[link.pair_range()],
            eta: &eta[modes.clone()],
            etad: &etad[modes],
        }
    }

    /// Rows `j` of pairs: `(j, k)` for all `k`.
    fn row(&self, j: usize) -> &'a [ModePair<T::Param>] {
        let n = self.modes.len();
        &self.pairs[j * n..(j + 1) * n]
    }

    /// Inertia at the present deflection, and `B_j` of every mode.
    pub(super) fn inertia(&self, body: &mut FlexibleBody<T>, modes: &mut [FlexibleMode<T>]) {
        let at_rest: SpatialInertia<T> = self.link.inertia.map(T::from_param);
        let half = T::from_f64(0.5);
        let (mut first, mut second) = (Vec3::zero(), Mat3::zero());
        for (j, (mode, s)) in self.modes.iter().zip(modes.iter_mut()).enumerate() {
            // B_j = A_j + Σ_k (A_kj + G_jk) η_k,   b_j = a_j + Σ_k g_jk η_k
            let (a, moments) = (mode.momentum.map(T::from_param), mode.moments.map(T::from_param));
            (s.momentum, s.moments) = (a, moments);
            for (pair, eta) in self.row(j).iter().zip(self.eta) {
                let (g, products) = (pair.shortening, pair.moments);
                s.moments = s.moments + products.map(T::from_param).transpose().scale(*eta);
                if self.link.stiffening {
                    s.moments = s.moments + pair.shortening_moments.map(T::from_param).scale(*eta);
                    s.momentum = s.momentum.plus_scaled(*eta, g.map(T::from_param));
                }
            }
            // h = a_0 + ½ Σ (a_j + b_j) η_j,   W = A_0 + sym Σ (A_j + B_j) η_j
            first = first.plus_scaled(self.eta[j] * half, a + s.momentum);
            second = second + (moments + s.moments).scale(self.eta[j]);
        }
        body.inertia = SpatialInertia {
            mass: at_rest.mass,
            first_moment: at_rest.first_moment + first,
            rotational: at_rest.rotational + inertia_of(second),
        };
    }

    /// What the motion at the present velocities needs: force on the link, generalised force on every mode.
    pub(super) fn velocity_forces(&self, body: &mut FlexibleBody<T>, modes: &mut [FlexibleMode<T>]) {
        let (omega, zero) = (body.omega, Vec3::zero());
        let two = T::from_f64(2.0);
        // ∫ r u̇ᵀ = Σ B_j η̇_j,   ∫ u̇ = Σ b_j η̇_j;   the shortening itself accelerates by Σ s_jk η̇_j η̇_k
        let (mut rate, mut drift) = (Mat3::zero(), zero);
        let mut sagging = Force::zero();
        for (j, s) in modes.iter_mut().enumerate() {
            let etad = self.etad[j];
            (rate, drift) = (rate + s.moments.scale(etad), drift.plus_scaled(etad, s.momentum));
            // ∫ φ_j·(ω × (ω × r) + 2 ω × u̇) + Σ_k (K_jk η_k + D_jk η̇_k)
            let square = omega.dot(omega);
            let mut p = omega.dot(s.moments * omega) - square * s.moments.trace();
            let mut turning = zero;
            for (k, pair) in self.row(j).iter().enumerate() {
                // ∫ φ_k × φ_j = −∫ φ_j × φ_k
                let across = pair.moments.map(T::from_param).cross_of();
                turning = turning.plus_scaled(-self.etad[k], across);
                p = T::from_param(pair.stiffness).mul_add(self.eta[k], p);
                p = T::from_param(pair.damping).mul_add(self.etad[k], p);
                if self.link.stiffening {
                    let products = etad * self.etad[k];
                    sagging.ang =
                        sagging.ang.plus_scaled(products, pair.shortening_moments.map(T::from_param).cross_of());
                    sagging.lin = sagging.lin.plus_scaled(products, pair.shortening.map(T::from_param));
                }
            }
            s.p = two.mul_add(omega.dot(turning), p);
            s.u_cap = Force { ang: s.moments.cross_of(), lin: s.momentum };
        }
        // ω × I ω + 2 ∫ r × (ω × u̇),   ω × (ω × h) + 2 ω × ∫ u̇
        let coriolis = omega.scale(rate.trace()) - rate.transpose_mul(omega);
        let turning = omega.cross(body.inertia.rotational * omega);
        let ang = turning + coriolis.scale(two) + sagging.ang;
        let lin = centripetal(omega, body.inertia.first_moment) + omega.cross(drift).scale(two) + sagging.lin;
        body.p = Force { ang, lin };
    }

    /// `∫ φ_j·φ_k dm`.
    pub(super) fn modal_mass(&self, j: usize, k: usize) -> T {
        T::from_param(self.row(j)[k].moments.trace())
    }

    /// `½ ηᵀ K η`.
    pub(super) fn elastic_energy(&self) -> T {
        let mut twice = T::zero();
        for (j, eta) in self.eta.iter().enumerate() {
            for (pair, other) in self.row(j).iter().zip(self.eta) {
                twice += T::from_param(pair.stiffness) * *eta * *other;
            }
        }
        twice * T::from_f64(0.5)
    }

    /// `η̇ᵀ D η̇`.
    pub(super) fn dissipated(&self) -> T {
        let mut power = T::zero();
        for (j, etad) in self.etad.iter().enumerate() {
            for (pair, other) in self.row(j).iter().zip(self.etad) {
                power += T::from_param(pair.damping) * *etad * *other;
            }
        }
        power
    }

    /// `½ Σ η̇_j η̇_k ∫ φ_j·φ_k dm`.
    pub(super) fn modal_kinetic_energy(&self) -> T {
        let mut twice = T::zero();
        for (j, etad) in self.etad.iter().enumerate() {
            for (k, other) in self.etad.iter().enumerate() {
                twice += self.modal_mass(j, k) * *etad * *other;
            }
        }
        twice * T::from_f64(0.5)
    }
}

/// Rotational inertia `tr(W) 1 − W` where `w` is `∫ r rᵀ` but for symmetry.
fn inertia_of<T: Scalar>(w: Mat3<T>) -> SymMat3<T> {
    let [a, b, c] = w.rows;
    let half = T::from_f64(-0.5);
    SymMat3 {
        xx: b.y + c.z,
        yy: a.x + c.z,
        zz: a.x + b.y,
        xy: (a.y + b.x) * half,
        xz: (a.z + c.x) * half,
        yz: (b.z + c.y) * half,
    }
}
