//! Symmetric 3×3 matrices, stored and multiplied as six numbers.

use super::{Mat3, Vec3};
use crate::Scalar;
use core::ops::{Add, AddAssign, Mul, Sub};

/// A symmetric 3×3 matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SymMat3<T> {
    /// Entry (1, 1).
    pub xx: T,
    /// Entry (2, 2).
    pub yy: T,
    /// Entry (3, 3).
    pub zz: T,
    /// Entries (1, 2) and (2, 1).
    pub xy: T,
    /// Entries (1, 3) and (3, 1).
    pub xz: T,
    /// Entries (2, 3) and (3, 2).
    pub yz: T,
}

impl<T: Scalar> SymMat3<T> {
    /// The zero matrix.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::diagonal(T::zero(), T::zero(), T::zero())
    }

    /// The diagonal matrix of three entries.
    #[inline(always)]
    pub fn diagonal(xx: T, yy: T, zz: T) -> Self {
        let o = T::zero();
        Self { xx, yy, zz, xy: o, xz: o, yz: o }
    }

    /// The outer product `a aᵀ`.
    #[inline(always)]
    pub fn outer(a: Vec3<T>) -> Self {
        Self { xx: a.x * a.x, yy: a.y * a.y, zz: a.z * a.z, xy: a.x * a.y, xz: a.x * a.z, yz: a.y * a.z }
    }

    /// `s A`.
    #[inline(always)]
    pub fn scale(self, s: T) -> Self {
        self.map(|a| a * s)
    }

    /// The same matrix with all nine entries stored.
    #[inline(always)]
    pub fn to_mat3(self) -> Mat3<T> {
        Mat3::from_rows(
            Vec3::new(self.xx, self.xy, self.xz),
            Vec3::new(self.xy, self.yy, self.yz),
            Vec3::new(self.xz, self.yz, self.zz),
        )
    }

    /// `Eᵀ A E`, which turns a tensor given in the axes of `E`'s rows into the axes of its columns.
    #[inline(always)]
    pub fn congruence(self, e: Mat3<T>) -> Self {
        // Only the six entries on and above the diagonal of Eᵀ (A E).
        let [a, b, c] = (self.to_mat3() * e).rows;
        let [r0, r1, r2] = e.rows;
        let (e0, e1, e2) = (Vec3::new(r0.x, r1.x, r2.x), Vec3::new(r0.y, r1.y, r2.y), Vec3::new(r0.z, r1.z, r2.z));
        let (f0, f1, f2) = (Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z));
        Self { xx: e0.dot(f0), yy: e1.dot(f1), zz: e2.dot(f2), xy: e0.dot(f1), xz: e0.dot(f2), yz: e1.dot(f2) }
    }

    /// The same matrix with other numbers for entries.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> SymMat3<U> {
        SymMat3 { xx: f(self.xx), yy: f(self.yy), zz: f(self.zz), xy: f(self.xy), xz: f(self.xz), yz: f(self.yz) }
    }
}

impl<T: Scalar> Mul<Vec3<T>> for SymMat3<T> {
    type Output = Vec3<T>;
    #[inline(always)]
    fn mul(self, b: Vec3<T>) -> Vec3<T> {
        Vec3::new(
            self.xx.mul_add(b.x, self.xy.mul_add(b.y, self.xz * b.z)),
            self.xy.mul_add(b.x, self.yy.mul_add(b.y, self.yz * b.z)),
            self.xz.mul_add(b.x, self.yz.mul_add(b.y, self.zz * b.z)),
        )
    }
}

impl<T: Scalar> Add for SymMat3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self {
            xx: self.xx + b.xx,
            yy: self.yy + b.yy,
            zz: self.zz + b.zz,
            xy: self.xy + b.xy,
            xz: self.xz + b.xz,
            yz: self.yz + b.yz,
        }
    }
}

impl<T: Scalar> Sub for SymMat3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self {
            xx: self.xx - b.xx,
            yy: self.yy - b.yy,
            zz: self.zz - b.zz,
            xy: self.xy - b.xy,
            xz: self.xz - b.xz,
            yz: self.yz - b.yz,
        }
    }
}

impl<T: Scalar> AddAssign for SymMat3<T> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
