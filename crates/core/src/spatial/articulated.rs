//! Inertia of an articulated body.

use super::{Force, Mat3, Motion, SpatialInertia, SymMat3, Transform};
use crate::Scalar;
use core::ops::AddAssign;

/// The apparent inertia of a body with a subtree hanging on it (RBDA eq. 7.1): `[[I, H], [Hᵀ, M]]`, as 21 numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArticulatedInertia<T> {
    /// `I`: angular block [kg m²].
    pub ang: SymMat3<T>,
    /// `H`: from linear acceleration to moment [kg m].
    pub mixed: Mat3<T>,
    /// `M`: linear block [kg].
    pub lin: SymMat3<T>,
}

impl<T: Scalar> ArticulatedInertia<T> {
    /// Of nothing.
    #[inline]
    pub fn zero() -> Self {
        Self { ang: SymMat3::zero(), mixed: Mat3::zero(), lin: SymMat3::zero() }
    }

    /// `Iᴬ a`: the force that gives the acceleration `a`.
    #[inline]
    pub fn force(&self, a: Motion<T>) -> Force<T> {
        Force { ang: self.ang * a.ang + self.mixed * a.lin, lin: self.mixed.transpose_mul(a.ang) + self.lin * a.lin }
    }

    /// `Iᴬ − s U Uᵀ`.
    #[inline]
    pub fn minus_outer(&self, u: Force<T>, s: T) -> Self {
        let (su_ang, su_lin) = (u.ang.scale(s), u.lin.scale(s));
        Self {
            ang: self.ang - Mat3::outer(u.ang, su_ang).symmetric(),
            mixed: self.mixed - Mat3::outer(u.ang, su_lin),
            lin: self.lin - Mat3::outer(u.lin, su_lin).symmetric(),
        }
    }

    /// `Xᵀ Iᴬ X`: the same inertia seen from the parent frame of `x` (RBDA table 2.2 and §A.2).
    #[inline]
    pub fn seen_from_parent(&self, x: &Transform<T>) -> Self {
        // Turned into the parent's axes.
        let ang = self.ang.congruence(x.rot);
        let mixed = x.rot.transpose() * (self.mixed * x.rot);
        let lin = self.lin.congruence(x.rot);
        // Moved to the parent's origin: H' = H + r× M,  I' = I − H r× + r× H'ᵀ.
        let r = Mat3::skew(x.pos);
        let moved = mixed + r * lin.to_mat3();
        let ang = ang + (r * moved.transpose() - mixed * r).symmetric();
        Self { ang, mixed: moved, lin }
    }
}

impl<T: Scalar> From<SpatialInertia<T>> for ArticulatedInertia<T> {
    #[inline]
    fn from(i: SpatialInertia<T>) -> Self {
        Self { ang: i.rotational, mixed: Mat3::skew(i.first_moment), lin: SymMat3::diagonal(i.mass, i.mass, i.mass) }
    }
}

impl<T: Scalar> AddAssign for ArticulatedInertia<T> {
    #[inline]
    fn add_assign(&mut self, b: Self) {
        self.ang += b.ang;
        self.mixed = self.mixed + b.mixed;
        self.lin += b.lin;
    }
}
