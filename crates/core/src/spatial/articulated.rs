//! Inertia of an articulated body.

use super::{Force, Mat3, Motion, SpatialInertia, SymMat3, Transform, Vec3};
use crate::Scalar;
use core::ops::{Add, AddAssign};

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
    #[inline(always)]
    pub fn zero() -> Self {
        Self { ang: SymMat3::zero(), mixed: Mat3::zero(), lin: SymMat3::zero() }
    }

    /// `Iᴬ a`: the force that gives the acceleration `a`.
    #[inline(always)]
    pub fn force(&self, a: Motion<T>) -> Force<T> {
        Force { ang: self.ang * a.ang + self.mixed * a.lin, lin: self.mixed.transpose_mul(a.ang) + self.lin * a.lin }
    }

    /// `Iᴬ − s U Uᵀ`.
    #[inline(always)]
    pub fn minus_outer(&self, u: Force<T>, s: T) -> Self {
        Self {
            ang: self.ang - SymMat3::outer(u.ang).scale(s),
            mixed: self.mixed - Mat3::outer(u.ang, u.lin.scale(s)),
            lin: self.lin - SymMat3::outer(u.lin).scale(s),
        }
    }

    /// The same inertia about the origin of a frame from which the present origin is at `r` (RBDA §A.2).
    #[inline(always)]
    pub fn moved(&self, r: Vec3<T>) -> Self {
        let ([h0, h1, h2], m) = (self.mixed.rows, self.lin.to_mat3().rows);
        // H' = H + r× M
        let g0 = h0.plus_scaled(r.y, m[2]).plus_scaled(-r.z, m[1]);
        let g1 = h1.plus_scaled(r.z, m[0]).plus_scaled(-r.x, m[2]);
        let g2 = h2.plus_scaled(r.x, m[1]).plus_scaled(-r.y, m[0]);
        // I' = I − H r× + r× H'ᵀ: entry (i, j) gains (r × h_i)_j + (r × h'_j)_i
        let (d0, d1, d2) = (g0 + h0, g1 + h1, g2 + h2);
        let i = self.ang;
        let ang = SymMat3 {
            xx: cross_term(r.y, d0.z, r.z, d0.y, i.xx),
            yy: cross_term(r.z, d1.x, r.x, d1.z, i.yy),
            zz: cross_term(r.x, d2.y, r.y, d2.x, i.zz),
            xy: r.z.mul_add(h0.x - g1.y, cross_term(r.y, g1.z, r.x, h0.z, i.xy)),
            xz: r.y.mul_add(g2.z - h0.x, cross_term(r.x, h0.y, r.z, g2.y, i.xz)),
            yz: r.x.mul_add(h1.y - g2.z, cross_term(r.z, g2.x, r.y, h1.x, i.yz)),
        };
        Self { ang, mixed: Mat3::from_rows(g0, g1, g2), lin: self.lin }
    }

    /// `Xᵀ Iᴬ X`: the same inertia seen from the frame `p`, where `self` is given in the frame `i` of `x` (from `p` to `i`).
    #[inline(always)]
    pub fn seen_from_parent(&self, x: Transform<T>) -> Self {
        let turned = Self {
            ang: x.inv_tensor(self.ang),
            mixed: x.rot.transpose() * self.mixed * x.rot,
            lin: x.inv_tensor(self.lin),
        };
        turned.moved(x.pos)
    }

    /// [`ArticulatedInertia::moved`] by `a` along x.
    #[inline(always)]
    pub fn moved_along_x(&self, a: T) -> Self {
        let ([h0, h1, h2], i, m) = (self.mixed.rows, self.ang, self.lin);
        let g1 = Vec3::new((-a).mul_add(m.xz, h1.x), (-a).mul_add(m.yz, h1.y), (-a).mul_add(m.zz, h1.z));
        let g2 = Vec3::new(a.mul_add(m.xy, h2.x), a.mul_add(m.yy, h2.y), a.mul_add(m.yz, h2.z));
        let ang = SymMat3 {
            xx: i.xx,
            yy: (-a).mul_add(g1.z + h1.z, i.yy),
            zz: a.mul_add(g2.y + h2.y, i.zz),
            xy: (-a).mul_add(h0.z, i.xy),
            xz: a.mul_add(h0.y, i.xz),
            yz: a.mul_add(h1.y - g2.z, i.yz),
        };
        Self { ang, mixed: Mat3::from_rows(h0, g1, g2), lin: m }
    }

    /// [`ArticulatedInertia::moved`] by `d` along z.
    #[inline(always)]
    pub fn moved_along_z(&self, d: T) -> Self {
        let ([h0, h1, h2], i, m) = (self.mixed.rows, self.ang, self.lin);
        let g0 = Vec3::new((-d).mul_add(m.xy, h0.x), (-d).mul_add(m.yy, h0.y), (-d).mul_add(m.yz, h0.z));
        let g1 = Vec3::new(d.mul_add(m.xx, h1.x), d.mul_add(m.xy, h1.y), d.mul_add(m.xz, h1.z));
        let ang = SymMat3 {
            xx: (-d).mul_add(g0.y + h0.y, i.xx),
            yy: d.mul_add(g1.x + h1.x, i.yy),
            zz: i.zz,
            xy: d.mul_add(h0.x - g1.y, i.xy),
            xz: (-d).mul_add(h2.y, i.xz),
            yz: d.mul_add(h2.x, i.yz),
        };
        Self { ang, mixed: Mat3::from_rows(g0, g1, h2), lin: m }
    }

    /// `Iᴬ + I`, the latter of a rigid body.
    #[inline(always)]
    pub fn plus_rigid(&self, i: SpatialInertia<T>) -> Self {
        let ([a, b, c], h, m) = (self.mixed.rows, i.first_moment, i.mass);
        let mixed = Mat3::from_rows(
            Vec3::new(a.x, a.y - h.z, a.z + h.y),
            Vec3::new(b.x + h.z, b.y, b.z - h.x),
            Vec3::new(c.x - h.y, c.y + h.x, c.z),
        );
        let (mut lin, ang) = (self.lin, self.ang + i.rotational);
        (lin.xx, lin.yy, lin.zz) = (lin.xx + m, lin.yy + m, lin.zz + m);
        Self { ang, mixed, lin }
    }

    /// The same inertia in other numbers.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> ArticulatedInertia<U> {
        ArticulatedInertia { ang: self.ang.map(&mut f), mixed: self.mixed.map(&mut f), lin: self.lin.map(&mut f) }
    }
}

impl<T: Scalar> From<SpatialInertia<T>> for ArticulatedInertia<T> {
    #[inline(always)]
    fn from(i: SpatialInertia<T>) -> Self {
        Self { ang: i.rotational, mixed: Mat3::skew(i.first_moment), lin: SymMat3::diagonal(i.mass, i.mass, i.mass) }
    }
}

impl<T: Scalar> Add for ArticulatedInertia<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { ang: self.ang + b.ang, mixed: self.mixed + b.mixed, lin: self.lin + b.lin }
    }
}

impl<T: Scalar> AddAssign for ArticulatedInertia<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<T: Scalar> ArticulatedInertia<T> {
    /// `Iᴬ⁻¹ f`, by eliminating the linear part: `M` and its Schur complement in `I` are both symmetric and positive.
    #[inline(always)]
    pub fn solve(&self, f: Force<T>) -> Motion<T> {
        // M v = f − Hᵀ ω  into  n = I ω + H v:   (I − H M⁻¹ Hᵀ) ω = n − H M⁻¹ f
        let m = Cholesky::of(self.lin);
        let [a, b, c] = self.mixed.rows;
        let columns = Mat3::from_rows(m.solve(a), m.solve(b), m.solve(c));
        let schur = self.ang - (self.mixed * columns.transpose()).symmetric();
        let ang = Cholesky::of(schur).solve(f.ang - self.mixed * m.solve(f.lin));
        Motion { ang, lin: m.solve(f.lin - self.mixed.transpose_mul(ang)) }
    }
}

/// `a b − c d + e`: a coordinate of a vector product, added.
#[inline(always)]
fn cross_term<T: Scalar>(a: T, b: T, c: T, d: T, e: T) -> T {
    a.mul_add(b, (-c).mul_add(d, e))
}

/// `A = L D Lᵀ` of a symmetric positive 3×3 matrix, with the reciprocals of `D`.
struct Cholesky<T> {
    l10: T,
    l20: T,
    l21: T,
    d_inv: [T; 3],
}

impl<T: Scalar> Cholesky<T> {
    #[inline(always)]
    fn of(a: SymMat3<T>) -> Self {
        let d0 = T::one() / a.xx;
        let (l10, l20) = (a.xy * d0, a.xz * d0);
        let d1 = T::one() / (a.yy - l10 * a.xy);
        let l21 = (a.yz - l20 * a.xy) * d1;
        let d2 = T::one() / (a.zz - l20 * a.xz - l21 * (a.yz - l20 * a.xy));
        Self { l10, l20, l21, d_inv: [d0, d1, d2] }
    }

    #[inline(always)]
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
