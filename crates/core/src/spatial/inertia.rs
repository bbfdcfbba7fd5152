//! Inertia of a rigid body.

use super::{Force, Mat3, Motion, SymMat3, Transform, Vec3};
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
    #[inline]
    pub fn zero() -> Self {
        Self { mass: T::zero(), first_moment: Vec3::zero(), rotational: SymMat3::zero() }
    }

    /// From the mass [kg], the centre of mass `c` [m] and the rotational inertia about it [kg m²], all in one frame:
    /// `I = I_c + m (c·c 1 − c cᵀ)`.
    pub fn from_com(mass: T, com: Vec3<T>, about_com: SymMat3<T>) -> Self {
        Self { mass, first_moment: com.scale(mass), rotational: about_com + parallel_axis(com).scale(mass) }
    }

    /// `I v`: the momentum of the body moving with velocity `v`.
    #[inline]
    pub fn momentum(self, v: Motion<T>) -> Force<T> {
        Force {
            ang: self.rotational * v.ang + self.first_moment.cross(v.lin),
            lin: v.lin.scale(self.mass) - self.first_moment.cross(v.ang),
        }
    }

    /// The same inertia seen from the frame `p`, where `self` is given in the frame `i` of `x` (from `p` to `i`).
    pub fn seen_from_parent(self, x: Transform<T>) -> Self {
        // The body-fixed moment h = m c turned into the parent's axes, then moved by r:
        //   I' = Eᵀ I E + 2 (r·h) 1 − (r hᵀ + h rᵀ) + m (r·r 1 − r rᵀ).
        let (r, h) = (x.pos, x.rot.transpose_mul(self.first_moment));
        let dot = T::from_f64(2.0) * r.dot(h);
        let cross = SymMat3::diagonal(dot, dot, dot) - (Mat3::outer(r, h) + Mat3::outer(h, r)).symmetric();
        let shift = cross + parallel_axis(r).scale(self.mass);
        let moved = h + r.scale(self.mass);
        Self { mass: self.mass, first_moment: moved, rotational: x.inv_tensor(self.rotational) + shift }
    }

    /// The same inertia with other numbers for entries.
    #[inline]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> SpatialInertia<U> {
        SpatialInertia {
            mass: f(self.mass),
            first_moment: self.first_moment.map(&mut f),
            rotational: self.rotational.map(&mut f),
        }
    }
}

/// `c·c 1 − c cᵀ`: what a unit mass at `c` adds to the rotational inertia.
fn parallel_axis<T: Scalar>(c: Vec3<T>) -> SymMat3<T> {
    let s = c.dot(c);
    SymMat3::diagonal(s, s, s) - SymMat3::outer(c)
}

impl<T: Scalar> Add for SpatialInertia<T> {
    type Output = Self;
    #[inline]
    fn add(self, b: Self) -> Self {
        Self {
            mass: self.mass + b.mass,
            first_moment: self.first_moment + b.first_moment,
            rotational: self.rotational + b.rotational,
        }
    }
}
