//! Inertia of a rigid body.

use super::{Force, Motion, SymMat3, Transform, Vec3};
use crate::Scalar;
use core::ops::Add;

/// The spatial inertia of a rigid body about the origin of its frame (RBDA eq. 2.63), as ten numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpatialInertia<T> {
    /// Mass `m` [kg].
    pub mass: T,
    /// First moment of mass `m c` [kg m], `c` the centre of mass.
    pub first_moment: Vec3<T>,
    /// Rotational inertia about the frame's origin [kg m²].
    pub rotational: SymMat3<T>,
}

impl<T: Scalar> SpatialInertia<T> {
    /// Of a body without mass.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { mass: T::zero(), first_moment: Vec3::zero(), rotational: SymMat3::zero() }
    }

    /// From the mass [kg], the centre of mass `c` [m] and the rotational inertia about it [kg m²], all in one frame:
    /// `I = I_c + m (c·c 1 − c cᵀ)`.
    pub fn from_com(mass: T, com: Vec3<T>, about_com: SymMat3<T>) -> Self {
        Self { mass, first_moment: com.scale(mass), rotational: about_com + parallel_axis(com).scale(mass) }
    }

    /// `I v`: the momentum of the body moving with velocity `v`.
    #[inline(always)]
    pub fn momentum(self, v: Motion<T>) -> Force<T> {
        Force {
            ang: self.first_moment.cross_plus(v.lin, self.rotational * v.ang),
            lin: v.ang.cross_plus(self.first_moment, v.lin.scale(self.mass)),
        }
    }

    /// The same inertia seen from the frame `p`, where `self` is given in the frame `i` of `x` (from `p` to `i`).
    #[inline(always)]
    pub fn seen_from_parent(self, x: Transform<T>) -> Self {
        let turned = Self {
            mass: self.mass,
            first_moment: x.rot.transpose_mul(self.first_moment),
            rotational: x.inv_tensor(self.rotational),
        };
        turned.moved(x.pos)
    }

    /// The same inertia about the origin of a frame from which the present origin is at `r`.
    #[inline(always)]
    pub fn moved(self, r: Vec3<T>) -> Self {
        // h' = h + m r,   I' = I + (r·h + r·h') 1 − r hᵀ − h' rᵀ
        let (h, moved) = (self.first_moment, self.first_moment.plus_scaled(self.mass, r));
        let i = self.rotational;
        let sum = (h + h).plus_scaled(self.mass, r);
        let (xx, yy, zz) = (r.x * sum.x, r.y * sum.y, r.z * sum.z);
        let rotational = SymMat3 {
            xx: i.xx + (yy + zz),
            yy: i.yy + (xx + zz),
            zz: i.zz + (xx + yy),
            xy: (-r.x).mul_add(h.y, (-r.y).mul_add(moved.x, i.xy)),
            xz: (-r.x).mul_add(h.z, (-r.z).mul_add(moved.x, i.xz)),
            yz: (-r.y).mul_add(h.z, (-r.z).mul_add(moved.y, i.yz)),
        };
        Self { mass: self.mass, first_moment: moved, rotational }
    }

    /// The same inertia with other numbers for entries.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> SpatialInertia<U> {
        SpatialInertia {
            mass: f(self.mass),
            first_moment: self.first_moment.map(&mut f),
            rotational: self.rotational.map(&mut f),
        }
    }
}

/// `c·c 1 − c cᵀ`: what a unit mass at `c` adds to the rotational inertia.
#[inline(always)]
fn parallel_axis<T: Scalar>(c: Vec3<T>) -> SymMat3<T> {
    let s = c.dot(c);
    SymMat3::diagonal(s, s, s) - SymMat3::outer(c)
}

impl<T: Scalar> Add for SpatialInertia<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self {
            mass: self.mass + b.mass,
            first_moment: self.first_moment + b.first_moment,
            rotational: self.rotational + b.rotational,
        }
    }
}
