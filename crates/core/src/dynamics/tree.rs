//! The tree as the recursions walk it: a base, fixed or floating, and joints of one degree of freedom in order.

use super::External;
use crate::Scalar;
use crate::dispatch::Over;
use crate::model::{Body, JointKind, Model, SizeError};
use crate::scalar::ANGLES;
use crate::spatial::{Force, Mat3, Motion, Turn, Vec3};

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

    /// The joints' entries of a slice over all bodies.
    #[inline(always)]
    pub(super) fn bodies<'s, X>(&self, argument: &'static str, all: &'s [X]) -> Result<&'s [X], SizeError> {
        rest(argument, all, self.bodies, self.joints.len())
    }

    /// The same, and the root's entries before it.
    #[inline(always)]
    pub(super) fn bodies_mut<'s, X>(
        &self,
        argument: &'static str,
        all: &'s mut [X],
    ) -> Result<(&'s mut [X], &'s mut [X]), SizeError> {
        split(argument, all, self.bodies, self.joints.len())
    }

    /// The joints' entries of `q`.
    #[inline(always)]
    pub(super) fn positions<'s, X>(&self, all: &'s [X]) -> Result<&'s [X], SizeError> {
        rest("q", all, self.positions, self.joints.len())
    }

    /// The joints' entries of a slice over the velocities.
    #[inline(always)]
    pub(super) fn velocities<'s, X>(&self, argument: &'static str, all: &'s [X]) -> Result<&'s [X], SizeError> {
        rest(argument, all, self.velocities, self.joints.len())
    }

    /// The same, and the root's entries before it.
    #[inline(always)]
    pub(super) fn velocities_mut<'s, X>(
        &self,
        argument: &'static str,
        all: &'s mut [X],
    ) -> Result<(&'s mut [X], &'s mut [X]), SizeError> {
        split(argument, all, self.velocities, self.joints.len())
    }

    /// The joints' entries of the external loads, if there are any.
    #[inline(always)]
    #[expect(clippy::type_complexity)]
    pub(super) fn external<'s, T>(
        &self,
        ext: &External<'s, T>,
    ) -> Result<(Option<&'s [Force<T>]>, Option<&'s [T]>), SizeError> {
        let (wrenches, tau) = (ext.wrenches, ext.tau);
        let wrenches = if wrenches.is_empty() { None } else { Some(self.bodies("external wrenches", wrenches)?) };
        let tau = if tau.is_empty() { None } else { Some(self.velocities("external tau", tau)?) };
        Ok((wrenches, tau))
    }

    /// Index of a body among the joints; `None` is the base.
    #[inline(always)]
    pub(super) fn joint(&self, body: Option<u16>) -> Option<usize> {
        usize::from(body?).checked_sub(self.bodies)
    }
}

/// What follows the first `lead` of `lead + n` entries.
#[inline(always)]
fn rest<'s, X>(argument: &'static str, all: &'s [X], lead: usize, n: usize) -> Result<&'s [X], SizeError> {
    match all.get(lead..) {
        Some(rest) if rest.len() == n => Ok(rest),
        _ => Err(SizeError { argument, expected: lead + n, given: all.len() }),
    }
}

/// The first `lead` of `lead + n` entries, and the others, cut to `n`: an index below `n` then needs no check.
#[inline(always)]
fn split<'s, X>(
    argument: &'static str,
    all: &'s mut [X],
    lead: usize,
    n: usize,
) -> Result<(&'s mut [X], &'s mut [X]), SizeError> {
    let given = all.len();
    let error = SizeError { argument, expected: lead + n, given };
    let (root, rest) = all.split_at_mut_checked(lead).ok_or(error)?;
    match rest.get_mut(..n) {
        Some(rest) if given - lead == n => Ok((root, rest)),
        _ => Err(error),
    }
}

/// Entry `i` of a slice that has one: some compilers do not see that it does, and to ask costs less than to panic.
#[inline(always)]
pub(super) fn entry<T: Scalar, F: Over<T>>(all: &[T], i: usize) -> F {
    all.get(i).map_or(F::zero(), |x| F::load(*x))
}

/// Sines and cosines of all joints' angles, several at a time.
#[inline(always)]
pub(super) fn turns<T: Scalar, F: Over<T>, S>(
    joints: &[Body<T::Param>],
    q: &[T],
    scratch: &mut [S],
    angle: impl Fn(&Body<T::Param>, F) -> F,
    mut keep: impl FnMut(&mut S, Turn<T>),
) {
    let mut start = 0;
    while start < joints.len() {
        // The last group reaches back, so that every group is whole.
        let from = start.min(joints.len().saturating_sub(ANGLES));
        let (joints, q) = (joints.get(from..).unwrap_or(&[]), q.get(from..).unwrap_or(&[]));
        let scratch = scratch.get_mut(from..).unwrap_or(&mut []);
        match (joints.first_chunk::<ANGLES>(), q.first_chunk::<ANGLES>(), scratch.first_chunk_mut::<ANGLES>()) {
            (Some(joints), Some(q), Some(scratch)) => {
                F::sin_cos_each(
                    #[inline(always)]
                    |k| angle(&joints[k], F::load(q[k])),
                    #[inline(always)]
                    |k, sin, cos| keep(&mut scratch[k], Turn { sin: sin.store(), cos: cos.store() }),
                );
            }
            _ => {
                for ((joint, q), s) in joints.iter().zip(q).zip(scratch) {
                    let (sin, cos) = angle(joint, F::load(*q)).sin_cos();
                    keep(s, Turn { sin: sin.store(), cos: cos.store() });
                }
            }
        }
        start += ANGLES;
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
