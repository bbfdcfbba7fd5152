//! Motion vectors: spatial velocities and accelerations.

use super::{Force, Vec3};
use crate::Scalar;
use core::ops::{Add, AddAssign, Sub};

/// A spatial motion vector, angular part first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion<T> {
    /// Angular velocity `ω` [rad/s] or acceleration [rad/s²].
    pub ang: Vec3<T>,
    /// Linear velocity of the body point at the frame's origin [m/s], or the linear part of the spatial acceleration [m/s²].
    pub lin: Vec3<T>,
}

impl<T: Scalar> Motion<T> {
    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { ang: Vec3::zero(), lin: Vec3::zero() }
    }

    /// `s m`.
    #[inline(always)]
    pub fn scale(self, s: T) -> Self {
        Self { ang: self.ang.scale(s), lin: self.lin.scale(s) }
    }

    /// `v × m`, the rate of a motion vector carried along by `v` (RBDA eq. 2.31).
    #[inline(always)]
    pub fn cross(self, m: Self) -> Self {
        Self { ang: self.ang.cross(m.ang), lin: self.ang.cross(m.lin) + self.lin.cross(m.ang) }
    }

    /// `v ×* f`, the rate of a force vector carried along by `v` (RBDA eq. 2.32).
    #[inline(always)]
    pub fn cross_force(self, f: Force<T>) -> Force<T> {
        Force { ang: self.ang.cross(f.ang) + self.lin.cross(f.lin), lin: self.ang.cross(f.lin) }
    }

    /// The scalar product `m · f`: a power, if `m` is a velocity.
    #[inline(always)]
    pub fn dot(self, f: Force<T>) -> T {
        self.ang.dot(f.ang) + self.lin.dot(f.lin)
    }

    /// The same vector in other numbers.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Motion<U> {
        Motion { ang: self.ang.map(&mut f), lin: self.lin.map(&mut f) }
    }

    /// The six coordinates, angular first.
    #[inline(always)]
    pub fn to_array(self) -> [T; 6] {
        [self.ang.x, self.ang.y, self.ang.z, self.lin.x, self.lin.y, self.lin.z]
    }
}

impl<T> From<[T; 6]> for Motion<T> {
    fn from([a, b, c, d, e, f]: [T; 6]) -> Self {
        Self { ang: Vec3::new(a, b, c), lin: Vec3::new(d, e, f) }
    }
}

impl<T: Scalar> Add for Motion<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { ang: self.ang + b.ang, lin: self.lin + b.lin }
    }
}

impl<T: Scalar> Sub for Motion<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { ang: self.ang - b.ang, lin: self.lin - b.lin }
    }
}

impl<T: Scalar> AddAssign for Motion<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
