//! Force vectors: wrenches and momenta.

use super::Vec3;
use crate::Scalar;
use core::ops::{Add, AddAssign, Neg, Sub, SubAssign};

/// A spatial force vector, angular part first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force<T> {
    /// Moment about the frame's origin [N m], or angular momentum about it [N m s].
    pub ang: Vec3<T>,
    /// Force [N], or linear momentum [N s].
    pub lin: Vec3<T>,
}

impl<T: Scalar> Force<T> {
    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { ang: Vec3::zero(), lin: Vec3::zero() }
    }

    /// A pure couple.
    #[inline(always)]
    pub fn couple(ang: Vec3<T>) -> Self {
        Self { ang, lin: Vec3::zero() }
    }

    /// `s f`.
    #[inline(always)]
    pub fn scale(self, s: T) -> Self {
        Self { ang: self.ang.scale(s), lin: self.lin.scale(s) }
    }

    /// `f + s g`.
    #[inline(always)]
    pub fn plus_scaled(self, s: T, g: Self) -> Self {
        Self { ang: self.ang.plus_scaled(s, g.ang), lin: self.lin.plus_scaled(s, g.lin) }
    }

    /// The same vector in other numbers.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Force<U> {
        Force { ang: self.ang.map(&mut f), lin: self.lin.map(&mut f) }
    }

    /// The six coordinates, angular first.
    #[inline(always)]
    pub fn to_array(self) -> [T; 6] {
        [self.ang.x, self.ang.y, self.ang.z, self.lin.x, self.lin.y, self.lin.z]
    }
}

impl<T> From<[T; 6]> for Force<T> {
    fn from([a, b, c, d, e, f]: [T; 6]) -> Self {
        Self { ang: Vec3::new(a, b, c), lin: Vec3::new(d, e, f) }
    }
}

impl<T: Scalar> Add for Force<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { ang: self.ang + b.ang, lin: self.lin + b.lin }
    }
}

impl<T: Scalar> Sub for Force<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { ang: self.ang - b.ang, lin: self.lin - b.lin }
    }
}

impl<T: Scalar> Neg for Force<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { ang: -self.ang, lin: -self.lin }
    }
}

impl<T: Scalar> AddAssign for Force<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<T: Scalar> SubAssign for Force<T> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
