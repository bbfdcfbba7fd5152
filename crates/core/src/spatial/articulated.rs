//! Inertia of an articulated body.

use super::{Force, Mat3, Motion, SpatialInertia, SymMat3, Transform, Vec3};
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

impl<T: Scalar> ArticulatedInertia<T> {
    /// `Iᴬ⁻¹ f`, by eliminating the linear part: `M` and its Schur complement in `I` are both symmetric and positive.
    pub fn solve(&self, f: Force<T>) -> Motion<T> {
        // M v = f − Hᵀ ω  into  n = I ω + H v:   (I − H M⁻¹ Hᵀ) ω = n − H M⁻¹ f
        let m = Cholesky::of(self.lin);
        let columns = self.mixed.rows.map(|row| m.solve(row));
        let schur = self.ang - (self.mixed * Mat3 { rows: columns }.transpose()).symmetric();
        let ang = Cholesky::of(schur).solve(f.ang - self.mixed * m.solve(f.lin));
        Motion { ang, lin: m.solve(f.lin - self.mixed.transpose_mul(ang)) }
    }
}

/// `A = L D Lᵀ` of a symmetric positive 3×3 matrix, with the reciprocals of `D`.
struct Cholesky<T> {
    l10: T,
    l20: T,
    l21: T,
    d_inv: [T; 3],
}

impl<T: Scalar> Cholesky<T> {
    fn of(a: SymMat3<T>) -> Self {
        let d0 = T::one() / a.xx;
        let (l10, l20) = (a.xy * d0, a.xz * d0);
        let d1 = T::one() / (a.yy - l10 * a.xy);
        let l21 = (a.yz - l20 * a.xy) * d1;
        let d2 = T::one() / (a.zz - l20 * a.xz - l21 * (a.yz - l20 * a.xy));
        Self { l10, l20, l21, d_inv: [d0, d1, d2] }
    }

    fn solve(&self, b: Vec3<T>) -> Vec3<T> {
        let y0 = b.x;
        let y1 = b.y - self.l10 * y0;
        let y2 = b.z - self.l20 * y0 - self.l21 * y1;
        let z = y2 * self.d_inv[2];
        let y = y1 * self.d_inv[1] - self.l21 * z;
        let x = y0 * self.d_inv[0] - self.l10 * y - self.l20 * z;
        Vec3::new(x, y, z)
    }
}
