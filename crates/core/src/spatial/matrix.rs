//! General 3×3 matrices.

use super::{SymMat3, Vec3};
use crate::Scalar;
use core::ops::{Add, Mul, Sub};

/// A 3×3 matrix, stored by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mat3<T> {
    /// The three rows from top to bottom.
    pub rows: [Vec3<T>; 3],
}

impl<T> Mat3<T> {
    /// The matrix with the given rows.
    #[inline(always)]
    pub const fn from_rows(r0: Vec3<T>, r1: Vec3<T>, r2: Vec3<T>) -> Self {
        Self { rows: [r0, r1, r2] }
    }
}

impl<T: Scalar> Mat3<T> {
    /// The zero matrix.
    #[inline(always)]
    pub fn zero() -> Self {
        Self { rows: [Vec3::zero(); 3] }
    }

    /// The identity.
    #[inline(always)]
    pub fn identity() -> Self {
        let (o, i) = (T::zero(), T::one());
        Self::from_rows(Vec3::new(i, o, o), Vec3::new(o, i, o), Vec3::new(o, o, i))
    }

    /// The cross-product matrix `a×`, so that `skew(a) b = a × b`.
    #[inline(always)]
    pub fn skew(a: Vec3<T>) -> Self {
        let o = T::zero();
        Self::from_rows(Vec3::new(o, -a.z, a.y), Vec3::new(a.z, o, -a.x), Vec3::new(-a.y, a.x, o))
    }

    /// The rotation about the unit vector `axis` by an angle given by its sine and cosine (Rodrigues), taking coordinates
    /// of the turned frame to coordinates of the frame it was turned from.
    pub fn rotation(axis: Vec3<T>, (sin, cos): (T, T)) -> Self {
        let outer = SymMat3::outer(axis).scale(T::one() - cos).to_mat3();
        let mut r = outer + Self::skew(axis).scale(sin);
        r.rows[0].x += cos;
        r.rows[1].y += cos;
        r.rows[2].z += cos;
        r
    }

    /// The rotation `Rz(yaw) Ry(pitch) Rx(roll)` of URDF's `rpy`, taking coordinates of the turned frame to coordinates
    /// of the frame it was turned from.
    pub fn from_rpy(roll: T, pitch: T, yaw: T) -> Self {
        let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
        Self::from_rows(
            Vec3::new(cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr),
            Vec3::new(sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr),
            Vec3::new(-sp, cp * sr, cp * cr),
        )
    }

    /// The rotation of the unit quaternion `(x, y, z, w)`, taking coordinates of the turned frame to coordinates of the
    /// frame it was turned from.
    #[inline(always)]
    pub fn from_quaternion([x, y, z, w]: [T; 4]) -> Self {
        let two = T::from_f64(2.0);
        let one = T::one();
        Self::from_rows(
            Vec3::new(one - two * (y * y + z * z), two * (x * y - z * w), two * (x * z + y * w)),
            Vec3::new(two * (x * y + z * w), one - two * (x * x + z * z), two * (y * z - x * w)),
            Vec3::new(two * (x * z - y * w), two * (y * z + x * w), one - two * (x * x + y * y)),
        )
    }

    /// The transpose.
    #[inline(always)]
    pub fn transpose(self) -> Self {
        let [a, b, c] = self.rows;
        Self::from_rows(Vec3::new(a.x, b.x, c.x), Vec3::new(a.y, b.y, c.y), Vec3::new(a.z, b.z, c.z))
    }

    /// `Aᵀ b`, without forming the transpose.
    #[inline(always)]
    pub fn transpose_mul(self, b: Vec3<T>) -> Vec3<T> {
        self.rows[0].scale(b.x).plus_scaled(b.y, self.rows[1]).plus_scaled(b.z, self.rows[2])
    }

    /// `A b + c`.
    #[inline(always)]
    pub fn mul_plus(self, b: Vec3<T>, c: Vec3<T>) -> Vec3<T> {
        let [x, y, z] = self.rows;
        Vec3::new(x.dot_plus(b, c.x), y.dot_plus(b, c.y), z.dot_plus(b, c.z))
    }

    /// `s A`.
    #[inline(always)]
    pub fn scale(self, s: T) -> Self {
        let [a, b, c] = self.rows;
        Self::from_rows(a.scale(s), b.scale(s), c.scale(s))
    }

    /// The symmetric part `(A + Aᵀ) / 2` of a matrix that is symmetric but for rounding.
    #[inline(always)]
    pub fn symmetric(self) -> SymMat3<T> {
        let [a, b, c] = self.rows;
        let half = T::from_f64(0.5);
        SymMat3 { xx: a.x, yy: b.y, zz: c.z, xy: (a.y + b.x) * half, xz: (a.z + c.x) * half, yz: (b.z + c.y) * half }
    }

    /// The sum of the diagonal.
    #[inline(always)]
    pub fn trace(self) -> T {
        let [a, b, c] = self.rows;
        a.x + b.y + c.z
    }

    /// `∫ r × s` where the matrix is `∫ r sᵀ`: twice the vector of its skew part.
    #[inline(always)]
    pub fn cross_of(self) -> Vec3<T> {
        let [a, b, c] = self.rows;
        Vec3::new(b.z - c.y, c.x - a.z, a.y - b.x)
    }

    /// The outer product `a bᵀ`.
    #[inline(always)]
    pub fn outer(a: Vec3<T>, b: Vec3<T>) -> Self {
        Self::from_rows(b.scale(a.x), b.scale(a.y), b.scale(a.z))
    }

    /// The same matrix with other numbers for entries.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Mat3<U> {
        let [a, b, c] = self.rows;
        Mat3::from_rows(a.map(&mut f), b.map(&mut f), c.map(&mut f))
    }
}

impl<T: Scalar> Mul<Vec3<T>> for Mat3<T> {
    type Output = Vec3<T>;
    #[inline(always)]
    fn mul(self, b: Vec3<T>) -> Vec3<T> {
        Vec3::new(self.rows[0].dot(b), self.rows[1].dot(b), self.rows[2].dot(b))
    }
}

impl<T: Scalar> Mul for Mat3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        let [x, y, z] = self.rows;
        Self::from_rows(b.transpose_mul(x), b.transpose_mul(y), b.transpose_mul(z))
    }
}

impl<T: Scalar> Add for Mat3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::from_rows(self.rows[0] + b.rows[0], self.rows[1] + b.rows[1], self.rows[2] + b.rows[2])
    }
}

impl<T: Scalar> Sub for Mat3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::from_rows(self.rows[0] - b.rows[0], self.rows[1] - b.rows[1], self.rows[2] - b.rows[2])
    }
}
