//! The equations of motion in the axes and about the origin of the base (the world, or a floating root), and how they change
//! with position and velocity.
//!
//! A joint that moves by `dq` turns everything it carries about `S`, and changes the velocities there by `ψ̇ dq` beside, the
//! accelerations by `ψ̈ dq`, with `ψ̇ = v_p × S` and `ψ̈ = a_p × S + v_p × ψ̇` of the body `p` before the joint. With composite
//! inertias `Iᶜ`, composite `2Bᶜ` ([`Coriolis`]) and the force `fᶜ` through the joint, that gives for joints `i ⪯ j`, `i` nearer
//! to the base (Singh, Russell & Wensing 2022, eq. 38–41):
//!
//! ```text
//! ∂τ_i/∂q_j = S_i·(2Bᶜ_j ψ̇_j + Iᶜ_j ψ̈_j + S_j ×* fᶜ_j)      ∂τ_j/∂q_i = S_j·(2Bᶜ_j ψ̇_i + Iᶜ_j ψ̈_i)
//! ∂τ_i/∂q̇_j = S_i·(2Bᶜ_j S_j + Iᶜ_j (ψ̇_j + Ṡ_j))             ∂τ_j/∂q̇_i = S_j·(2Bᶜ_j S_i + Iᶜ_j (ψ̇_i + Ṡ_i))
//! ```
//!
//! `Ṡ = ψ̇` for a joint of one degree of freedom. The six axes of a floating root are carried by the root itself: `ψ̇ = 0` and
//! `Ṡ = v_0 × S`. A rotor adds its couple to the force of its carrier, and what the couple depends on to the carrier's `2B`.

use super::tree::{RootMotion, Tree, turns};
use crate::Scalar;
use crate::dispatch::Over;
use crate::model::{Body, JointKind, Model, Rotor, SizeError};
use crate::spatial::{Coriolis, Force, Mat3, Motion, SpatialInertia, Transform, Turn, Vec3};

/// What the algorithms of this family keep for one body during a call, in base coordinates.
#[derive(Clone, Copy, Debug)]
pub struct DerivativeScratch<T> {
    /// Sine and cosine of the joint's angle.
    pub(super) theta: Turn<T>,
    /// From the base to the body.
    pub(super) pose: Transform<T>,
    /// `S`.
    pub(super) axis: Motion<T>,
    /// `ψ̇`.
    pub(super) axis_rate: Motion<T>,
    /// `ψ̈`.
    pub(super) axis_acceleration: Motion<T>,
    /// Velocity.
    pub(super) v: Motion<T>,
    /// Acceleration, gravity taken for an acceleration upwards.
    pub(super) a: Motion<T>,
    /// Inertia, first of the body, then `Iᶜ`.
    pub(super) inertia: SpatialInertia<T>,
    /// `2B`, first of the body, then composite.
    pub(super) coriolis: Coriolis<T>,
    /// Force that the body needs, then the force through its joint.
    pub(super) f: Force<T>,
    /// `Iᶜ S`.
    pub(super) column: Force<T>,
    /// What the accelerations of the joints beyond ask for at this one: `Σ Iᶜ S q̈`.
    pub(super) beyond: Force<T>,
}

impl<T: Scalar> DerivativeScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            theta: Turn::none(),
            pose: Transform::identity(),
            axis: Motion::zero(),
            axis_rate: Motion::zero(),
            axis_acceleration: Motion::zero(),
            v: Motion::zero(),
            a: Motion::zero(),
            inertia: SpatialInertia::zero(),
            coriolis: Coriolis::zero(),
            f: Force::zero(),
            column: Force::zero(),
            beyond: Force::zero(),
        }
    }

    /// A force that the body's carried things need beside, on the body.
    #[inline(always)]
    pub(super) fn add_force<F: Over<T>>(&mut self, f: Force<F>) {
        self.f = (self.f.map(F::load) + f).map(F::store);
    }
}

impl<T: Scalar> Default for DerivativeScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Poses, axes and velocities, base to tips, and what each body alone asks for: inertia, `2B`, and its force at the accelerations
/// `qdd`. The inertias are those that `inertia` gives. `ψ̈` is left out where `TURNING` is false.
#[inline(always)]
pub(super) fn outward<T: Scalar, F: Over<T>, const TURNING: bool>(
    model: &Model<T::Param>,
    q: &[T],
    qd: impl Fn(usize) -> F,
    qdd: impl Fn(usize) -> F,
    inertia: impl Fn(&Body<T::Param>) -> SpatialInertia<F>,
    scratch: &mut [DerivativeScratch<T>],
) -> Result<(), SizeError> {
    let tree = Tree::of(model);
    let lead = model.bodies.len() - tree.joints.len();
    let (joint_q, joint_scratch) = (tree.positions(q)?, tree.bodies_mut("scratch", scratch)?.1);
    turns::<T, F, _>(tree.joints, joint_q, joint_scratch, Body::angle, |s, theta| s.theta = theta);

    let lift = -model.gravity.map(F::from_param);
    let at_rest = (Transform::identity(), Motion::zero(), Motion { ang: Vec3::zero(), lin: lift });
    for (i, body) in model.bodies.iter().enumerate() {
        let (pose, v, a);
        if body.joint == JointKind::Floating {
            let root = RootMotion::<F>::of(q, &[]);
            (pose, v) = (Transform::identity(), Motion::from([0, 1, 2, 3, 4, 5].map(&qd)));
            let asked = Motion::from([0, 1, 2, 3, 4, 5].map(&qdd));
            a = Motion { ang: asked.ang, lin: asked.lin + root.rot * lift };
            // What the six axes of the root have in place of ψ̈ is `lift` crossed with them.
            scratch[i].axis_acceleration = Motion { ang: Vec3::zero(), lin: root.rot * lift }.map(F::store);
        } else {
            let (parent, v_p, a_p) = match body.parent().and_then(|p| scratch.get(p)) {
                Some(p) => (p.pose.map(F::load), p.v.map(F::load), p.a.map(F::load)),
                None => at_rest,
            };
            let k = body.v_index();
            let (qd, qdd) = (qd(k), qdd(k));
            let x = body.across(scratch[i].theta.map(F::load), F::load(joint_q[i - lead]));
            pose = x.after(body.branch().map_or(parent, |branch| branch.after(parent)));
            let z = pose.rot.rows[2];
            let axis = match body.joint {
                JointKind::Prismatic => Motion { ang: Vec3::zero(), lin: z },
                _ => Motion { ang: z, lin: pose.pos.cross(z) },
            };
            // v = v_p + S q̇,   ψ̇ = v_p × S,   a = a_p + ψ̇ q̇ + S q̈,   ψ̈ = a_p × S + v_p × ψ̇
            let axis_rate = v_p.cross(axis);
            v = v_p + axis.scale(qd);
            a = a_p + axis_rate.scale(qd) + axis.scale(qdd);
            let s = &mut scratch[i];
            s.axis = axis.map(F::store);
            s.axis_rate = axis_rate.map(F::store);
            if TURNING {
                s.axis_acceleration = (a_p.cross(axis) + v_p.cross(axis_rate)).map(F::store);
            }
        }
        // f = I a + v ×* I v
        let inertia = inertia(body).seen_from_parent(pose);
        let momentum = inertia.momentum(v);
        let s = &mut scratch[i];
        s.pose = pose.map(F::store);
        s.v = v.map(F::store);
        s.a = a.map(F::store);
        s.f = (inertia.momentum(a) + v.cross_force(momentum)).map(F::store);
        s.inertia = inertia.map(F::store);
        s.coriolis = Coriolis::of(&inertia, v, momentum.lin).map(F::store);
        s.beyond = Force::zero();
    }
    Ok(())
}

/// Adds the loads from outside to the bodies' forces.
#[inline(always)]
pub(super) fn subtract_wrenches<T: Scalar, F: Over<T>>(
    model: &Model<T::Param>,
    wrenches: &[Force<T>],
    scratch: &mut [DerivativeScratch<T>],
) {
    for ((body, wrench), s) in model.bodies.iter().zip(wrenches).zip(scratch) {
        let on_body = body.frame.map(F::from_param).inv_force(wrench.map(F::load));
        s.add_force(-s.pose.map(F::load).inv_force(on_body));
    }
}

/// A rotor on its carrier: the carrier's index and angular velocity, and the rotor's axis in base coordinates. `None` for a rotor
/// on the fixed world, which nothing moves.
#[inline(always)]
pub(super) fn carrier<T: Scalar, F: Over<T>>(
    rotor: &Rotor<T::Param>,
    scratch: &[DerivativeScratch<T>],
) -> Option<(usize, Vec3<F>, Vec3<F>)> {
    let m = rotor.mount()?;
    let s = scratch.get(m)?;
    Some((m, s.v.ang.map(F::load), s.pose.rot.map(F::load).transpose_mul(rotor.axis_in())))
}

/// `N J`.
#[inline(always)]
pub(super) fn spin<T: Scalar, F: Over<T>>(rotor: &Rotor<T::Param>) -> F {
    F::from_param(rotor.gear_ratio) * F::from_param(rotor.inertia)
}

/// Adds to the carrier `m` of a rotor its couple, and `turning`: what a further angular velocity of the carrier adds to it.
#[inline(always)]
pub(super) fn load_carrier<T: Scalar, F: Over<T>>(
    scratch: &mut [DerivativeScratch<T>],
    m: usize,
    couple: Vec3<F>,
    turning: Mat3<F>,
) {
    let Some(s) = scratch.get_mut(m) else { return };
    s.add_force(Force::couple(couple));
    s.coriolis.turning = (s.coriolis.turning.map(F::load) + turning).map(F::store);
}

/// Adds what body `i` carries to its parent, when `i` is complete.
#[inline(always)]
pub(super) fn hand_on<T: Scalar, F: Over<T>>(body: &Body<T::Param>, i: usize, scratch: &mut [DerivativeScratch<T>]) {
    let Some((before, [s, ..])) = scratch.split_at_mut_checked(i) else { return };
    let Some(parent) = body.parent().and_then(|p| before.get_mut(p)) else { return };
    parent.inertia = (parent.inertia.map(F::load) + s.inertia.map(F::load)).map(F::store);
    parent.coriolis = (parent.coriolis.map(F::load) + s.coriolis.map(F::load)).map(F::store);
    parent.add_force(s.f.map(F::load));
}

/// Sets an entry.
#[inline(always)]
pub(super) fn set<T: Scalar, F: Over<T>>(entries: &mut [T], at: usize, x: F) {
    if let Some(entry) = entries.get_mut(at) {
        *entry = x.store();
    }
}

/// Adds to an entry.
#[inline(always)]
pub(super) fn add<T: Scalar, F: Over<T>>(entries: &mut [T], at: usize, x: F) {
    if let Some(entry) = entries.get_mut(at) {
        *entry = (F::load(*entry) + x).store();
    }
}

/// Unit vector of one coordinate, angular first.
#[inline(always)]
pub(super) fn unit<F: Scalar>(coordinate: usize) -> Motion<F> {
    let mut entries = [F::zero(); 6];
    if let Some(entry) = entries.get_mut(coordinate) {
        *entry = F::one();
    }
    Motion::from(entries)
}
