//! Inverse dynamics in one sweep out and one in: the recursive Newton–Euler algorithm (RBDA table 5.1) with rotors, in
//! classical accelerations.
//!
//! With the acceleration `a` of a body's origin as a point in space, Newton's and Euler's equations about that origin need
//! no linear velocity: `f = m a + Ω h`, `n = I α + ω × I ω + h × a`, where `h = m c` and `Ω = α× + ω× ω×` is the
//! angular acceleration tensor (Balafoutis & Patel 1991, §4.3).
//!
//! A rotor's absolute axial momentum is `h = J (N θ̇ + n·ω)`. Its carrier must supply the couple `ḣ n + ω × h n`, its motor
//! the reflected torque `N ḣ = B θ̈ + N J n·α` (PHYSICS §3). An elastic rotor's `J n nᵀ` is not part of the carrier's inertia,
//! so the whole of `h` counts; a rigid one's is, so only `N J q̇` counts for the carrier.
//!
//! Cost O(n). No allocation, no panic, no branch on values.

use super::drive_torque::transmission_error;
use super::tree::{Moving, RootMotion, Support, Tree, first, store_first, turns};
use super::{Acceleration, External, Inverse, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Drive, Model, SizeError};
use crate::spatial::{Force, Motion, Turn, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct RneaScratch<T> {
    /// Sine and cosine of the joint's angle.
    theta: Turn<T>,
    /// Force the body needs.
    f: Force<T>,
    /// Torque the rotor needs of its motor, reflected, besides what the transmission passes on.
    on_rotor: T,
    /// Motion, of a body that others than the next refer to.
    moving: Moving<T>,
}

impl<T: Scalar> RneaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self { theta: Turn::none(), f: Force::zero(), on_rotor: T::zero(), moving: Moving::at_rest() }
    }
}

impl<T: Scalar> Default for RneaScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Torques that make the robot, at the given state, accelerate as asked.
///
/// `tau_j` is what the transmission must exert on the joint: inertia, gravity and link-side friction, less the external loads.
/// `tau` is what the motor must: `(1 − e') τ_J` plus rotor inertia, gyroscopic coupling and motor-side friction, reflected.
/// The two differ only where a joint has a drive; for a floating root both are the wrench on it in its own frame.
/// `scratch` has one record per body.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn rnea<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    accel: Acceleration<T>,
    ext: External<T>,
    scratch: &mut [RneaScratch<T>],
    out: Inverse<T>,
) -> Result<(), SizeError> {
    check_state(model, &state)?;
    check_external(model, &ext)?;
    check_scratch(model, scratch)?;
    SizeError::check("qdd", accel.qdd.len(), model.nv)?;
    SizeError::check("thetadd", accel.thetadd.len(), model.nv)?;
    SizeError::check("tau_j", out.tau_j.len(), model.nv)?;
    SizeError::check("tau", out.tau.len(), model.nv)?;
    T::dispatch(Rnea { model, state, accel, ext, scratch, out });
    Ok(())
}

struct Rnea<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    state: State<'a, T>,
    accel: Acceleration<'a, T>,
    ext: External<'a, T>,
    scratch: &'a mut [RneaScratch<T>],
    out: Inverse<'a, T>,
}

impl<T: Scalar> Kernel<T> for Rnea<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<F: Over<T>>(self) {
        let Self { model, state, accel, ext, scratch, out } = self;
        let tree = Tree::of(model);
        let (joints, n) = (tree.joints, tree.joints.len());
        let (Some(q), Some(qd), Some(theta), Some(thetad), Some(qdd), Some(thetadd)) = (
            tree.positions(state.q),
            tree.velocities(state.qd),
            tree.velocities(state.theta),
            tree.velocities(state.thetad),
            tree.velocities(accel.qdd),
            tree.velocities(accel.thetadd),
        ) else {
            return;
        };
        let Some(scratch) = tree.bodies_mut(scratch) else { return };
        turns::<T, F, _>(joints, q, scratch, |s, theta| s.theta = theta);

        // The base: at rest, or the root with its own equation.
        let lift = -model.gravity.map(F::from_param);
        let mut base = Moving { accel: Motion { ang: Vec3::zero(), lin: lift }, ..Moving::at_rest() };
        let mut base_force = Force::zero();
        if let Some(root) = tree.root {
            let at = RootMotion::of(state.q, state.qd);
            // From the spatial to the classical acceleration: + ω × v
            let asked = Motion::from(first::<T, F, 6>(accel.qdd));
            let lin = at.v.ang.cross_plus(at.v.lin, asked.lin) + at.rot * lift;
            base = Moving::new(at.v.ang, Motion { ang: asked.ang, lin });
            base_force = base.force_on(root.inertia.map(F::from_param));
            if let Some(wrench) = ext.wrenches.first() {
                base_force -= root.frame.map(F::from_param).inv_force(wrench.map(F::load));
            }
        }

        // Pass 1, base to tips: motion, and the force each body needs.
        let mut previous = base;
        for i in 0..n {
            let body = &joints[i];
            let of = |b: Support, scratch: &[RneaScratch<T>]| match b {
                Support::Previous => previous,
                Support::Base => base,
                Support::Earlier(p) => scratch.get(p).map_or(base, |s| s.moving.map(F::load)),
            };
            let (q, qd, qdd) = (F::load(q[i]), F::load(qd[i]), F::load(qdd[i]));
            let parent = of(tree.support(body.parent, i), scratch);
            let x = body.across(scratch[i].theta.map(F::load), q);
            let moving = parent.across(&x, body.joint, qd, qdd);

            // f = m a + Ω h − f_ext,   n = I α + ω × I ω + h × a − n_ext
            let mut f = moving.force_on(body.inertia.map(F::from_param));
            if let Some(wrench) = tree.bodies(ext.wrenches).and_then(|w| w.get(i)) {
                f -= body.frame.map(F::from_param).inv_force(wrench.map(F::load));
            }
            scratch[i].f = f.map(F::store);

            // Rotor: N ḣ = B θ̈ + N J n·α for its motor, and the couple ḣ n + ω × h n on its carrier
            if let Some(Drive { rotor, elastic }) = &body.drive {
                let (thetad, thetadd) = match elastic {
                    Some(_) => (F::load(thetad[i]), F::load(thetadd[i])),
                    None => (qd, qdd),
                };
                let mut on_rotor =
                    F::from_param(rotor.reflected_inertia).mul_add(thetadd, rotor.reflected_friction(thetad));
                if rotor.mount.is_some() {
                    let at = tree.support(rotor.mount, i);
                    let Moving { omega, accel, .. } = of(at, scratch);
                    on_rotor = rotor.coupling::<F>().dot(accel.ang) + on_rotor;
                    let (h, h_dot) = match elastic {
                        Some(_) => (rotor.axial_momentum(thetad, omega), rotor.axial_momentum(thetadd, accel.ang)),
                        None => {
                            (rotor.axial_momentum(thetad, Vec3::zero()), rotor.axial_momentum(thetadd, Vec3::zero()))
                        }
                    };
                    let axis = rotor.axis_in::<F>();
                    let couple = omega.cross_plus(axis.scale(h), axis.scale(h_dot));
                    match at.joint(i).and_then(|b| scratch.get_mut(b)) {
                        Some(carrier) => carrier.f.ang = (carrier.f.ang.map(F::load) + couple).map(F::store),
                        None => base_force.ang += couple,
                    }
                }
                scratch[i].on_rotor = on_rotor.store();
            }
            if body.shared {
                scratch[i].moving = moving.map(F::store);
            }
            previous = moving;
        }

        // Pass 2, tips to base: forces across the joints.
        let (Some((root_tau_j, tau_j)), Some((root_tau, tau))) = (tree.split_mut(out.tau_j), tree.split_mut(out.tau))
        else {
            return;
        };
        let mut incoming = Force::zero();
        for i in (0..n).rev() {
            let body = &joints[i];
            let f = scratch[i].f.map(F::load) + incoming;

            // τ_J = Sᵀ f + f_l(q̇) − τ_ext,   τ = (1 − e') τ_J + N ḣ + N f_m
            let load = body.friction.torque(F::load(qd[i])) - tree.optional::<T, F>(ext.tau, i);
            let joint = body.along_joint(f) + load;
            tau_j[i] = joint.store();
            tau[i] = match &body.drive {
                None => joint.store(),
                Some(Drive { rotor, elastic }) => {
                    let on_motor = match elastic {
                        Some(elastic) => F::one() - transmission_error(elastic, rotor, F::load(theta[i])).1,
                        None => F::one(),
                    };
                    on_motor.mul_add(joint, F::load(scratch[i].on_rotor)).store()
                }
            };

            // f_p += Xᵀ f
            let support = tree.support(body.parent, i);
            if tree.root.is_none() && matches!(support, Support::Base) {
                incoming = Force::zero();
                continue;
            }
            let on_parent = body.across(scratch[i].theta.map(F::load), F::load(q[i])).inv_force(f);
            incoming = Force::zero();
            match support {
                Support::Previous => incoming = on_parent,
                Support::Base => base_force += on_parent,
                Support::Earlier(p) => {
                    if let Some(parent) = scratch.get_mut(p) {
                        parent.f = (parent.f.map(F::load) + on_parent).map(F::store);
                    }
                }
            }
        }

        if tree.root.is_some() {
            let wrench = base_force + incoming - Force::from(first::<T, F, 6>(ext.tau));
            store_first(root_tau_j, wrench.to_array());
            store_first(root_tau, wrench.to_array());
        }
    }
}
