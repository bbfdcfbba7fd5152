//! The tree as the recursions walk it: a base, fixed or floating, and joints of one degree of freedom in order.

use crate::Scalar;
use crate::dispatch::Over;
use crate::model::{Body, JointKind, Model};
use crate::scalar::ANGLES;
use crate::spatial::{Force, JointTransform, Mat3, Motion, SpatialInertia, Turn, Vec3};

/// A robot's bodies, a floating root apart from the others.
#[derive(Clone, Copy)]
pub(super) struct Tree<'a, P> {
    /// The body that moves freely, if there is one.
    pub(super) root: Option<&'a Body<P>>,
    /// All others, each moved by a joint of one degree of freedom.
    pub(super) joints: &'a [Body<P>],
    /// Number of bodies, positions and velocities that belong to the root.
    bodies: usize,
    positions: usize,
    velocities: usize,
}

/// The body a joint hangs on, or the one that carries its rotor.
#[derive(Clone, Copy)]
pub(super) enum Support {
    /// The one before in order, or the base for the first joint.
    Previous,
    /// The base.
    Base,
    /// One further back, by its index among the joints.
    Earlier(usize),
}

impl Support {
    /// Index among the joints, as seen from joint `i`; `None` is the base.
    #[inline(always)]
    pub(super) fn joint(self, i: usize) -> Option<usize> {
        match self {
            Self::Previous => i.checked_sub(1),
            Self::Base => None,
            Self::Earlier(b) => Some(b),
        }
    }
}

impl<'a, P: Scalar> Tree<'a, P> {
    #[inline(always)]
    pub(super) fn of(model: &Model<'a, P>) -> Self {
        match model.bodies {
            [root, joints @ ..] if root.joint == JointKind::Floating => {
                Self { root: Some(root), joints, bodies: 1, positions: 7, velocities: 6 }
            }
            joints => Self { root: None, joints, bodies: 0, positions: 0, velocities: 0 },
        }
    }

    /// Entries of a slice over all bodies that belong to the joints' bodies.
    #[inline(always)]
    pub(super) fn bodies<'s, X>(&self, all: &'s [X]) -> Option<&'s [X]> {
        all.get(self.bodies..)?.get(..self.joints.len())
    }

    /// The root's and the joints' part of a slice over all bodies.
    #[inline(always)]
    pub(super) fn split_bodies_mut<'s, X>(&self, all: &'s mut [X]) -> Option<(&'s mut [X], &'s mut [X])> {
        let (root, joints) = all.split_at_mut_checked(self.bodies)?;
        Some((root, joints.get_mut(..self.joints.len())?))
    }

    #[inline(always)]
    pub(super) fn bodies_mut<'s, X>(&self, all: &'s mut [X]) -> Option<&'s mut [X]> {
        all.get_mut(self.bodies..)?.get_mut(..self.joints.len())
    }

    /// Entries of `q` that belong to the joints.
    #[inline(always)]
    pub(super) fn positions<'s, X>(&self, q: &'s [X]) -> Option<&'s [X]> {
        q.get(self.positions..)?.get(..self.joints.len())
    }

    /// Entries of a slice over the velocities that belong to the joints.
    #[inline(always)]
    pub(super) fn velocities<'s, X>(&self, all: &'s [X]) -> Option<&'s [X]> {
        all.get(self.velocities..)?.get(..self.joints.len())
    }

    /// The root's and the joints' part of a slice over the velocities.
    #[inline(always)]
    pub(super) fn split_mut<'s, X>(&self, all: &'s mut [X]) -> Option<(&'s mut [X], &'s mut [X])> {
        let (root, joints) = all.split_at_mut_checked(self.velocities)?;
        Some((root, joints.get_mut(..self.joints.len())?))
    }

    /// A value of the whole robot's slice for joint `i`, zero if the slice is empty.
    #[inline(always)]
    pub(super) fn optional<T: Scalar, F: Over<T>>(&self, all: &[T], i: usize) -> F {
        all.get(self.velocities + i).map_or(F::zero(), |x| F::load(*x))
    }

    /// A body of the model, as seen from joint `i`.
    #[inline(always)]
    pub(super) fn support(&self, body: Option<u16>, i: usize) -> Support {
        match body.map(usize::from) {
            Some(b) if b + 1 == i + self.bodies => Support::Previous,
            Some(b) if b >= self.bodies => Support::Earlier(b - self.bodies),
            _ => Support::Base,
        }
    }
}

/// Sines and cosines of all joints' angles, several at a time.
#[inline(always)]
pub(super) fn turns<T: Scalar, F: Over<T>, S>(
    joints: &[Body<T::Param>],
    q: &[T],
    scratch: &mut [S],
    mut keep: impl FnMut(&mut S, Turn<T>),
) {
    for ((joints, q), scratch) in joints.chunks(ANGLES).zip(q.chunks(ANGLES)).zip(scratch.chunks_mut(ANGLES)) {
        let mut angles = [F::zero(); ANGLES];
        for ((angle, joint), q) in angles.iter_mut().zip(joints).zip(q) {
            *angle = joint.angle(F::load(*q));
        }
        for (s, (sin, cos)) in scratch.iter_mut().zip(F::sin_cos_each(angles)) {
            keep(s, Turn { sin: sin.store(), cos: cos.store() });
        }
    }
}

/// The first entries of a slice, zero where it ends.
#[inline(always)]
pub(super) fn first<T: Scalar, F: Over<T>, const N: usize>(all: &[T]) -> [F; N] {
    let mut entries = [F::zero(); N];
    for (to, from) in entries.iter_mut().zip(all) {
        *to = F::load(*from);
    }
    entries
}

/// Writes the first entries of a slice.
#[inline(always)]
pub(super) fn store_first<T: Scalar, F: Over<T>>(all: &mut [T], entries: [F; 6]) {
    for (to, from) in all.iter_mut().zip(entries) {
        *to = from.store();
    }
}

/// What a floating root's coordinates say, in its own axes.
pub(super) struct RootMotion<F> {
    /// From world axes to the root's.
    pub(super) rot: Mat3<F>,
    /// Position in the world.
    pub(super) pos: Vec3<F>,
    /// Twist.
    pub(super) v: Motion<F>,
}

impl<F: Scalar> RootMotion<F> {
    #[inline(always)]
    pub(super) fn of<T: Scalar>(q: &[T], qd: &[T]) -> Self
    where
        F: Over<T>,
    {
        let [x, y, z, rotation @ ..] = first::<T, F, 7>(q);
        Self {
            rot: Mat3::from_quaternion(rotation).transpose(),
            pos: Vec3::new(x, y, z),
            v: Motion::from(first::<T, F, 6>(qd)),
        }
    }
}

/// How a body turns, and how its origin accelerates as a point in space (the classical acceleration), gravity taken for an
/// acceleration upwards; all in the body's axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving<T> {
    /// `ω` [rad/s].
    pub(super) omega: Vec3<T>,
    /// `α` [rad/s²] and `a` [m/s²].
    pub(super) accel: Motion<T>,
    /// `Ω = α× + ω× ω×`: a point at `r` accelerates by `a + Ω r` [1/s²].
    pub(super) field: Mat3<T>,
}

impl<T: Scalar> Moving<T> {
    #[inline(always)]
    pub(super) fn new(omega: Vec3<T>, accel: Motion<T>) -> Self {
        // ω× ω× = ω ωᵀ − ω·ω 1
        let (w, a) = (omega, accel.ang);
        let (xx, yy, zz) = (w.x * w.x, w.y * w.y, w.z * w.z);
        let off = |p: T, q: T, a: T| (p.mul_add(q, a), p.mul_add(q, -a));
        let ((yx, xy), (xz, zx), (zy, yz)) = (off(w.x, w.y, a.z), off(w.x, w.z, a.y), off(w.y, w.z, a.x));
        let field = Mat3::from_rows(
            Vec3::new(-(yy + zz), xy, xz),
            Vec3::new(yx, -(xx + zz), yz),
            Vec3::new(zx, zy, -(xx + yy)),
        );
        Self { omega, accel, field }
    }

    #[inline(always)]
    pub(super) fn map<U>(self, mut f: impl FnMut(T) -> U) -> Moving<U> {
        Moving { omega: self.omega.map(&mut f), accel: self.accel.map(&mut f), field: self.field.map(&mut f) }
    }

    #[inline(always)]
    pub(super) fn at_rest() -> Self {
        Self { omega: Vec3::zero(), accel: Motion::zero(), field: Mat3::zero() }
    }

    /// The body across a joint of velocity `qd` and acceleration `qdd`.
    #[inline(always)]
    pub(super) fn across(self, x: &JointTransform<T>, joint: JointKind, qd: T, qdd: T) -> Self {
        // ω = E ω_p,   α = E α_p,   a = E (a_p + Ω_p r), and what the joint adds:
        let turned = x.turned_tensor(self.field);
        let omega = x.rotate(x.turned(self.omega));
        let ang = x.rotate(x.turned(self.accel.ang));
        let lin = x.rotate(x.turned(self.accel.lin) + turned * x.offset);
        match joint {
            // a += z q̈ + 2 ω × z q̇
            JointKind::Prismatic => {
                let twice = qd + qd;
                let lin = Vec3::new(omega.y.mul_add(twice, lin.x), (-omega.x).mul_add(twice, lin.y), lin.z + qdd);
                Self::new(omega, Motion { ang, lin })
            }
            // ω += z q̇,   α += z q̈ + ω × z q̇
            _ => {
                let ang = Vec3::new(omega.y.mul_add(qd, ang.x), (-omega.x).mul_add(qd, ang.y), ang.z + qdd);
                Self::new(Vec3::new(omega.x, omega.y, omega.z + qd), Motion { ang, lin })
            }
        }
    }

    /// Force about its origin that a body of this inertia needs.
    #[inline(always)]
    pub(super) fn force_on(&self, body: SpatialInertia<T>) -> Force<T> {
        // f = m a + Ω h,   n = I α + ω × I ω + h × a
        let (h, i, a) = (body.first_moment, body.rotational, self.accel);
        Force {
            ang: h.cross_plus(a.lin, self.omega.cross_plus(i * self.omega, i * a.ang)),
            lin: (self.field * h).plus_scaled(body.mass, a.lin),
        }
    }
}
