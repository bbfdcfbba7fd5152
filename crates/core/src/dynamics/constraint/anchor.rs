//! One constraint in base axes: the wrench of a unit multiplier in each direction, and what violates it.

use super::frames::{Root, SupportScratch, joint_of};
use super::spec::{Anchor, Constraint, Directions, Hold};
use crate::Scalar;
use crate::dispatch::Over;
use crate::dynamics::kinematics::Frame;
use crate::dynamics::tree::Tree;
use crate::spatial::{Force, Mat3, Motion, Transform, Vec3};

/// A constraint at a state; arrays have an entry for each of six directions, zero in those that are free.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held<F> {
    /// Wrench about the base's origin of a unit multiplier, on the frame's body; the anchor's body feels the opposite.
    pub(super) wrenches: [Force<F>; 6],
    /// `Φ` [m or rad].
    pub(super) error: [F; 6],
    /// `Φ̇` [m/s or rad/s].
    pub(super) velocity: [F; 6],
    /// What velocities add to the difference of the bodies' accelerations, to make `Φ̈` of it.
    pub(super) bias: [F; 6],
    /// The frame's origin, in base axes [m].
    pub(super) point: Vec3<F>,
}

impl<F: Scalar> Held<F> {
    #[inline(always)]
    pub(super) fn of<T: Scalar>(
        constraint: &Constraint<T>,
        tree: &Tree<'_, T::Param>,
        root: &Root<F>,
        q: &[T],
        qd: &[T],
        scratch: &[SupportScratch<T>],
    ) -> Self
    where
        F: Over<T>,
    {
        match &constraint.hold {
            Hold::Frame { frame, anchor, directions } => {
                Self::of_frames::<T>(frame, anchor, *directions, tree, root, scratch)
            }
            Hold::Joints { joint, follows, ratio, offset } => {
                // The joints' entries are the last ones of q and of q̇.
                let lead = |all: &[T]| all.len() - tree.joints.len().min(all.len());
                let entry = |all: &[T], body: usize| {
                    joint_of(tree, Some(body)).and_then(|i| all.get(lead(all) + i)).map_or(F::zero(), |x| F::load(*x))
                };
                let difference = |all: &[T]| entry(all, *joint) - F::load(*ratio) * entry(all, *follows);
                let mut held = Self::free();
                held.error[0] = difference(q) - F::load(*offset);
                held.velocity[0] = difference(qd);
                held
            }
        }
    }

    #[inline(always)]
    pub(super) fn free() -> Self {
        let zero = [F::zero(); 6];
        Self { wrenches: [Force::zero(); 6], error: zero, velocity: zero, bias: zero, point: Vec3::zero() }
    }

    #[inline(always)]
    fn of_frames<T: Scalar>(
        frame: &Frame<T>,
        anchor: &Anchor<T>,
        directions: Directions,
        tree: &Tree<'_, T::Param>,
        root: &Root<F>,
        scratch: &[SupportScratch<T>],
    ) -> Self
    where
        F: Over<T>,
    {
        let on = Side::<F>::of(Some(frame.body), frame.placement, tree, root, scratch);
        let to = Side::<F>::of(anchor.body, anchor.placement, tree, root, scratch);
        let (p, axes) = (on.pose.pos, to.pose.rot.rows);

        // Relative motion at the frame's origin p:  ω = ω_a − ω_b,   v = v_a(p) − v_b(p)
        let at = |side: &Side<F>| side.v.lin + side.v.ang.cross(p);
        let (omega, v) = (on.v.ang - to.v.ang, at(&on) - at(&to));
        // d/dt of n·ω and n·v, n fixed in b:  n·(α_a − α_b − ω_b × ω_a),   n·(a_a(p) − a_b(p) − 2 ω_b × v)
        let centripetal = |side: &Side<F>| side.v.ang.cross(side.v.ang.cross(p - side.origin));
        let turning = -to.v.ang.cross(on.v.ang);
        let coriolis = to.v.ang.cross(v);
        let moving = centripetal(&on) - centripetal(&to) - coriolis - coriolis;

        let (r, tilt) = (p - to.pose.pos, tilt(to.pose.rot * on.pose.rot.transpose(), directions));
        let mut held = Self { point: p, ..Self::free() };
        for k in 0..3 {
            let n = axes[k];
            if directions.contains(k) {
                held.wrenches[k] = Force::couple(n);
                held.error[k] = tilt.to_array()[k];
                held.velocity[k] = n.dot(omega);
                held.bias[k] = n.dot(turning);
            }
            if directions.contains(k + 3) {
                held.wrenches[k + 3] = Force { ang: p.cross(n), lin: n };
                held.error[k + 3] = n.dot(r);
                held.velocity[k + 3] = n.dot(v);
                held.bias[k + 3] = n.dot(moving);
            }
        }
        held
    }

    /// The same in other numbers.
    #[inline(always)]
    pub(super) fn map<U>(self, f: impl Fn(F) -> U) -> Held<U> {
        Held {
            wrenches: self.wrenches.map(|w| w.map(&f)),
            error: self.error.map(&f),
            velocity: self.velocity.map(&f),
            bias: self.bias.map(&f),
            point: self.point.map(&f),
        }
    }

    /// Wrench about the frame's origin, in world axes, of the multipliers.
    #[inline(always)]
    pub(super) fn wrench_in_world(&self, root: &Root<F>, total: Force<F>) -> Force<F> {
        let about_point = total.ang - self.point.cross(total.lin);
        Force { ang: root.in_world(about_point), lin: root.in_world(total.lin) }
    }
}

/// One of the two frames, in base axes.
struct Side<F> {
    pose: Transform<F>,
    /// Velocity of its body.
    v: Motion<F>,
    /// Origin of its body in the recursion [m].
    origin: Vec3<F>,
}

impl<F: Scalar> Side<F> {
    #[inline(always)]
    fn of<T: Scalar>(
        body: Option<usize>,
        placement: Transform<T>,
        tree: &Tree<'_, T::Param>,
        root: &Root<F>,
        scratch: &[SupportScratch<T>],
    ) -> Self
    where
        F: Over<T>,
    {
        let placement = placement.map(F::load);
        let Some(index) = body else {
            let pose = placement.after(root.pose.inverse());
            return Self { pose, v: Motion::zero(), origin: pose.pos };
        };
        let (record, pose, v) = match joint_of(tree, Some(index)).and_then(|i| Some((i, scratch.get(i)?))) {
            Some((i, s)) => (tree.joints.get(i), s.pose.map(F::load), s.v.map(F::load)),
            None => (tree.root, Transform::identity(), root.v),
        };
        let link = record.map_or(Transform::identity(), |record| record.frame.map(F::from_param));
        Self { pose: placement.after(link).after(pose), v, origin: pose.pos }
    }
}

/// By how much a frame is turned away, in the anchor's axes, to first order [rad]: `relative` takes the frame's coordinates to the anchor's.
///
/// Of three rotations, the axial vector of the turn; of two, the tilt of the axis about which the frame may turn.
#[inline(always)]
fn tilt<F: Scalar>(relative: Mat3<F>, directions: Directions) -> Vec3<F> {
    let [x, y, z] = relative.rows;
    let zero = F::zero();
    match [0, 1, 2].map(|k| directions.contains(k)) {
        [false, true, true] => Vec3::new(zero, -z.x, y.x),
        [true, false, true] => Vec3::new(z.y, zero, -x.y),
        [true, true, false] => Vec3::new(-y.z, x.z, zero),
        _ => Vec3::new(z.y - y.z, x.z - z.x, y.x - x.y).scale(F::from_f64(0.5)),
    }
}
