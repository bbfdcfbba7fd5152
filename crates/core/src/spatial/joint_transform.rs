//! The transform across a joint, as planar rotations.

use super::{ArticulatedInertia, Force, Mat3, Motion, SpatialInertia, Transform, Turn, Vec3};
use crate::Scalar;

/// The Plücker transform from a parent to the body a joint moves, `E = Rz(θ) Rx(α) Rz(β)` about the point `offset`.
///
/// Lowering turns the frames so that `β` vanishes between a body and the first of its children: that is the modified
/// convention of Denavit and Hartenberg (Craig, *Introduction to Robotics*, §3.4), whose two parameters more along the
/// axes are the offset here.
#[derive(Clone, Copy, Debug)]
pub struct JointTransform<T> {
    /// `β`, about the parent's z-axis; only for a child that is not its parent's first.
    pub beta: Option<Turn<T>>,
    /// `α`, about x.
    pub alpha: Turn<T>,
    /// `θ`, about the joint axis z.
    pub theta: Turn<T>,
    /// Origin of the body, in the parent's axes turned by `β` [m].
    pub offset: Vec3<T>,
}

impl<T: Scalar> JointTransform<T> {
    /// The parent's axes turned by `β`.
    #[inline(always)]
    pub fn turned(&self, v: Vec3<T>) -> Vec3<T> {
        match self.beta {
            Some(beta) => beta.z(v),
            None => v,
        }
    }

    /// From those back to the parent's.
    #[inline(always)]
    pub fn turned_back(&self, v: Vec3<T>) -> Vec3<T> {
        match self.beta {
            Some(beta) => beta.z_back(v),
            None => v,
        }
    }

    /// A tensor of the parent in its axes turned by `β`.
    #[inline(always)]
    pub fn turned_tensor(&self, a: Mat3<T>) -> Mat3<T> {
        match self.beta {
            Some(Turn { sin, cos }) => Turn { sin: -sin, cos }.z_back_mat(a),
            None => a,
        }
    }

    /// From the parent's axes turned by `β` to those of the body: `Rz(θ) Rx(α) v`.
    #[inline(always)]
    pub fn rotate(&self, v: Vec3<T>) -> Vec3<T> {
        self.theta.z(self.alpha.x(v))
    }

    /// From the axes of the body to the parent's turned by `β`: `Rx(α)ᵀ Rz(θ)ᵀ v`.
    #[inline(always)]
    pub fn rotate_back(&self, v: Vec3<T>) -> Vec3<T> {
        self.alpha.x_back(self.theta.z_back(v))
    }

    /// `Xᵀ f`: a force on the body, on the parent.
    #[inline(always)]
    pub fn inv_force(&self, f: Force<T>) -> Force<T> {
        let lin = self.rotate_back(f.lin);
        let ang = self.offset.cross_plus(lin, self.rotate_back(f.ang));
        Force { ang: self.turned_back(ang), lin: self.turned_back(lin) }
    }

    /// `X m`: a motion of the parent, of the body.
    #[inline(always)]
    pub fn motion(&self, m: Motion<T>) -> Motion<T> {
        let (ang, lin) = (self.turned(m.ang), self.turned(m.lin));
        // v + ω × r
        Motion { ang: self.rotate(ang), lin: self.rotate(ang.cross_plus(self.offset, lin)) }
    }

    /// `Xᵀ I X`: the body's inertia, seen from the parent.
    #[inline(always)]
    pub fn inv_inertia(&self, i: SpatialInertia<T>) -> SpatialInertia<T> {
        let turned = SpatialInertia {
            mass: i.mass,
            first_moment: self.rotate_back(i.first_moment),
            rotational: self.alpha.x_back_sym(self.theta.z_back_sym(i.rotational)),
        };
        let moved = turned.moved(self.offset);
        match self.beta {
            Some(beta) => SpatialInertia {
                mass: moved.mass,
                first_moment: beta.z_back(moved.first_moment),
                rotational: beta.z_back_sym(moved.rotational),
            },
            None => moved,
        }
    }

    /// `Xᵀ Iᴬ X`: the body's articulated inertia, seen from the parent.
    #[inline(always)]
    pub fn inv_articulated(&self, ia: ArticulatedInertia<T>) -> ArticulatedInertia<T> {
        let turned = ArticulatedInertia {
            ang: self.alpha.x_back_sym(self.theta.z_back_sym(ia.ang)),
            mixed: self.alpha.x_back_mat(self.theta.z_back_mat(ia.mixed)),
            lin: self.alpha.x_back_sym(self.theta.z_back_sym(ia.lin)),
        };
        self.shifted(turned)
    }

    /// An inertia in the parent's axes turned by `β` about the body's origin, about the parent's.
    #[inline(always)]
    pub(super) fn shifted(&self, ia: ArticulatedInertia<T>) -> ArticulatedInertia<T> {
        let moved = ia.moved(self.offset);
        match self.beta {
            Some(beta) => ArticulatedInertia {
                ang: beta.z_back_sym(moved.ang),
                mixed: beta.z_back_mat(moved.mixed),
                lin: beta.z_back_sym(moved.lin),
            },
            None => moved,
        }
    }

    /// The same with all nine entries of the rotation.
    #[inline(always)]
    pub fn to_transform(&self) -> Transform<T> {
        // Rows of E are the body's axes, in the parent's.
        let axis = |x: T, y: T, z: T| self.turned_back(self.rotate_back(Vec3::new(x, y, z)));
        let (o, i) = (T::zero(), T::one());
        let rot = Mat3::from_rows(axis(i, o, o), axis(o, i, o), axis(o, o, i));
        Transform { rot, pos: self.turned_back(self.offset) }
    }

    /// `X X_p`, `pose` being `X_p`, the parent's transform from some frame.
    #[inline(always)]
    pub fn after(&self, pose: Transform<T>) -> Transform<T> {
        let [x, y, z] = pose.rot.rows;
        let mix = |t: Turn<T>, a: Vec3<T>, b: Vec3<T>| {
            (a.scale(t.cos).plus_scaled(t.sin, b), b.scale(t.cos).plus_scaled(-t.sin, a))
        };
        let (x, y) = match self.beta {
            Some(beta) => mix(beta, x, y),
            None => (x, y),
        };
        let r = self.offset;
        let pos = pose.pos.plus_scaled(r.x, x).plus_scaled(r.y, y).plus_scaled(r.z, z);
        let (y, z) = mix(self.alpha, y, z);
        let (x, y) = mix(self.theta, x, y);
        Transform { rot: Mat3::from_rows(x, y, z), pos }
    }
}
