//! Where links and frames are, how they move, and how joint velocities move them.

use super::check_scratch;
use super::tree::{RootMotion, Tree, turns};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Body, JointKind, Model, SizeError};
use crate::spatial::{Mat3, Motion, Transform, Turn};

/// A frame fixed to a body.
#[derive(Clone, Copy, Debug)]
pub struct Frame<T> {
    /// Index of the body.
    pub body: usize,
    /// Pose of the frame in the body's link frame.
    pub placement: Transform<T>,
}

/// The axes in which a Jacobian's rows are given. Its reference point is the frame's origin in both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// Axes of the world.
    World,
    /// Axes of the frame itself.
    Local,
}

/// Pose of every link frame in the world: one transform per body, from the world to the link frame.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn placements<T: Scalar>(model: &Model<T::Param>, q: &[T], out: &mut [Transform<T>]) -> Result<(), SizeError> {
    T::dispatch(Placements { model, q, out })
}

struct Placements<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    q: &'a [T],
    out: &'a mut [Transform<T>],
}

impl<T: Scalar> Kernel<T> for Placements<'_, '_, T> {
    type Output = Result<(), SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<(), SizeError> {
        let Self { model, q, out } = self;
        let tree = Tree::of(model);
        let ((root_out, out), joints_q) = (tree.bodies_mut("out", out)?, tree.positions(q)?);
        turns::<T, F, _>(tree.joints, joints_q, out, Body::angle, |pose, theta| {
            (pose.pos.x, pose.pos.y) = (theta.sin, theta.cos);
        });
        let mut base = Transform::identity();
        if tree.root.is_some() {
            let at = RootMotion::<F>::of(q, &[]);
            base = Transform { rot: at.rot, pos: at.pos };
        }
        // X_0i = X_i X_0p, in the frames of the recursion; the user's link frames come last.
        let mut previous = base;
        for i in 0..tree.joints.len() {
            let body = &tree.joints[i];
            let theta = Turn { sin: F::load(out[i].pos.x), cos: F::load(out[i].pos.y) };
            let parent = match body.branch() {
                None => previous,
                Some(branch) => branch
                    .after(tree.joint(body.parent).and_then(|p| out.get(p)).map_or(base, |pose| pose.map(F::load))),
            };
            previous = body.across(theta, F::load(joints_q[i])).after(parent);
            out[i] = previous.map(F::store);
        }
        for (body, pose) in tree.joints.iter().zip(out.iter_mut()) {
            *pose = body.frame.map(F::from_param).after(pose.map(F::load)).map(F::store);
        }
        if let (Some(root), [out, ..]) = (tree.root, root_out) {
            *out = root.frame.map(F::from_param).after(base).map(F::store);
        }
        Ok(())
    }
}

/// Spatial velocity of every link in its own link frame: one motion vector per body, angular first.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn velocities<T: Scalar>(
    model: &Model<T::Param>,
    q: &[T],
    qd: &[T],
    out: &mut [Motion<T>],
) -> Result<(), SizeError> {
    SizeError::check("q", q.len(), model.nq)?;
    SizeError::check("qd", qd.len(), model.nv)?;
    check_scratch(model, out)?;
    // v = X v_p + S q̇
    for (i, body) in model.bodies.iter().enumerate() {
        let v_p = body.parent().map_or(Motion::zero(), |p| out[p]);
        out[i] = velocity(body, v_p, q, qd);
    }
    for (body, v) in model.bodies.iter().zip(out.iter_mut()) {
        *v = body.frame.map(T::from_param).motion(*v);
    }
    Ok(())
}

/// `X`: from the parent to a body, whatever its joint.
pub(super) fn transform<T: Scalar>(body: &Body<T::Param>, q: &[T]) -> Transform<T> {
    let at = body.q_index();
    if body.joint == JointKind::Floating {
        let root = RootMotion::<T>::of(&q[at..], &[]);
        return Transform { rot: root.rot, pos: root.pos };
    }
    let (sin, cos) = body.angle(q[at]).sin_cos();
    let x = body.across(Turn { sin, cos }, q[at]);
    x.after(body.branch().map_or(Transform::identity(), |branch| branch.after(Transform::identity())))
}

/// `v = X v_p + S q̇`.
pub(super) fn velocity<T: Scalar>(body: &Body<T::Param>, v_p: Motion<T>, q: &[T], qd: &[T]) -> Motion<T> {
    let at = body.v_index();
    if body.joint == JointKind::Floating {
        return RootMotion::<T>::of(q, &qd[at..]).v;
    }
    body.joint.moved(transform(body, q).motion(v_p), qd[at])
}

/// Jacobian of a frame, `6 × nv` by rows, angular rows first: `J q̇` is the velocity of the frame's origin and the angular
/// velocity of the frame, in the axes asked for. Columns of joints that do not move the frame are zero.
///
/// `poses` has one entry per body and holds what [`placements`] wrote for the same `q`.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model, or the frame's body is not one of its bodies; nothing is written then.
pub fn jacobian<T: Scalar>(
    model: &Model<T::Param>,
    poses: &[Transform<T>],
    frame: Frame<T>,
    axes: Axes,
    out: &mut [T],
) -> Result<(), SizeError> {
    let nv = model.nv;
    SizeError::check("poses", poses.len(), model.bodies.len())?;
    SizeError::check("out", out.len(), 6 * nv)?;
    if frame.body >= model.bodies.len() {
        return Err(SizeError { argument: "frame.body", expected: model.bodies.len(), given: frame.body });
    }
    out.fill(T::zero());
    let mut target = frame.placement.after(poses[frame.body]);
    if axes == Axes::World {
        target.rot = Mat3::identity();
    }
    let mut at = Some(frame.body);
    while let Some(b) = at {
        let body = &model.bodies[b];
        // From the recursion's frame of the supporting body, where S is an axis, to the target frame.
        let here = body.frame.map(T::from_param).inverse().after(poses[b]);
        let to_target = target.after(here.inverse());
        for c in 0..body.joint.nv() {
            let mut unit = [T::zero(); 6];
            let entry = match body.joint {
                JointKind::Revolute => 2,
                JointKind::Prismatic => 5,
                JointKind::Floating => c,
            };
            unit[entry] = T::one();
            let column = to_target.motion(Motion::from(unit));
            for (row, value) in column.to_array().into_iter().enumerate() {
                out[row * nv + body.v_index() + c] = value;
            }
        }
        at = body.parent();
    }
    Ok(())
}
