//! Poses and velocities of the bodies between constrained frames and the base, in base axes.

use super::spec::{Constraint, Hold};
use crate::Scalar;
use crate::dispatch::Over;
use crate::dynamics::tree::{RootMotion, Tree};
use crate::model::JointKind;
use crate::spatial::{Motion, Transform, Turn, Vec3};

/// What constraints keep for one body during a call, in base coordinates.
#[derive(Clone, Copy, Debug)]
pub struct SupportScratch<T> {
    /// Whether a constraint's force passes here on its way to the base.
    pub(super) supports: bool,
    /// Sine and cosine of the joint's angle.
    pub(super) theta: Turn<T>,
    /// From the base to the body.
    pub(super) pose: Transform<T>,
    /// `S`.
    pub(super) axis: Motion<T>,
    /// Velocity.
    pub(super) v: Motion<T>,
}

impl<T: Scalar> SupportScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            supports: false,
            theta: Turn::none(),
            pose: Transform::identity(),
            axis: Motion::zero(),
            v: Motion::zero(),
        }
    }
}

impl<T: Scalar> Default for SupportScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// The base, in its own axes.
#[derive(Clone, Copy)]
pub(super) struct Root<F> {
    /// From the world to the base.
    pub(super) pose: Transform<F>,
    /// Velocity, zero where the base is the world.
    pub(super) v: Motion<F>,
}

impl<F: Scalar> Root<F> {
    #[inline(always)]
    pub(super) fn of<T: Scalar, P: Scalar>(tree: &Tree<'_, P>, q: &[T], qd: &[T]) -> Self
    where
        F: Over<T>,
    {
        match tree.root {
            None => Self { pose: Transform::identity(), v: Motion::zero() },
            Some(_) => {
                let at = RootMotion::<F>::of(q, qd);
                Self { pose: Transform { rot: at.rot, pos: at.pos }, v: at.v }
            }
        }
    }

    /// A vector from base to world axes.
    #[inline(always)]
    pub(super) fn in_world(&self, v: Vec3<F>) -> Vec3<F> {
        self.pose.rot.transpose_mul(v)
    }
}

/// The two bodies of a constraint.
#[inline(always)]
pub(super) fn bodies<T: Scalar>(constraint: &Constraint<T>) -> [Option<usize>; 2] {
    match &constraint.hold {
        Hold::Frame { frame, anchor, .. } => [Some(frame.body), anchor.body],
        Hold::Joints { joint, follows, .. } => [Some(*joint), Some(*follows)],
    }
}

/// A body's index among the joints; `None` is the base, or the world.
#[inline(always)]
pub(super) fn joint_of<P: Scalar>(tree: &Tree<'_, P>, body: Option<usize>) -> Option<usize> {
    body.and_then(|b| tree.joint(u16::try_from(b).ok()))
}

/// Marks the bodies that carry constraints, to the base.
#[inline(always)]
pub(super) fn mark<T: Scalar>(
    tree: &Tree<'_, T::Param>,
    constraints: &[Constraint<T>],
    scratch: &mut [SupportScratch<T>],
) {
    scratch.iter_mut().for_each(|s| s.supports = false);
    for constraint in constraints {
        for body in bodies(constraint) {
            let mut at = joint_of(tree, body);
            while let Some(i) = at {
                match scratch.get_mut(i) {
                    Some(s) if !s.supports => s.supports = true,
                    _ => break,
                }
                at = tree.joint(tree.joints.get(i).and_then(|body| body.parent));
            }
        }
    }
}

/// `X`, `S` and `v = v_p + S q̇` of the marked bodies, base to tips. `theta` is known.
#[inline(always)]
pub(super) fn outward<T: Scalar, F: Over<T>>(
    tree: &Tree<'_, T::Param>,
    root: &Root<F>,
    q: &[T],
    qd: &[T],
    scratch: &mut [SupportScratch<T>],
) {
    for (i, body) in tree.joints.iter().enumerate() {
        let Some(s) = scratch.get(i).filter(|s| s.supports) else { continue };
        let (theta, position) = (s.theta.map(F::load), q.get(i).map_or(F::zero(), |q| F::load(*q)));
        let (parent, v_p) = match tree.joint(body.parent).and_then(|p| scratch.get(p)) {
            Some(p) => (p.pose.map(F::load), p.v.map(F::load)),
            None => (Transform::identity(), root.v),
        };
        // A body on the fixed world does not move with the base; there is none beside a floating root.
        let pose = body.across(theta, position).after(body.branch().map_or(parent, |branch| branch.after(parent)));
        let z = pose.rot.rows[2];
        let axis = match body.joint {
            JointKind::Prismatic => Motion { ang: Vec3::zero(), lin: z },
            _ => Motion { ang: z, lin: pose.pos.cross(z) },
        };
        let v = v_p + axis.scale(qd.get(i).map_or(F::zero(), |qd| F::load(*qd)));
        if let Some(s) = scratch.get_mut(i) {
            s.pose = pose.map(F::store);
            s.axis = axis.map(F::store);
            s.v = v.map(F::store);
        }
    }
}
