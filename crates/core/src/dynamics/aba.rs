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

use super::drive_torque::{JointState, drives};
use super::tree::{RootMotion, Support, Tree, first, store_first, turns};
use super::{External, Forward, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Drive, JointKind, Model, SizeError};
use crate::spatial::{ArticulatedInertia, Force, Motion, SpatialInertia, Turn, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct AbaScratch<T> {
    /// Sine and cosine of the joint's angle.
    theta: Turn<T>,
    /// `ω`.
    omega: Vec3<T>,
    /// `c`: acceleration due to velocities alone.
    c: Motion<T>,
    /// `pᴬ`.
    p: Force<T>,
    /// `U = Iᴬ S`.
    u_cap: Force<T>,
    /// `1 / d`, `d` the joint's apparent inertia.
    d_inv: T,
    /// Generalised force at the joint that is left to accelerate it.
    u: T,
    /// Net reflected torque on the joint's elastic rotor.
    on_rotor: T,
    /// `Iᴬ` so far, of a body that others than the next hang on.
    ia: ArticulatedInertia<T>,
    /// Acceleration, gravity included, of a body that others than the next refer to.
    a: Motion<T>,
}

impl<T: Scalar> AbaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            theta: Turn::none(),
            omega: Vec3::zero(),
            c: Motion::zero(),
            p: Force::zero(),
            u_cap: Force::zero(),
            d_inv: T::zero(),
            u: T::zero(),
            on_rotor: T::zero(),
            ia: ArticulatedInertia::zero(),
            a: Motion::zero(),
        }
    }
}

impl<T: Scalar> Default for AbaScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

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
    check_state(model, &state)?;
    check_external(model, &ext)?;
    check_scratch(model, scratch)?;
    out.check(model, tau)?;
    T::dispatch(Aba { model, state, tau, ext, scratch, out });
    Ok(())
}

struct Aba<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    state: State<'a, T>,
    tau: &'a [T],
    ext: External<'a, T>,
    scratch: &'a mut [AbaScratch<T>],
    out: Forward<'a, T>,
}

impl<T: Scalar> Kernel<T> for Aba<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<F: Over<T>>(self) {
        let Self { model, state, tau, ext, scratch, out } = self;
        let tree = Tree::of(model);
        let (joints, n) = (tree.joints, tree.joints.len());
        let (Some(q), Some(qd), Some(theta), Some(thetad)) = (
            tree.positions(state.q),
            tree.velocities(state.qd),
            tree.velocities(state.theta),
            tree.velocities(state.thetad),
        ) else {
            return;
        };
        let Some(scratch) = tree.bodies_mut(scratch) else { return };
        let (Some(motor), Some((root_qdd, qdd)), Some((root_thetadd, thetadd)), Some((root_tau_j, tau_j))) =
            (tree.velocities(tau), tree.split_mut(out.qdd), tree.split_mut(out.thetadd), tree.split_mut(out.tau_j))
        else {
            return;
        };
        turns::<T, F, _>(joints, q, scratch, |s, theta| s.theta = theta);

        // The base: at rest, or a root moving freely.
        let lift = -model.gravity.map(F::from_param);
        let (mut base_omega, mut base_p) = (Vec3::zero(), Force::zero());
        let free = tree.root.map(|root| (root, RootMotion::<F>::of(state.q, state.qd)));
        if let Some((root, at)) = &free {
            base_omega = at.v.ang;
            base_p = velocity_force(root.inertia.map(F::from_param), base_omega);
            if let Some(wrench) = ext.wrenches.first() {
                base_p -= root.frame.map(F::from_param).inv_force(wrench.map(F::load));
            }
        }

        // Pass 1, base to tips: velocities, and forces that are known from the state.
        let mut previous = base_omega;
        for i in 0..n {
            let body = &joints[i];
            let omega_of = |b: Support, scratch: &[AbaScratch<T>]| match b {
                Support::Previous => previous,
                Support::Base => base_omega,
                Support::Earlier(p) => scratch.get(p).map_or(base_omega, |s| s.omega.map(F::load)),
            };
            let at = JointState {
                q: F::load(q[i]),
                qd: F::load(qd[i]),
                theta: F::load(theta[i]),
                thetad: F::load(thetad[i]),
            };
            let x = body.across(scratch[i].theta.map(F::load), at.q);

            // ω = E ω_p + z q̇,   c = [ω × z q̇; E (ω_p × (ω_p × r))]
            let omega_p = x.turned(omega_of(tree.support(body.parent, i), scratch));
            let mut omega = x.rotate(omega_p);
            let mut c = Motion { ang: Vec3::zero(), lin: x.rotate(centripetal(omega_p, x.offset)) };
            let across = Vec3::new(omega.y * at.qd, -(omega.x * at.qd), F::zero());
            match body.joint {
                JointKind::Prismatic => c.lin += across + across,
                _ => {
                    c.ang = across;
                    omega.z += at.qd;
                }
            }

            // pᴬ = [ω × I ω; ω × (ω × h)] − f_ext
            let mut p = velocity_force(body.inertia.map(F::from_param), omega);
            if let Some(wrench) = tree.bodies(ext.wrenches).and_then(|w| w.get(i)) {
                p -= body.frame.map(F::from_param).inv_force(wrench.map(F::load));
            }

            // τ on the link side of the joint, τ − τ_J on its rotor
            let known = drives(body, at, F::load(motor[i]), tree.optional::<T, F>(ext.tau, i), model.knots);

            // The rotor's couple on its carrier: elastic ω × h n + (τ − τ_J)/N n, rigid ω × N J q̇ n
            if let Some(Drive { rotor, elastic }) = &body.drive
                && rotor.mount.is_some()
            {
                let carrier = tree.support(rotor.mount, i);
                let omega_m = omega_of(carrier, scratch);
                let (h, h_dot) = match elastic {
                    Some(_) => {
                        (rotor.axial_momentum(at.thetad, omega_m), known.on_rotor * F::from_param(rotor.inv_gear_ratio))
                    }
                    None => (rotor.axial_momentum(at.qd, Vec3::zero()), F::zero()),
                };
                let axis = rotor.axis_in::<F>();
                let couple = omega_m.cross_plus(axis.scale(h), axis.scale(h_dot));
                match carrier.joint(i).and_then(|b| scratch.get_mut(b)) {
                    Some(carrier) => carrier.p.ang = (carrier.p.ang.map(F::load) + couple).map(F::store),
                    None => base_p.ang += couple,
                }
            }

            let s = &mut scratch[i];
            s.omega = omega.map(F::store);
            s.c = c.map(F::store);
            s.p = p.map(F::store);
            s.u = known.on_link.store();
            s.on_rotor = known.on_rotor.store();
            if body.shared {
                s.ia = ArticulatedInertia::zero();
            }
            tau_j[i] = known.tau_j.store();
            previous = omega;
        }

        // Pass 2, tips to base: articulated inertias.
        let (mut incoming, mut base_ia) = ((ArticulatedInertia::zero(), Force::zero()), ArticulatedInertia::zero());
        for i in (0..n).rev() {
            let (body, s) = (&joints[i], &mut scratch[i]);
            let mut ia = incoming.0.plus_rigid(body.inertia.map(F::from_param));
            if body.shared {
                ia += s.ia.map(F::load);
            }
            let (p, c) = (s.p.map(F::load) + incoming.1, s.c.map(F::load));

            // U = Iᴬ S,  d = Sᵀ U (+ B),  u = τ − Sᵀ pᴬ,  u' = u − Uᵀ c
            let u_cap = body.column_of(&ia);
            let rigid = body.rigid_rotor();
            let d_inv = F::one() / (body.along_joint(u_cap) + body.rigid_reflected_inertia());
            let u = F::load(s.u) - body.along_joint(p);
            let left = u - c.dot(u_cap);
            s.u_cap = u_cap.map(F::store);
            s.d_inv = d_inv.store();
            s.u = left.store();

            // Iᵃ = Iᴬ − U Uᵀ/d,   pᵃ = pᴬ + Iᵃ c + U u/d;   Iᴬ_p += Xᵀ Iᵃ X,   pᴬ_p += Xᵀ pᵃ
            let support = tree.support(body.parent, i);
            incoming = (ArticulatedInertia::zero(), Force::zero());
            if free.is_none() && matches!(support, Support::Base) {
                continue;
            }
            let x = body.across(s.theta.map(F::load), F::load(q[i]));
            let on_parent = if rigid.is_none() && body.joint == JointKind::Revolute {
                let released = ia.released_about_z(d_inv);
                let pa = (p + released.force([c.ang.x, c.ang.y], c.lin)).plus_scaled(u * d_inv, u_cap);
                (released.seen_from_parent(&x), x.inv_force(pa))
            } else {
                // With W = Xᵀ U + [N J n; 0] for Xᵀ U: the rotor leans on the parent, too.
                let w = x.inv_force(u_cap) + body.rigid_coupling();
                let pa = x.inv_force(ia.force(c) + p).plus_scaled(left * d_inv, w);
                (x.inv_articulated(ia).minus_outer(w, d_inv), pa)
            };
            match support {
                Support::Previous => incoming = on_parent,
                Support::Base => (base_ia, base_p) = (base_ia + on_parent.0, base_p + on_parent.1),
                Support::Earlier(b) => {
                    if let Some(parent) = scratch.get_mut(b) {
                        parent.ia = (parent.ia.map(F::load) + on_parent.0).map(F::store);
                        parent.p = (parent.p.map(F::load) + on_parent.1).map(F::store);
                    }
                }
            }
        }

        // Pass 3, base to tips: accelerations.
        let mut base_a = Motion { ang: Vec3::zero(), lin: lift };
        if let Some((root, at)) = &free {
            // a = Iᴬ⁻¹ (τ − pᴬ);   as spatial acceleration, without gravity: q̈ = a − [0; E a_0 + ω × v]
            let ia = (base_ia + incoming.0).plus_rigid(root.inertia.map(F::from_param));
            let motor = Force::from(first::<T, F, 6>(tau));
            base_a = ia.solve(motor + Force::from(first::<T, F, 6>(ext.tau)) - (base_p + incoming.1));
            let free = Motion { ang: base_a.ang, lin: base_a.lin - at.rot * lift - at.v.ang.cross(at.v.lin) };
            store_first(root_qdd, free.to_array());
            store_first(root_thetadd, free.to_array());
            store_first(root_tau_j, motor.to_array());
        }
        let mut previous = base_a;
        for i in 0..n {
            let (body, s) = (&joints[i], &scratch[i]);
            let accel_of = |b: Support| match b {
                Support::Previous => previous,
                Support::Base => base_a,
                Support::Earlier(p) => scratch.get(p).map_or(base_a, |s| s.a.map(F::load)),
            };
            let x = body.across(s.theta.map(F::load), F::load(q[i]));
            let a_p = accel_of(tree.support(body.parent, i));

            // q̈ = (u' − Uᵀ X a_p − N J n·α_p)/d,   a = X a_p + c + S q̈
            let moved = x.motion(a_p);
            let (d_inv, u) = (F::load(s.d_inv), F::load(s.u));
            let mut left = u - moved.dot(s.u_cap.map(F::load));
            if let Some(rotor) = body.rigid_rotor() {
                left -= rotor.coupling().dot(a_p.ang);
            }
            let acceleration = left * d_inv;
            let a = body.moved_along_joint(moved + s.c.map(F::load), acceleration);
            qdd[i] = acceleration.store();

            // Elastic rotors θ̈ = (τ − τ_J)/B − (n·α)/N, rigid ones τ_J = τ − B q̈ − N J n·α
            thetadd[i] = acceleration.store();
            if let Some(Drive { rotor, elastic }) = &body.drive {
                let alpha = rotor.mount.map_or(Vec3::zero(), |_| accel_of(tree.support(rotor.mount, i)).ang);
                let n_alpha = rotor.axis_in().dot(alpha);
                match elastic {
                    Some(_) => {
                        let own = F::load(s.on_rotor) * F::from_param(rotor.inv_reflected_inertia);
                        thetadd[i] = (own - n_alpha * F::from_param(rotor.inv_gear_ratio)).store();
                    }
                    None => {
                        let nj = F::from_param(rotor.gear_ratio) * F::from_param(rotor.inertia);
                        let taken = F::from_param(rotor.reflected_inertia) * acceleration + nj * n_alpha;
                        tau_j[i] = (F::load(tau_j[i]) - taken).store();
                    }
                }
            }
            if body.shared {
                scratch[i].a = a.map(F::store);
            }
            previous = a;
        }
    }
}

/// `ω × (ω × r)`.
#[inline(always)]
fn centripetal<T: Scalar>(omega: Vec3<T>, r: Vec3<T>) -> Vec3<T> {
    omega.scale(omega.dot(r)).plus_scaled(-omega.dot(omega), r)
}

/// Force that a body needs for its angular velocity alone: `[ω × I ω; ω × (ω × h)]`.
#[inline(always)]
fn velocity_force<T: Scalar>(body: SpatialInertia<T>, omega: Vec3<T>) -> Force<T> {
    Force { ang: omega.cross(body.rotational * omega), lin: centripetal(omega, body.first_moment) }
}
