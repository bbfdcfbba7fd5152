//! Rotations about a coordinate axis, which touch two coordinates of three.

use super::{ArticulatedInertia, Force, Mat3, Motion, SpatialInertia, SymMat3, Transform, Vec3};
use crate::Scalar;

/// A rotation of the frame by an angle given by its sine and cosine, about the axis that the method names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn<T> {
    /// Sine of the angle.
    pub sin: T,
    /// Cosine of the angle.
    pub cos: T,
}

impl<T: Scalar> Turn<T> {
    /// No rotation.
    #[inline(always)]
    pub fn none() -> Self {
        Self { sin: T::zero(), cos: T::one() }
    }

    /// The same rotation in other numbers.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Turn<U> {
        Turn { sin: f(self.sin), cos: f(self.cos) }
    }

    /// A vector in the axes turned about z: `Rz v`.
    #[inline(always)]
    pub fn z(self, v: Vec3<T>) -> Vec3<T> {
        let (x, y) = self.pair(v.x, v.y);
        Vec3::new(x, y, v.z)
    }

    /// A vector given in the axes turned about z, in those before: `Rzᵀ v`.
    #[inline(always)]
    pub fn z_back(self, v: Vec3<T>) -> Vec3<T> {
        let (x, y) = self.pair_back(v.x, v.y);
        Vec3::new(x, y, v.z)
    }

    /// A vector in the axes turned about x: `Rx v`.
    #[inline(always)]
    pub fn x(self, v: Vec3<T>) -> Vec3<T> {
        let (y, z) = self.pair(v.y, v.z);
        Vec3::new(v.x, y, z)
    }

    /// A vector given in the axes turned about x, in those before: `Rxᵀ v`.
    #[inline(always)]
    pub fn x_back(self, v: Vec3<T>) -> Vec3<T> {
        let (y, z) = self.pair_back(v.y, v.z);
        Vec3::new(v.x, y, z)
    }

    /// A motion in the axes turned about z.
    #[inline(always)]
    pub fn z_motion(self, m: Motion<T>) -> Motion<T> {
        Motion { ang: self.z(m.ang), lin: self.z(m.lin) }
    }

    /// A force given in the axes turned about z, in those before.
    #[inline(always)]
    pub fn z_back_force(self, f: Force<T>) -> Force<T> {
        Force { ang: self.z_back(f.ang), lin: self.z_back(f.lin) }
    }

    /// An inertia given in the axes turned about z, in those before.
    #[inline(always)]
    pub fn z_back_inertia(self, i: SpatialInertia<T>) -> SpatialInertia<T> {
        SpatialInertia {
            mass: i.mass,
            first_moment: self.z_back(i.first_moment),
            rotational: self.z_back_sym(i.rotational),
        }
    }

    /// An articulated inertia given in the axes turned about z, in those before.
    #[inline(always)]
    pub fn z_back_articulated(self, i: ArticulatedInertia<T>) -> ArticulatedInertia<T> {
        ArticulatedInertia { ang: self.z_back_sym(i.ang), mixed: self.z_back_mat(i.mixed), lin: self.z_back_sym(i.lin) }
    }

    /// `Rzᵀ A Rz`.
    #[inline(always)]
    pub fn z_back_sym(self, a: SymMat3<T>) -> SymMat3<T> {
        let (xx, yy, xy) = self.sym_back(a.xx, a.yy, a.xy);
        let (xz, yz) = self.pair_back(a.xz, a.yz);
        SymMat3 { xx, yy, zz: a.zz, xy, xz, yz }
    }

    /// `Rxᵀ A Rx`.
    #[inline(always)]
    pub fn x_back_sym(self, a: SymMat3<T>) -> SymMat3<T> {
        let (yy, zz, yz) = self.sym_back(a.yy, a.zz, a.yz);
        let (xy, xz) = self.pair_back(a.xy, a.xz);
        SymMat3 { xx: a.xx, yy, zz, xy, xz, yz }
    }

    /// `Rzᵀ A Rz`.
    #[inline(always)]
    pub fn z_back_mat(self, a: Mat3<T>) -> Mat3<T> {
        let [a, b, c] = a.rows;
        let [[xx, xy], [yx, yy]] = self.mat_back([[a.x, a.y], [b.x, b.y]]);
        let (xz, yz) = self.pair_back(a.z, b.z);
        let (zx, zy) = self.pair_back(c.x, c.y);
        Mat3::from_rows(Vec3::new(xx, xy, xz), Vec3::new(yx, yy, yz), Vec3::new(zx, zy, c.z))
    }

    /// `Rxᵀ A Rx`.
    #[inline(always)]
    pub fn x_back_mat(self, a: Mat3<T>) -> Mat3<T> {
        let [a, b, c] = a.rows;
        let [[yy, yz], [zy, zz]] = self.mat_back([[b.y, b.z], [c.y, c.z]]);
        let (xy, xz) = self.pair_back(a.y, a.z);
        let (yx, zx) = self.pair_back(b.x, c.x);
        Mat3::from_rows(Vec3::new(a.x, xy, xz), Vec3::new(yx, yy, yz), Vec3::new(zx, zy, zz))
    }

    /// A transform followed by this turn about z: `Rz X`.
    #[inline(always)]
    pub fn z_after(self, x: Transform<T>) -> Transform<T> {
        let [a, b, c] = x.rot.rows;
        let (a, b) = self.pair_of(a, b);
        Transform { rot: Mat3::from_rows(a, b, c), pos: x.pos }
    }

    /// [`Turn::pair`] of all coordinates of two rows.
    #[inline(always)]
    pub(super) fn pair_of(self, a: Vec3<T>, b: Vec3<T>) -> (Vec3<T>, Vec3<T>) {
        (b.scale(self.sin).plus_scaled(self.cos, a), b.scale(self.cos).plus_scaled(-self.sin, a))
    }

    /// `R [a; b]` in the plane, `R = [[c, s], [−s, c]]`.
    #[inline(always)]
    pub(super) fn pair(self, a: T, b: T) -> (T, T) {
        (self.cos.mul_add(a, self.sin * b), self.cos.mul_add(b, -(self.sin * a)))
    }

    /// `Rᵀ [a; b]` in the plane.
    #[inline(always)]
    pub(super) fn pair_back(self, a: T, b: T) -> (T, T) {
        (self.cos.mul_add(a, -(self.sin * b)), self.sin.mul_add(a, self.cos * b))
    }

    /// `Rᵀ A R` of `A = [[aa, ab], [ab, bb]]` in the plane: entries `aa`, `bb`, `ab`.
    #[inline(always)]
    pub(super) fn sym_back(self, aa: T, bb: T, ab: T) -> (T, T, T) {
        // aa' = aa − s² (aa − bb) − 2 s c ab,   bb' = bb + s² (aa − bb) + 2 s c ab,   ab' = s c (aa − bb) + (1 − 2 s²) ab
        let (ss, sc, d) = (self.sin * self.sin, self.sin * self.cos, aa - bb);
        let (sin_2, cos_2) = (sc + sc, T::one() - (ss + ss));
        let w = ss.mul_add(d, sin_2 * ab);
        (aa - w, bb + w, sc.mul_add(d, cos_2 * ab))
    }

    /// `Rᵀ A R` of a general `A` in the plane.
    #[inline(always)]
    pub(super) fn mat_back(self, [[aa, ab], [ba, bb]]: [[T; 2]; 2]) -> [[T; 2]; 2] {
        // With w = s (aa − bb) + c (ab + ba):   aa' = aa − s w,   bb' = bb + s w,   ab' = c w − ba,   ba' = c w − ab
        let w = self.sin.mul_add(aa - bb, self.cos * (ab + ba));
        let (sw, cw) = (self.sin * w, self.cos * w);
        [[aa - sw, cw - ba], [cw - ab, bb + sw]]
    }
}
