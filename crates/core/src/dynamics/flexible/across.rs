//! The transform across a joint from its parent's frame, branch and all.

use crate::Scalar;
use crate::model::Body;
use crate::spatial::{ArticulatedInertia, Branch, Force, JointTransform, Motion, Transform, Turn, Vec3};

/// From the frame that carries a joint to the body that the joint moves.
pub(super) struct Across<T> {
    branch: Option<Branch<T>>,
    joint: JointTransform<T>,
}

impl<T: Scalar> Across<T> {
    pub(super) fn of(body: &Body<T::Param>, theta: Turn<T>, q: T) -> Self {
        Self { branch: body.branch(), joint: body.across(theta, q) }
    }

    /// Axes of the carrying frame to those of the branch.
    fn turned(&self, v: Vec3<T>) -> Vec3<T> {
        self.branch.map_or(v, |branch| branch.turn.z(v))
    }

    /// `E v`.
    pub(super) fn rotate(&self, v: Vec3<T>) -> Vec3<T> {
        self.joint.rotate(self.turned(v))
    }

    /// `E (ω × (ω × r))`, `r` the body's origin: its acceleration for the carrying frame's `ω`.
    pub(super) fn centripetal(&self, omega: Vec3<T>) -> Vec3<T> {
        let omega = self.turned(omega);
        let r = self.branch.map_or(Vec3::zero(), |branch| branch.shift) + self.joint.offset();
        self.joint.rotate(crate::dynamics::aba_base::centripetal(omega, r))
    }

    /// `X m`.
    pub(super) fn motion(&self, m: Motion<T>) -> Motion<T> {
        self.joint.motion(self.branch.map_or(m, |branch| branch.motion(m)))
    }

    /// `Xᵀ f`.
    pub(super) fn inv_force(&self, f: Force<T>) -> Force<T> {
        let f = self.joint.inv_force(f);
        self.branch.map_or(f, |branch| branch.inv_force(f))
    }

    /// `Xᵀ Iᴬ X`.
    pub(super) fn inv_articulated(&self, ia: ArticulatedInertia<T>) -> ArticulatedInertia<T> {
        let ia = self.joint.inv_articulated(ia);
        self.branch.map_or(ia, |branch| branch.inv_articulated(ia))
    }

    /// `X X_p`.
    pub(super) fn after(&self, pose: Transform<T>) -> Transform<T> {
        self.joint.after(self.branch.map_or(pose, |branch| branch.after(pose)))
    }
}
