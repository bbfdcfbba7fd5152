//! The record of one link and its joint.

use super::{Drive, Friction};
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, SpatialInertia, Transform, Vec3};

/// How a joint moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointKind {
    /// Turns about its axis; `q` [rad] is not wrapped. URDF's `continuous` is this joint without limits.
    Revolute,
    /// Slides along its axis; `q` [m].
    Prismatic,
    /// Moves freely, only as body 0: `q` is the position of the link frame in the world [m] and the unit quaternion
    /// `x y z w` of its orientation; `qd` is the link's twist in its own frame, angular part first.
    Floating,
}

impl JointKind {
    /// Number of position coordinates.
    pub const fn nq(self) -> usize {
        match self {
            Self::Floating => 7,
            _ => 1,
        }
    }

    /// Number of velocity coordinates.
    pub const fn nv(self) -> usize {
        match self {
            Self::Floating => 6,
            _ => 1,
        }
    }
}

/// One link, the joint that moves it and the drive of that joint, as the recursions walk them.
///
/// Lowering has turned the frame so that the joint axis is its z-axis; only [`Body::frame`] knows the user's frame.
#[derive(Clone, Copy, Debug)]
pub struct Body<T> {
    pub(crate) parent: u16,
    pub(crate) joint: JointKind,
    pub(crate) iq: u16,
    pub(crate) iv: u16,
    pub(crate) tree: Transform<T>,
    pub(crate) inertia: SpatialInertia<T>,
    pub(crate) frame: Transform<T>,
    pub(crate) friction: Friction<T>,
    pub(crate) drive: Option<Drive<T>>,
}

/// Marks the fixed world where an index of a body stands.
pub(crate) const WORLD: u16 = u16::MAX;

impl<T: Scalar> Body<T> {
    /// Index of the parent body; `None` is the fixed world.
    pub fn parent(&self) -> Option<usize> {
        index(self.parent)
    }

    /// How the joint moves.
    pub fn joint(&self) -> JointKind {
        self.joint
    }

    /// Index of the joint's first entry in `q`.
    pub fn q_index(&self) -> usize {
        self.iq as usize
    }

    /// Index of the joint's first entry in `qd` and all vectors of its length.
    pub fn v_index(&self) -> usize {
        self.iv as usize
    }

    /// The drive of the joint.
    pub fn drive(&self) -> Option<&Drive<T>> {
        self.drive.as_ref()
    }

    /// Friction on the link side of the joint.
    pub fn friction(&self) -> &Friction<T> {
        &self.friction
    }

    /// From the frame the recursions use to the user's link frame.
    pub fn frame(&self) -> &Transform<T> {
        &self.frame
    }

    /// Whether the joint has a rotor behind an elastic transmission, and so a motor coordinate of its own.
    pub fn is_elastic(&self) -> bool {
        self.drive.is_some_and(|d| d.elastic.is_some())
    }

    /// `X`: from the parent to this body at the joint's coordinates in `q`.
    #[inline]
    pub(crate) fn transform(&self, q: &[T]) -> Transform<T> {
        match self.joint {
            JointKind::Revolute => {
                let (s, c) = q[self.iq as usize].sin_cos();
                let [x, y, z] = self.tree.rot.rows;
                // Rz(q)ᵀ E_tree touches the first two rows only.
                let rot = Mat3::from_rows(x.scale(c) + y.scale(s), y.scale(c) - x.scale(s), z);
                Transform { rot, pos: self.tree.pos }
            }
            JointKind::Prismatic => {
                let axis = self.tree.rot.rows[2];
                Transform { rot: self.tree.rot, pos: self.tree.pos + axis.scale(q[self.iq as usize]) }
            }
            JointKind::Floating => {
                let i = self.iq as usize;
                let quaternion = [q[i + 3], q[i + 4], q[i + 5], q[i + 6]];
                let free = Transform::from_pose(Mat3::from_quaternion(quaternion), Vec3::new(q[i], q[i + 1], q[i + 2]));
                free.after(self.tree)
            }
        }
    }

    /// `S qd`: the velocity across the joint, in this body's frame.
    #[inline]
    pub(crate) fn joint_velocity(&self, qd: &[T]) -> Motion<T> {
        let i = self.iv as usize;
        let mut v = Motion::zero();
        match self.joint {
            JointKind::Revolute => v.ang.z = qd[i],
            JointKind::Prismatic => v.lin.z = qd[i],
            JointKind::Floating => {
                v = Motion::from([qd[i], qd[i + 1], qd[i + 2], qd[i + 3], qd[i + 4], qd[i + 5]]);
            }
        }
        v
    }

    /// The same record in another scalar.
    pub(crate) fn map<U>(&self, mut f: impl FnMut(T) -> U) -> Body<U> {
        Body {
            parent: self.parent,
            joint: self.joint,
            iq: self.iq,
            iv: self.iv,
            tree: self.tree.map(&mut f),
            inertia: self.inertia.map(&mut f),
            frame: self.frame.map(&mut f),
            friction: self.friction.map(&mut f),
            drive: self.drive.map(|d| d.map(&mut f)),
        }
    }
}

/// What the recursions ask of a joint of one degree of freedom, its axis along z.
impl<T: Scalar> Body<T> {
    /// `Iᴬ S`.
    #[inline]
    pub(crate) fn column_of(&self, ia: &ArticulatedInertia<T>) -> Force<T> {
        match self.joint {
            JointKind::Prismatic => {
                let [x, y, z] = ia.mixed.rows;
                Force { ang: Vec3::new(x.z, y.z, z.z), lin: Vec3::new(ia.lin.xz, ia.lin.yz, ia.lin.zz) }
            }
            _ => Force { ang: Vec3::new(ia.ang.xz, ia.ang.yz, ia.ang.zz), lin: ia.mixed.rows[2] },
        }
    }

    /// `Sᵀ f`.
    #[inline]
    pub(crate) fn along_joint(&self, f: Force<T>) -> T {
        match self.joint {
            JointKind::Prismatic => f.lin.z,
            _ => f.ang.z,
        }
    }

    /// `m + S s`.
    #[inline]
    pub(crate) fn moved_along_joint(&self, mut m: Motion<T>, s: T) -> Motion<T> {
        match self.joint {
            JointKind::Prismatic => m.lin.z += s,
            _ => m.ang.z += s,
        }
        m
    }

    /// `B` of a rigidly geared rotor, which turns with the joint; zero without one.
    #[inline]
    pub(crate) fn rigid_reflected_inertia(&self) -> T {
        match &self.drive {
            Some(drive) if drive.elastic.is_none() => drive.rotor.reflected_inertia,
            _ => T::zero(),
        }
    }

    /// `[N J n; 0]` of a rigidly geared rotor, in the frame of its carrier; zero without one.
    #[inline]
    pub(crate) fn rigid_coupling(&self) -> Force<T> {
        match &self.drive {
            Some(drive) if drive.elastic.is_none() => {
                let r = &drive.rotor;
                Force::couple(r.axis.scale(r.gear_ratio * r.inertia))
            }
            _ => Force::zero(),
        }
    }
}

impl Body<f64> {
    /// The same record in another scalar, every number rounded to it.
    pub fn cast<U: Scalar>(&self) -> Body<U> {
        self.map(U::from_f64)
    }
}

/// The index of a body, `None` for the world.
pub(crate) fn index(i: u16) -> Option<usize> {
    (i != WORLD).then_some(i as usize)
}
