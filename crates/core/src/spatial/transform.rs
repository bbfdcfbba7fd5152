//! Coordinate transforms between frames.

use super::{Force, Mat3, Motion, SymMat3, Vec3};
use crate::Scalar;

/// The Plücker transform `X` from a frame `p` to a frame `i` (RBDA table 2.2), which is also the pose of `i` in `p`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform<T> {
    /// `E`: takes coordinates in `p` to coordinates in `i`.
    pub rot: Mat3<T>,
    /// `r`: origin of `i`, in coordinates of `p` [m].
    pub pos: Vec3<T>,
}

impl<T: Scalar> Transform<T> {
    /// The transform between coinciding frames.
    #[inline(always)]
    pub fn identity() -> Self {
        Self { rot: Mat3::identity(), pos: Vec3::zero() }
    }

    /// The transform to a frame whose pose in `p` is given the URDF way: `rotation` takes its coordinates to those of `p`.
    #[inline(always)]
    pub fn from_pose(rotation: Mat3<T>, translation: Vec3<T>) -> Self {
        Self { rot: rotation.transpose(), pos: translation }
    }

    /// Rotation of the pose: takes coordinates in `i` to coordinates in `p`.
    #[inline(always)]
    pub fn rotation(self) -> Mat3<T> {
        self.rot.transpose()
    }

    /// `X m`: a motion vector from `p` to `i`.
    #[inline(always)]
    pub fn motion(self, m: Motion<T>) -> Motion<T> {
        Motion { ang: self.rot * m.ang, lin: self.rot * (m.lin - self.pos.cross(m.ang)) }
    }

    /// `X⁻¹ m`: a motion vector from `i` to `p`.
    #[inline(always)]
    pub fn inv_motion(self, m: Motion<T>) -> Motion<T> {
        let ang = self.rot.transpose_mul(m.ang);
        Motion { ang, lin: self.rot.transpose_mul(m.lin) + self.pos.cross(ang) }
    }

    /// `X* f`: a force vector from `p` to `i`.
    #[inline(always)]
    pub fn force(self, f: Force<T>) -> Force<T> {
        Force { ang: self.rot * (f.ang - self.pos.cross(f.lin)), lin: self.rot * f.lin }
    }

    /// `Xᵀ f`: a force vector from `i` to `p`.
    #[inline(always)]
    pub fn inv_force(self, f: Force<T>) -> Force<T> {
        let lin = self.rot.transpose_mul(f.lin);
        Force { ang: self.rot.transpose_mul(f.ang) + self.pos.cross(lin), lin }
    }

    /// A point from coordinates of `i` to coordinates of `p` [m].
    #[inline(always)]
    pub fn point(self, point: Vec3<T>) -> Vec3<T> {
        self.rot.transpose_mul(point) + self.pos
    }

    /// `X₂ X₁`, where `self` is `X₂` from `i` to `j` and `first` is `X₁` from `p` to `i`.
    #[inline(always)]
    pub fn after(self, first: Self) -> Self {
        Self { rot: self.rot * first.rot, pos: first.point(self.pos) }
    }

    /// The transform from `i` to `p`.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Self { rot: self.rot.transpose(), pos: -(self.rot * self.pos) }
    }

    /// A tensor from the axes of `i` to the axes of `p`: `Eᵀ A E`.
    #[inline(always)]
    pub fn inv_tensor(self, a: SymMat3<T>) -> SymMat3<T> {
        a.congruence(self.rot)
    }

    /// The same transform with other numbers for entries.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Transform<U> {
        Transform { rot: self.rot.map(&mut f), pos: self.pos.map(&mut f) }
    }
}
