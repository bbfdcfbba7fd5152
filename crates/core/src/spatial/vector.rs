//! Vectors of three-dimensional space.

use crate::Scalar;
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// A vector of three coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Vec3<T> {
    /// Along the first axis.
    pub x: T,
    /// Along the second axis.
    pub y: T,
    /// Along the third axis.
    pub z: T,
}

impl<T> Vec3<T> {
    /// The vector `(x, y, z)`.
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }
}

impl<T: Scalar> Vec3<T> {
    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::new(T::zero(), T::zero(), T::zero())
    }

    /// The unit vector along the third axis, which is where lowering turns every joint axis.
    #[inline(always)]
    pub fn z_axis() -> Self {
        Self::new(T::zero(), T::zero(), T::one())
    }

    /// Scalar product `a · b`.
    #[inline(always)]
    pub fn dot(self, b: Self) -> T {
        self.x.mul_add(b.x, self.y.mul_add(b.y, self.z * b.z))
    }

    /// `a · b + c`.
    #[inline(always)]
    pub fn dot_plus(self, b: Self, c: T) -> T {
        self.x.mul_add(b.x, self.y.mul_add(b.y, self.z.mul_add(b.z, c)))
    }

    /// Vector product `a × b`.
    #[inline(always)]
    pub fn cross(self, b: Self) -> Self {
        Self::new(
            self.y.mul_add(b.z, -(self.z * b.y)),
            self.z.mul_add(b.x, -(self.x * b.z)),
            self.x.mul_add(b.y, -(self.y * b.x)),
        )
    }

    /// `s a`.
    #[inline(always)]
    pub fn scale(self, s: T) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }

    /// `a + s b`.
    #[inline(always)]
    pub fn plus_scaled(self, s: T, b: Self) -> Self {
        Self::new(s.mul_add(b.x, self.x), s.mul_add(b.y, self.y), s.mul_add(b.z, self.z))
    }

    /// `a × b + c`.
    #[inline(always)]
    pub fn cross_plus(self, b: Self, c: Self) -> Self {
        Self::new(
            self.y.mul_add(b.z, (-self.z).mul_add(b.y, c.x)),
            self.z.mul_add(b.x, (-self.x).mul_add(b.z, c.y)),
            self.x.mul_add(b.y, (-self.y).mul_add(b.x, c.z)),
        )
    }

    /// Euclidean length.
    #[inline(always)]
    pub fn norm(self) -> T {
        self.dot(self).sqrt()
    }

    /// Coordinates in order.
    #[inline(always)]
    pub fn to_array(self) -> [T; 3] {
        [self.x, self.y, self.z]
    }

    /// The same vector with other numbers for coordinates.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Vec3<U> {
        Vec3::new(f(self.x), f(self.y), f(self.z))
    }
}

impl<T> From<[T; 3]> for Vec3<T> {
    fn from([x, y, z]: [T; 3]) -> Self {
        Self::new(x, y, z)
    }
}

impl<T: Scalar> Add for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::new(self.x + b.x, self.y + b.y, self.z + b.z)
    }
}

impl<T: Scalar> Sub for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::new(self.x - b.x, self.y - b.y, self.z - b.z)
    }
}

impl<T: Scalar> Neg for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl<T: Scalar> AddAssign for Vec3<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<T: Scalar> SubAssign for Vec3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<T: Scalar> Mul<T> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: T) -> Self {
        self.scale(s)
    }
}
