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
//! Cost O(n). No allocation, no panic, no branch on values.

use super::drive_torque::drives;
use super::{External, Forward, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::model::{JointKind, Model, SizeError};
use crate::spatial::{ArticulatedInertia, Force, Motion, Transform, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct AbaScratch<T> {
    /// `X`: from the parent.
    pub(super) x: Transform<T>,
    /// Velocity.
    pub(super) v: Motion<T>,
    /// `c = v × S q̇`: acceleration due to the joint's velocity.
    pub(super) c: Motion<T>,
    /// `Iᴬ`.
    pub(super) ia: ArticulatedInertia<T>,
    /// `pᴬ`.
    pub(super) pa: Force<T>,
    /// `W`, in the parent's frame: force on the parent per unit acceleration of the joint.
    pub(super) w: Force<T>,
    /// `1 / d`, `d` the joint's apparent inertia.
    pub(super) d_inv: T,
    /// `u`: force at the joint that is left to accelerate it.
    pub(super) u: T,
    /// Net reflected torque on the joint's elastic rotor.
    pub(super) on_rotor: T,
    /// Acceleration, gravity included.
    pub(super) a: Motion<T>,
}

impl<T: Scalar> AbaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            x: Transform::identity(),
            v: Motion::zero(),
            c: Motion::zero(),
            ia: ArticulatedInertia::zero(),
            pa: Force::zero(),
            w: Force::zero(),
            d_inv: T::zero(),
            u: T::zero(),
            on_rotor: T::zero(),
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
    model: &Model<T>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: &mut [AbaScratch<T>],
    out: Forward<T>,
) -> Result<(), SizeError> {
    check(model, &state, tau, &ext, scratch, &out)?;
    let Forward { qdd, thetadd, tau_j } = out;

    outward_velocities(model, &state, tau, &ext, scratch, tau_j);

    // Pass 2, tips to base: articulated inertias.
    for (i, body) in model.bodies.iter().enumerate().rev() {
        if body.joint == JointKind::Floating {
            continue; // Solved as a whole in pass 3.
        }
        let s = scratch[i];

        // U = Iᴬ S,  d = Sᵀ U (+ B),  u = τ − Sᵀ pᴬ − Uᵀ c
        let u_cap = body.column_of(&s.ia);
        let d = body.along_joint(u_cap) + body.rigid_reflected_inertia();
        let d_inv = T::one() / d;
        let u = s.u - body.along_joint(s.pa) - s.c.dot(u_cap);

        // W = Xᵀ U + [N J n; 0]
        let w = s.x.inv_force(u_cap) + body.rigid_coupling();
        scratch[i].w = w;
        scratch[i].d_inv = d_inv;
        scratch[i].u = u;

        // Iᴬ_p += Xᵀ Iᴬ X − W Wᵀ/d,   pᴬ_p += Xᵀ (Iᴬ c + pᴬ) + W u/d
        if let Some(p) = body.parent() {
            let ia = s.ia.seen_from_parent(&s.x).minus_outer(w, d_inv);
            let pa = s.x.inv_force(s.ia.force(s.c) + s.pa) + w.scale(u * d_inv);
            scratch[p].ia += ia;
            scratch[p].pa += pa;
        }
    }

    // Pass 3, base to tips: accelerations.
    let a_world = Motion { ang: Vec3::zero(), lin: -model.gravity };
    for (i, body) in model.bodies.iter().enumerate() {
        let a_p = body.parent().map_or(a_world, |p| scratch[p].a);
        let s = &mut scratch[i];
        let a_rest = s.x.motion(a_p) + s.c;
        let k = body.v_index();
        if body.joint == JointKind::Floating {
            // q̈ = Iᴬ⁻¹ (τ − pᴬ) − X a_0
            let load = root_wrench(tau, &ext, k);
            s.a = s.ia.solve(load - s.pa);
            let free = s.a - a_rest;
            qdd[k..k + 6].copy_from_slice(&free.to_array());
            thetadd[k..k + 6].copy_from_slice(&free.to_array());
            continue;
        }
        // q̈ = (u − Wᵀ a_p)/d,   a = X a_p + c + S q̈
        let acceleration = (s.u - a_p.dot(s.w)) * s.d_inv;
        s.a = body.moved_along_joint(a_rest, acceleration);
        qdd[k] = acceleration;
    }

    rotor_accelerations(model, scratch, qdd, thetadd, tau_j);
    Ok(())
}

pub(super) fn check<T: Scalar>(
    model: &Model<T>,
    state: &State<T>,
    tau: &[T],
    ext: &External<T>,
    scratch: &[AbaScratch<T>],
    out: &Forward<T>,
) -> Result<(), SizeError> {
    check_state(model, state)?;
    check_external(model, ext)?;
    check_scratch(model, scratch)?;
    SizeError::check("tau", tau.len(), model.nv)?;
    SizeError::check("qdd", out.qdd.len(), model.nv)?;
    SizeError::check("thetadd", out.thetadd.len(), model.nv)?;
    SizeError::check("tau_j", out.tau_j.len(), model.nv)
}

/// Pass 1, base to tips: velocities, inertias and forces that are known from the state.
pub(super) fn outward_velocities<T: Scalar>(
    model: &Model<T>,
    state: &State<T>,
    tau: &[T],
    ext: &External<T>,
    scratch: &mut [AbaScratch<T>],
    tau_j: &mut [T],
) {
    for (i, body) in model.bodies.iter().enumerate() {
        // v = X v_p + S q̇,   c = v × S q̇
        let x = body.transform(state.q);
        let v_joint = body.joint_velocity(state.qd);
        let v = match body.parent() {
            Some(p) => x.motion(scratch[p].v) + v_joint,
            None => v_joint,
        };
        let c = v.cross(v_joint);

        // Iᴬ = I,   pᴬ = v ×* I v − f_ext
        let mut pa = v.cross_force(body.inertia.momentum(v));
        if let Some(wrench) = ext.wrenches.get(i) {
            pa -= body.frame.inv_force(*wrench);
        }
        let k = body.v_index();
        let s = &mut scratch[i];
        (s.x, s.v, s.c, s.ia, s.pa) = (x, v, c, body.inertia.into(), pa);
        if body.joint == JointKind::Floating {
            tau_j[k..k + 6].copy_from_slice(&tau[k..k + 6]);
            continue;
        }

        // τ on the link side of the joint, τ − τ_J on its rotor
        let known = drives(body, state, tau[k], ext.tau.get(k).copied().unwrap_or(T::zero()), model.knots);
        s.u = known.on_link;
        s.on_rotor = known.on_rotor;
        tau_j[k] = known.tau_j;

        // The rotor's couple on its carrier: elastic ω × h n + (τ − τ_J)/N n, rigid ω × N J q̇ n
        if let Some(drive) = &body.drive
            && let Some(m) = drive.rotor.mount()
        {
            let (rotor, omega) = (&drive.rotor, scratch[m].v.ang);
            let (h, h_dot) = match drive.elastic {
                Some(_) => (rotor.axial_momentum(state.thetad[k], omega), known.on_rotor * rotor.inv_gear_ratio),
                None => (rotor.gear_ratio * rotor.inertia * state.qd[k], T::zero()),
            };
            scratch[m].pa.ang += omega.cross(rotor.axis.scale(h)) + rotor.axis.scale(h_dot);
        }
    }
}

/// Last, once all links' accelerations are known: elastic rotors `θ̈ = (τ − τ_J)/B − (n·α)/N`, rigid ones
/// `τ_J = τ − B q̈ − N J n·α`.
pub(super) fn rotor_accelerations<T: Scalar>(
    model: &Model<T>,
    scratch: &[AbaScratch<T>],
    qdd: &[T],
    thetadd: &mut [T],
    tau_j: &mut [T],
) {
    for (i, body) in model.bodies.iter().enumerate() {
        let k = body.v_index();
        if body.joint == JointKind::Floating {
            continue;
        }
        thetadd[k] = qdd[k];
        let Some(drive) = &body.drive else { continue };
        let rotor = &drive.rotor;
        let n_alpha = rotor.mount().map_or(T::zero(), |m| rotor.axis.dot(scratch[m].a.ang));
        match drive.elastic {
            Some(_) => {
                thetadd[k] = scratch[i].on_rotor * rotor.inv_reflected_inertia - n_alpha * rotor.inv_gear_ratio;
            }
            None => {
                tau_j[k] -= rotor.reflected_inertia * qdd[k] + rotor.gear_ratio * rotor.inertia * n_alpha;
            }
        }
    }
}

/// Motor and external wrench on a floating root.
#[inline]
pub(super) fn root_wrench<T: Scalar>(tau: &[T], ext: &External<T>, k: usize) -> Force<T> {
    let six = |s: &[T]| Force::from([s[k], s[k + 1], s[k + 2], s[k + 3], s[k + 4], s[k + 5]]);
    if ext.tau.is_empty() { six(tau) } else { six(tau) + six(ext.tau) }
}
