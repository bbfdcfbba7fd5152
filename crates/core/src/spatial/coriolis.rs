//! What a further velocity asks of a body that moves.

use super::{Force, Mat3, Motion, SpatialInertia, Vec3};
use crate::Scalar;
use core::ops::Add;

/// `2B(I, v) = (v×*) I − I (v×) + (I v) ×̄*` of one rigid body or the sum over several, about one origin.
///
/// When bodies that move with `v` get a further velocity `u`, their equations of motion ask for the force
/// `2B u + I (v × u)` more, besides inertia (Echeandia & Wensing 2021, eq. 11). Written with the positions `r` of particles, its
/// moment is `∫ r × (2 u × ṙ) dm = 2 (tr(P) 1 − P) u` with `P = ∫ ṙ rᵀ dm`, and its force is twice `u × p`: only the
/// angular part of `u` counts, and twelve numbers hold it.
#[derive(Clone, Copy, Debug)]
pub struct Coriolis<T> {
    /// `2 (tr(P) 1 − P)` [kg m²/s]; rotors add to it.
    pub turning: Mat3<T>,
    /// `p`: linear momentum [kg m/s].
    pub momentum: Vec3<T>,
}

impl<T: Scalar> Coriolis<T> {
    /// Of nothing.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { turning: Mat3::zero(), momentum: Vec3::zero() }
    }

    /// Of a rigid body of inertia `i`, velocity `v` and linear momentum `p`.
    #[inline(always)]
    pub fn of(i: &SpatialInertia<T>, v: Motion<T>, p: Vec3<T>) -> Self {
        // P = v hᵀ + ω× Σ with Σ = ½ tr(I) 1 − I, so that 2 (tr(P) 1 − P) = ω× (2 I − tr(I) 1) + 2 (v·h) 1 − 2 v hᵀ
        let (w, h, twice_v) = (v.ang, i.first_moment, v.lin + v.lin);
        let r = i.rotational;
        let (xy, xz, yz) = (r.xy + r.xy, r.xz + r.xz, r.yz + r.yz);
        let kx = Vec3::new(r.xx - r.yy - r.zz, xy, xz);
        let ky = Vec3::new(xy, r.yy - r.xx - r.zz, yz);
        let kz = Vec3::new(xz, yz, r.zz - r.xx - r.yy);
        let row = |a: Vec3<T>, s: T, b: Vec3<T>, t: T, v: T| h.scale(-v).plus_scaled(s, a).plus_scaled(-t, b);
        let mut turning = Mat3::from_rows(
            row(kz, w.y, ky, w.z, twice_v.x),
            row(kx, w.z, kz, w.x, twice_v.y),
            row(ky, w.x, kx, w.y, twice_v.z),
        );
        let trace = twice_v.dot(h);
        turning.rows[0].x += trace;
        turning.rows[1].y += trace;
        turning.rows[2].z += trace;
        Self { turning, momentum: p }
    }

    /// `2B u`.
    #[inline(always)]
    pub fn force(&self, u: Motion<T>) -> Force<T> {
        Force { ang: self.turning * u.ang, lin: (u.ang + u.ang).cross(self.momentum) }
    }

    /// `(2B)ᵀ s`, whose linear part is zero: `sᵀ 2B u` is its product with the angular part of `u`.
    #[inline(always)]
    pub fn transpose_mul(&self, s: Motion<T>) -> Vec3<T> {
        (self.momentum + self.momentum).cross_plus(s.lin, self.turning.transpose_mul(s.ang))
    }

    /// The same with other numbers for entries.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Coriolis<U> {
        Coriolis { turning: self.turning.map(&mut f), momentum: self.momentum.map(&mut f) }
    }
}

impl<T: Scalar> Add for Coriolis<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { turning: self.turning + b.turning, momentum: self.momentum + b.momentum }
    }
}
