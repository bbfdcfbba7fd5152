//! The transform across a joint, as planar rotations.

use super::{ArticulatedInertia, Force, Mat3, Motion, SpatialInertia, Transform, Turn, Vec3};
use crate::Scalar;

/// The Plücker transform to the body a joint moves from a frame of its parent whose x-axis is the common normal of both
/// joint axes: `E = Rz(θ) Rx(α)` about the point `offset`.
///
/// This is the modified convention of Denavit and Hartenberg (Craig, *Introduction to Robotics*, §3.4), whose two
/// parameters more along the axes are the offset here.
#[derive(Clone, Copy, Debug)]
pub struct JointTransform<T> {
    /// `α`, about x.
    pub alpha: Turn<T>,
    /// `θ`, about the joint axis z.
    pub theta: Turn<T>,
    /// Origin of the body, in the parent's axes [m].
    pub offset: Vec3<T>,
}

impl<T: Scalar> JointTransform<T> {
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
        Force { ang: self.offset.cross_plus(lin, self.rotate_back(f.ang)), lin }
    }

    /// `X m`: a motion of the parent, of the body.
    #[inline(always)]
    pub fn motion(&self, m: Motion<T>) -> Motion<T> {
        // v + ω × r
        Motion { ang: self.rotate(m.ang), lin: self.rotate(m.ang.cross_plus(self.offset, m.lin)) }
    }

    /// `Xᵀ I X`: the body's inertia, seen from the parent.
    #[inline(always)]
    pub fn inv_inertia(&self, i: SpatialInertia<T>) -> SpatialInertia<T> {
        let turned = SpatialInertia {
            mass: i.mass,
            first_moment: self.rotate_back(i.first_moment),
            rotational: self.alpha.x_back_sym(self.theta.z_back_sym(i.rotational)),
        };
        turned.moved(self.offset)
    }

    /// `Xᵀ Iᴬ X`: the body's articulated inertia, seen from the parent.
    #[inline(always)]
    pub fn inv_articulated(&self, ia: ArticulatedInertia<T>) -> ArticulatedInertia<T> {
        let turned = ArticulatedInertia {
            ang: self.alpha.x_back_sym(self.theta.z_back_sym(ia.ang)),
            mixed: self.alpha.x_back_mat(self.theta.z_back_mat(ia.mixed)),
            lin: self.alpha.x_back_sym(self.theta.z_back_sym(ia.lin)),
        };
        turned.moved(self.offset)
    }

    /// `X X_p`, `pose` being `X_p`, the parent's transform from some frame.
    #[inline(always)]
    pub fn after(&self, pose: Transform<T>) -> Transform<T> {
        let ([x, y, z], r) = (pose.rot.rows, self.offset);
        let pos = pose.pos.plus_scaled(r.x, x).plus_scaled(r.y, y).plus_scaled(r.z, z);
        let (y, z) = self.alpha.pair_of(y, z);
        let (x, y) = self.theta.pair_of(x, y);
        Transform { rot: Mat3::from_rows(x, y, z), pos }
    }
}
