//! Forward dynamics in one sweep out, one in and one out: the articulated-body algorithm (RBDA table 7.1) on the link tree,
//! with every rotor's own coordinate eliminated in place.
//!
//! An elastic joint's rotor obeys a scalar equation of its own, `ḣ = (τ − τ_J)/N` with `h = J (N θ̇ + n·ω)`, and acts on
//! the link that carries it by the couple `−(ḣ n + ω × h n)`. Everything on the right is known from the state, so the
//! 2n coordinates of the complete model cost one pass over n links whose inertia is `I_eff = I + I_r − J n nᵀ`
//! (PHYSICS §3; Zhao, Yu, Wang, Tomizuka 2015, eq. 10).
//!
//! A rigid gear turns its rotor with the joint, which adds `B` to the joint's own inertia and `N J n` to the force that
//! accelerating the joint exerts on the parent: `W = Xᵀ U + [N J n; 0]` takes the place of `Xᵀ U` (PHYSICS §3). The reduced and
//! the rigid reflected model are the same recursion with `n = 0`.
//!
//! Accelerations are those of points in space, as in [`super::rnea`], so that no linear velocity is needed.
//!
//! Cost O(n). No allocation, no panic, no branch on values.

use super::aba_base::{Base, centripetal, velocity_force};
use super::drive_torque::{JointState, drives, rotor_acceleration, rotor_couple, rotor_torque};
use super::tree::{Tree, entry, first, store_first, turns};
use super::{AbaScratch, External, Forward, State};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Body, JointKind, Model, SizeError};
use crate::spatial::{ArticulatedInertia, Force, Motion, Vec3};

/// Accelerations of all joints and motors from state, motor torques and external loads.
///
/// `tau` are the motor torques reflected to the link side, `nv` entries [N m or N]; on a joint without a drive they act
/// directly, on a floating root as a wrench in its own frame. `scratch` has one record per body.
///
/// Exact for every model and tree, but for a *rigidly* geared rotor carried by a body other than its joint's parent
/// ([`Model::has_remote_rigid_rotor`]): that needs [`super::forward_dynamics`], which picks the route.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn aba<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: &mut [AbaScratch<T>],
    out: Forward<T>,
) -> Result<(), SizeError> {
    T::dispatch(Aba { model, state: &state, tau, ext: &ext, scratch, out: &mut { out } })
}

struct Aba<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    state: &'a State<'a, T>,
    tau: &'a [T],
    ext: &'a External<'a, T>,
    scratch: &'a mut [AbaScratch<T>],
    out: &'a mut Forward<'a, T>,
}

impl<T: Scalar> Kernel<T> for Aba<'_, '_, T> {
    type Output = Result<(), SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<(), SizeError> {
        if self.model.plain { self.passes::<F, true>() } else { self.passes::<F, false>() }
    }
}

impl<T: Scalar> Aba<'_, '_, T> {
    /// `PLAIN` says that all joints are revolute and no gear is rigid.
    #[inline(always)]
    fn passes<F: Over<T>, const PLAIN: bool>(self) -> Result<(), SizeError> {
        let Self { model, state, tau, ext, scratch, out } = self;
        let known = Known::of(model, state, tau, ext)?;
        let (_, scratch) = known.tree.bodies_mut("scratch", scratch)?;
        let mut found = Found::of(&known.tree, out)?;
        let mut base = outward::<T, F, PLAIN>(&known, scratch, found.tau_j);
        inward::<T, F, PLAIN>(&known, scratch, &mut base);
        accelerations::<T, F, PLAIN>(&known, scratch, &base, &mut found);
        Ok(())
    }
}

/// What forward dynamics is given, cut to the joints of one degree of freedom.
pub(super) struct Known<'a, 'm, T: Scalar> {
    pub(super) tree: Tree<'m, T::Param>,
    model: &'a Model<'m, T::Param>,
    state: &'a State<'a, T>,
    tau: &'a [T],
    ext: &'a External<'a, T>,
    pub(super) q: &'a [T],
    pub(super) qd: &'a [T],
    theta: &'a [T],
    thetad: &'a [T],
    motor: &'a [T],
    wrenches: Option<&'a [Force<T>]>,
    tau_ext: Option<&'a [T]>,
}

impl<'a, 'm, T: Scalar> Known<'a, 'm, T> {
    #[inline(always)]
    pub(super) fn of(
        model: &'a Model<'m, T::Param>,
        state: &'a State<'a, T>,
        tau: &'a [T],
        ext: &'a External<'a, T>,
    ) -> Result<Self, SizeError> {
        let tree = Tree::of(model);
        let (q, qd) = (tree.positions(state.q)?, tree.velocities("qd", state.qd)?);
        let (theta, thetad) = (tree.velocities("theta", state.theta)?, tree.velocities("thetad", state.thetad)?);
        let motor = tree.velocities("tau", tau)?;
        let (wrenches, tau_ext) = tree.external(ext)?;
        Ok(Self { tree, model, state, tau, ext, q, qd, theta, thetad, motor, wrenches, tau_ext })
    }

    /// For [`at_rest`], which takes positions alone; the velocities `qd` are kept for whom they concern.
    #[inline(always)]
    pub(super) fn of_impulses(
        model: &'a Model<'m, T::Param>,
        state: &'a State<'a, T>,
        ext: &'a External<'a, T>,
        qd: &'a [T],
    ) -> Result<Self, SizeError> {
        let tree = Tree::of(model);
        let (q, qd) = (tree.positions(state.q)?, tree.velocities("qd", qd)?);
        let none: &[T] = &[];
        let known = Self {
            tree,
            model,
            state,
            tau: none,
            ext,
            q,
            qd,
            theta: none,
            thetad: none,
            motor: none,
            wrenches: None,
            tau_ext: None,
        };
        Ok(known)
    }
}

/// What forward dynamics writes, the root's entries apart from the joints'.
pub(super) struct Found<'a, T> {
    root_qdd: &'a mut [T],
    qdd: &'a mut [T],
    root_thetadd: &'a mut [T],
    thetadd: &'a mut [T],
    root_tau_j: &'a mut [T],
    pub(super) tau_j: &'a mut [T],
}

impl<'a, T> Found<'a, T> {
    #[inline(always)]
    pub(super) fn of<P: Scalar>(tree: &Tree<'_, P>, out: &'a mut Forward<'_, T>) -> Result<Self, SizeError> {
        let (root_qdd, qdd) = tree.velocities_mut("qdd", out.qdd)?;
        let (root_thetadd, thetadd) = tree.velocities_mut("thetadd", out.thetadd)?;
        let (root_tau_j, tau_j) = tree.velocities_mut("tau_j", out.tau_j)?;
        Ok(Self { root_qdd, qdd, root_thetadd, thetadd, root_tau_j, tau_j })
    }
}

/// Pass 1, base to tips: velocities, and forces that are known from the state. Returns what is known of the base.
#[inline(always)]
pub(super) fn outward<T: Scalar, F: Over<T>, const PLAIN: bool>(
    known: &Known<T>,
    scratch: &mut [AbaScratch<T>],
    tau_j: &mut [T],
) -> Base<F> {
    let Known { tree, model, state, q, qd, theta, thetad, motor, tau_ext, .. } = *known;
    let (joints, n) = (tree.joints, tree.joints.len());
    let kind = |body: &Body<T::Param>| if PLAIN { JointKind::Revolute } else { body.joint };
    turns::<T, F, _>(joints, q, scratch, |body, q| body.angle_as(kind(body), q), |s, theta| s.theta = theta);

    // At each joint for itself: τ on its link side, τ − τ_J on its rotor.
    for i in 0..n {
        let (q, qd, theta, thetad) = (entry(q, i), entry(qd, i), entry(theta, i), entry(thetad, i));
        let load = tau_ext.map_or(F::zero(), |tau| entry(tau, i));
        let known = drives(&joints[i], JointState { q, qd, theta, thetad }, entry(motor, i), load, model.knots);
        scratch[i].u = known.on_link.store();
        scratch[i].on_rotor = known.on_rotor.store();
        tau_j[i] = known.tau_j.store();
    }

    let mut base = Base::<F>::of(&tree, state.q, state.qd, known.ext);

    let omega_0 = base.omega;
    let omega_at = |b: Option<u16>, scratch: &[AbaScratch<T>]| {
        tree.joint(b).and_then(|b| scratch.get(b)).map_or(omega_0, |s| s.omega.map(F::load))
    };
    let mut previous = omega_0;
    for i in 0..n {
        let body = &joints[i];
        let joint = kind(body);
        let qd = F::load(qd[i]);
        let x = body.across_as(joint, scratch[i].theta.map(F::load), F::load(q[i]));
        let (parent, turned, r) = match body.branch() {
            None => (previous, previous, x.offset()),
            Some(branch) => {
                let parent = omega_at(body.parent, scratch);
                (parent, branch.turn.z(parent), branch.shift + x.offset())
            }
        };

        // ω = E ω_p + z q̇,   c = [ω × z q̇; E (ω_p × (ω_p × r))]
        let mut omega = x.rotate(turned);
        let mut c = Motion { ang: Vec3::zero(), lin: x.rotate(centripetal(turned, r)) };
        let across = Vec3::new(omega.y * qd, -(omega.x * qd), F::zero());
        match joint {
            JointKind::Prismatic => c.lin += across + across,
            _ => {
                c.ang = across;
                omega.z += qd;
            }
        }

        // pᴬ = [ω × I ω; ω × (ω × h)]
        let p = velocity_force(body.inertia.map(F::from_param), omega);

        // The rotor's couple on its carrier
        if let Some(drive) = &body.drive {
            let beside = drive.rotor.mount == body.parent;
            let omega = if beside { parent } else { omega_at(drive.rotor.mount, scratch) };
            let spin = drive.spin(qd, entry(thetad, i));
            let couple = rotor_couple(drive, spin, omega, F::load(scratch[i].on_rotor));
            scratch[i].couple = couple.map(F::store);
            if !beside {
                match tree.joint(drive.rotor.mount).and_then(|b| scratch.get_mut(b)) {
                    Some(carrier) => carrier.p.ang = (carrier.p.ang.map(F::load) + couple).map(F::store),
                    None => base.p.ang += couple,
                }
            }
        }

        let s = &mut scratch[i];
        s.c = c.map(F::store);
        s.p = p.map(F::store);
        if body.shared {
            s.omega = omega.map(F::store);
            s.ia = ArticulatedInertia::zero();
        }
        previous = omega;
    }
    if let Some(wrenches) = known.wrenches {
        for i in 0..n {
            let wrench = joints[i].frame.map(F::from_param).inv_force(wrenches[i].map(F::load));
            scratch[i].p = (scratch[i].p.map(F::load) - wrench).map(F::store);
        }
    }
    base
}

/// In the place of pass 1, for impulses: nothing moves, no force is finite enough to count.
#[inline(always)]
pub(super) fn at_rest<T: Scalar, F: Over<T>>(
    known: &Known<T>,
    scratch: &mut [AbaScratch<T>],
    tau_j: &mut [T],
) -> Base<F> {
    let Known { tree, q, .. } = *known;
    turns::<T, F, _>(tree.joints, q, scratch, Body::angle, |s, theta| s.theta = theta);
    for (s, tau_j) in scratch.iter_mut().zip(tau_j) {
        *s = AbaScratch { theta: s.theta, ..AbaScratch::new() };
        *tau_j = T::zero();
    }
    Base::of::<T>(&tree, known.state.q, &[], known.ext)
}

/// Pass 2, tips to base: articulated inertias, chain by chain from its tip to the body that it hangs on.
#[inline(always)]
pub(super) fn inward<T: Scalar, F: Over<T>, const PLAIN: bool>(
    known: &Known<T>,
    scratch: &mut [AbaScratch<T>],
    base: &mut Base<F>,
) {
    let Known { tree, q, .. } = *known;
    let (joints, n) = (tree.joints, tree.joints.len());
    let kind = |body: &Body<T::Param>| if PLAIN { JointKind::Revolute } else { body.joint };
    let mut at = n;
    while at > 0 {
        let (mut ia_next, mut p_next) = (ArticulatedInertia::zero(), Force::zero());
        while let Some(i) = at.checked_sub(1) {
            let (Some(body), Some(s), Some(q)) = (joints.get(i), scratch.get_mut(i), q.get(i)) else { break };
            at = i;
            let joint = kind(body);
            let mut ia = ia_next.plus_rigid(body.inertia.map(F::from_param));
            if body.shared {
                ia += s.ia.map(F::load);
            }
            let (p, c) = (s.p.map(F::load) + p_next, s.c.map(F::load));

            // U = Iᴬ S,  d = Sᵀ U (+ B),  u = τ − Sᵀ pᴬ,  u' = u − Uᵀ c
            let u_cap = joint.column_of(&ia);
            let own = joint.along(u_cap);
            let d_inv = F::one() / if PLAIN { own } else { own + body.rigid_reflected_inertia() };
            let u = F::load(s.u) - joint.along(p);
            let left = u - c.dot(u_cap);
            s.u_cap = u_cap.map(F::store);
            s.d_inv = d_inv.store();
            s.u = left.store();

            // The fixed world bears whatever comes.
            if body.parent.is_none() {
                break;
            }

            // Iᵃ = Iᴬ − U Uᵀ/d,   pᵃ = pᴬ + Iᵃ c + U u/d;   Iᴬ_p += Xᵀ Iᵃ X,   pᴬ_p += Xᵀ pᵃ
            let x = body.across_as(joint, s.theta.map(F::load), F::load(*q));
            (ia_next, p_next) = if PLAIN {
                let released = ia.released_about_z(d_inv);
                let pa = (p + released.force([c.ang.x, c.ang.y], c.lin)).plus_scaled(u * d_inv, u_cap);
                (released.seen_from_parent(&x), x.inv_force(pa))
            } else {
                // With W = Xᵀ U + [N J n; 0] for Xᵀ U: a rigidly geared rotor leans on the parent, too.
                let lean = body.rigid_coupling::<F>();
                let lean = body.branch().map_or(lean, |branch| Force::couple(branch.turn.z(lean.ang)));
                let w = x.inv_force(u_cap) + lean;
                let pa = x.inv_force(ia.force(c) + p).plus_scaled(left * d_inv, w);
                (x.inv_articulated(ia).minus_outer(w, d_inv), pa)
            };
            let couple = match &body.drive {
                Some(drive) if drive.rotor.mount == body.parent => s.couple.map(F::load),
                _ => Vec3::zero(),
            };
            let Some(branch) = body.branch() else {
                p_next.ang += couple;
                continue;
            };
            let (ia, p) = (branch.inv_articulated(ia_next), branch.inv_force(p_next) + Force::couple(couple));
            match tree.joint(body.parent).and_then(|p| scratch.get_mut(p)) {
                Some(parent) => {
                    parent.ia = (parent.ia.map(F::load) + ia).map(F::store);
                    parent.p = (parent.p.map(F::load) + p).map(F::store);
                }
                None => (base.ia, base.p) = (base.ia + ia, base.p + p),
            }
            break;
        }
    }
}

/// Pass 3, base to tips: accelerations.
#[inline(always)]
pub(super) fn accelerations<T: Scalar, F: Over<T>, const PLAIN: bool>(
    known: &Known<T>,
    scratch: &mut [AbaScratch<T>],
    base: &Base<F>,
    found: &mut Found<T>,
) {
    let Known { tree, model, tau, ext, q, .. } = *known;
    let (joints, n) = (tree.joints, tree.joints.len());
    let Found { root_qdd, qdd, root_thetadd, thetadd, root_tau_j, tau_j } = found;
    let kind = |body: &Body<T::Param>| if PLAIN { JointKind::Revolute } else { body.joint };
    let (base_a, free) = base.acceleration(-model.gravity.map(F::from_param), tau, ext);
    if let Some(free) = free {
        store_first(root_qdd, free.to_array());
        store_first(root_thetadd, free.to_array());
        store_first(root_tau_j, first::<T, F, 6>(tau));
    }
    let accel_at = |b: Option<u16>, scratch: &[AbaScratch<T>]| {
        tree.joint(b).and_then(|b| scratch.get(b)).map_or(base_a, |s| s.a.map(F::load))
    };
    let mut previous = base_a;
    for i in 0..n {
        let (body, s) = (&joints[i], &scratch[i]);
        let joint = kind(body);
        let (parent, turned) = match body.branch() {
            None => (previous, previous),
            Some(branch) => {
                let parent = accel_at(body.parent, scratch);
                (parent, branch.motion(parent))
            }
        };

        // q̈ = (u' − Uᵀ X a_p − N J n·α_p)/d,   a = X a_p + c + S q̈
        let moved = body.across_as(joint, s.theta.map(F::load), F::load(q[i])).motion(turned);
        let mut left = F::load(s.u) - moved.dot(s.u_cap.map(F::load));
        if let Some(rotor) = body.rigid_rotor().filter(|_| !PLAIN) {
            left -= rotor.coupling().dot(parent.ang);
        }
        let acceleration = left * F::load(s.d_inv);
        let a = joint.moved(moved + s.c.map(F::load), acceleration);
        qdd[i] = acceleration.store();

        // The rotor follows: an elastic one accelerates by itself, a rigid one takes its part of the torque
        let mut motor_acceleration = acceleration;
        if let Some(drive) = &body.drive {
            let mount = drive.rotor.mount;
            let carrier = if mount == body.parent { parent } else { accel_at(mount, scratch) };
            if drive.elastic.is_some() {
                motor_acceleration = rotor_acceleration(&drive.rotor, F::load(s.on_rotor), carrier.ang);
            } else {
                let taken = rotor_torque(&drive.rotor, acceleration, carrier.ang);
                tau_j[i] = (F::load(tau_j[i]) - taken).store();
            }
        }
        thetadd[i] = motor_acceleration.store();
        if body.shared {
            scratch[i].a = a.map(F::store);
        }
        previous = a;
    }
}
