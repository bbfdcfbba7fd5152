//! The constant transform that a joint beside the first of a link needs.

use super::{ArticulatedInertia, Force, Motion, SpatialInertia, Transform, Turn, Vec3};
use crate::Scalar;

/// From a body's frame to the common normal with the axis of a joint other than the one its x-axis is made for: a turn about
/// z and a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Branch<T> {
    /// `β`: turn about z to the common normal.
    pub turn: Turn<T>,
    /// Point on the common normal where the [`JointTransform`](super::JointTransform) begins, in the turned axes [m].
    pub shift: Vec3<T>,
}

impl<T: Scalar> Branch<T> {
    /// A motion of the body, beyond the branch.
    #[inline(always)]
    pub fn motion(self, m: Motion<T>) -> Motion<T> {
        let m = self.turn.z_motion(m);
        Motion { ang: m.ang, lin: m.ang.cross_plus(self.shift, m.lin) }
    }

    /// A force beyond the branch, on the body.
    #[inline(always)]
    pub fn inv_force(self, f: Force<T>) -> Force<T> {
        self.turn.z_back_force(Force { ang: self.shift.cross_plus(f.lin, f.ang), lin: f.lin })
    }

    /// An inertia beyond the branch, seen from the body.
    #[inline(always)]
    pub fn inv_inertia(self, i: SpatialInertia<T>) -> SpatialInertia<T> {
        self.turn.z_back_inertia(i.moved(self.shift))
    }

    /// An articulated inertia beyond the branch, seen from the body.
    #[inline(always)]
    pub fn inv_articulated(self, i: ArticulatedInertia<T>) -> ArticulatedInertia<T> {
        self.turn.z_back_articulated(i.moved(self.shift))
    }

    /// The branch after the transform `pose` from some frame to the body.
    #[inline(always)]
    pub fn after(self, pose: Transform<T>) -> Transform<T> {
        let turned = self.turn.z_after(pose);
        Transform { rot: turned.rot, pos: turned.pos + turned.rot.transpose_mul(self.shift) }
    }

    /// The same in other numbers.
    #[inline(always)]
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Branch<U> {
        Branch { turn: self.turn.map(&mut f), shift: self.shift.map(&mut f) }
    }
}
