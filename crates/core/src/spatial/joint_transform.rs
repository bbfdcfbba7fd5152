//! The transform across a joint, as planar rotations.

use super::{ArticulatedInertia, Force, Mat3, Motion, SpatialInertia, Transform, Turn, Vec3};
use crate::Scalar;

/// The Plücker transform to the body a joint moves from a frame of its parent whose x-axis is the common normal of both
/// joint axes: along x by `a`, about x by `α`, along the joint axis by `d`, about it by `θ`.
///
/// These are the parameters of Denavit and Hartenberg in the modified convention (Craig, *Introduction to Robotics*, §3.4).
/// One at a time, each touches few coordinates.
#[derive(Clone, Copy, Debug)]
pub struct JointTransform<T> {
    /// `a`, along the common normal x [m].
    pub a: T,
    /// `α`, about x.
    pub alpha: Turn<T>,
    /// `d`, along the joint axis z [m].
    pub d: T,
    /// `θ`, about the joint axis z.
    pub theta: Turn<T>,
}

impl<T: Scalar> JointTransform<T> {
    /// Origin of the body, in the parent's axes [m].
    #[inline(always)]
    pub fn offset(&self) -> Vec3<T> {
        Vec3::new(self.a, -(self.d * self.alpha.sin), self.d * self.alpha.cos)
    }

    /// From the axes of the parent to those of the body: `Rz(θ) Rx(α) v`.
    #[inline(always)]
    pub fn rotate(&self, v: Vec3<T>) -> Vec3<T> {
        self.theta.z(self.alpha.x(v))
    }

    /// From the axes of the body to those of the parent: `Rx(α)ᵀ Rz(θ)ᵀ v`.
    #[inline(always)]
    pub fn rotate_back(&self, v: Vec3<T>) -> Vec3<T> {
        self.alpha.x_back(self.theta.z_back(v))
    }

    /// `Xᵀ f`: a force on the body, on the parent.
    #[inline(always)]
    pub fn inv_force(&self, f: Force<T>) -> Force<T> {
        let lin = self.rotate_back(f.lin);
        Force { ang: self.offset().cross_plus(lin, self.rotate_back(f.ang)), lin }
    }

    /// `X m`: a motion of the parent, of the body.
    #[inline(always)]
    pub fn motion(&self, m: Motion<T>) -> Motion<T> {
        let (mut w, mut v) = (m.ang, m.lin);
        // v + ω × a x
        (v.y, v.z) = (self.a.mul_add(w.z, v.y), (-self.a).mul_add(w.y, v.z));
        (w, v) = (self.alpha.x(w), self.alpha.x(v));
        // v + ω × d z
        (v.x, v.y) = (self.d.mul_add(w.y, v.x), (-self.d).mul_add(w.x, v.y));
        Motion { ang: self.theta.z(w), lin: self.theta.z(v) }
    }

    /// `Xᵀ I X`: the body's inertia, seen from the parent.
    #[inline(always)]
    pub fn inv_inertia(&self, i: SpatialInertia<T>) -> SpatialInertia<T> {
        let turned = SpatialInertia {
            mass: i.mass,
            first_moment: self.rotate_back(i.first_moment),
            rotational: self.alpha.x_back_sym(self.theta.z_back_sym(i.rotational)),
        };
        turned.moved(self.offset())
    }

    /// `Xᵀ Iᴬ X`: the body's articulated inertia, seen from the parent.
    #[inline(always)]
    pub fn inv_articulated(&self, ia: ArticulatedInertia<T>) -> ArticulatedInertia<T> {
        let about_z = ArticulatedInertia {
            ang: self.theta.z_back_sym(ia.ang),
            mixed: self.theta.z_back_mat(ia.mixed),
            lin: self.theta.z_back_sym(ia.lin),
        };
        let along_z = about_z.moved_along_z(self.d);
        let about_x = ArticulatedInertia {
            ang: self.alpha.x_back_sym(along_z.ang),
            mixed: self.alpha.x_back_mat(along_z.mixed),
            lin: self.alpha.x_back_sym(along_z.lin),
        };
        about_x.moved_along_x(self.a)
    }

    /// `X X_p`, `pose` being `X_p`, the parent's transform from some frame.
    #[inline(always)]
    pub fn after(&self, pose: Transform<T>) -> Transform<T> {
        let [x, y, z] = pose.rot.rows;
        let pos = pose.pos.plus_scaled(self.a, x);
        let (y, z) = self.alpha.pair_of(y, z);
        let pos = pos.plus_scaled(self.d, z);
        let (x, y) = self.theta.pair_of(x, y);
        Transform { rot: Mat3::from_rows(x, y, z), pos }
    }
}
