//! Forward dynamics by the inertia matrix, for robots whose rigidly geared rotors sit on a body other than their joint's parent.
//!
//! Such a rotor couples its joint to bodies that are not its neighbours, so it cannot be eliminated link by link. `M_ij` still
//! vanishes unless one of the joints supports the other, because a carrier is an ancestor of its joint; so the
//! factorisation `M = Lᵀ L` fills in nothing (RBDA §6.5) and costs O(n·depth²).

use super::branches::{factorise, solve};
use super::drive_torque::{JointState, drives, rotor_acceleration, rotor_couple, rotor_torque};
use super::kinematics::{transform, velocity};
use super::{External, Forward, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::model::{JointKind, Model, SizeError};
use crate::spatial::{Force, Motion, SpatialInertia, Transform, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct JointSpaceScratch<T> {
    /// `X`: from the parent.
    x: Transform<T>,
    /// Velocity.
    v: Motion<T>,
    /// `c = v × S q̇`.
    pub(super) c: Motion<T>,
    /// Acceleration, gravity included.
    pub(super) a: Motion<T>,
    /// Force that the present velocity and gravity ask for.
    f: Force<T>,
    /// `Iᶜ`.
    composite: SpatialInertia<T>,
    /// Generalised force at the joint.
    u: T,
    /// Net reflected torque on the joint's elastic rotor.
    pub(super) on_rotor: T,
}

impl<T: Scalar> JointSpaceScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            x: Transform::identity(),
            v: Motion::zero(),
            c: Motion::zero(),
            a: Motion::zero(),
            f: Force::zero(),
            composite: SpatialInertia::zero(),
            u: T::zero(),
            on_rotor: T::zero(),
        }
    }
}

impl<T: Scalar> Default for JointSpaceScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// The same as [`super::aba`] for every robot, by another route: `M q̈ = τ − C q̇ − g` with elastic rotors eliminated.
/// `scratch` has one record per body, `matrix` `nv * nv` entries.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn forward_in_joint_space<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: &mut [JointSpaceScratch<T>],
    matrix: &mut [T],
    out: Forward<T>,
) -> Result<(), SizeError> {
    check_state(model, &state)?;
    check_external(model, &ext)?;
    check_scratch(model, scratch)?;
    out.check(model, tau)?;
    SizeError::check("matrix", matrix.len(), model.nv * model.nv)?;
    let Forward { qdd, thetadd, tau_j } = out;

    let a_world = Motion { ang: Vec3::zero(), lin: -model.gravity.map(T::from_param) };
    outward(model, &state, tau, &ext, a_world, scratch, tau_j);
    matrix_and_load(model, tau, &ext, scratch, matrix, qdd);
    factorise::<T, T>(model, matrix);
    solve::<T, T>(model, matrix, qdd, 1);

    accelerate(model, a_world, scratch, qdd, thetadd, tau_j);
    Ok(())
}

/// Base to tips: accelerations of the links, and of the rotors.
pub(super) fn accelerate<T: Scalar>(
    model: &Model<T::Param>,
    a_world: Motion<T>,
    scratch: &mut [JointSpaceScratch<T>],
    qdd: &[T],
    thetadd: &mut [T],
    tau_j: &mut [T],
) {
    for (i, body) in model.bodies.iter().enumerate() {
        let a_p = body.parent().map_or(a_world, |p| scratch[p].a);
        let k = body.v_index();
        let a_rest = scratch[i].x.motion(a_p) + scratch[i].c;
        if body.joint == JointKind::Floating {
            let free = [qdd[k], qdd[k + 1], qdd[k + 2], qdd[k + 3], qdd[k + 4], qdd[k + 5]];
            scratch[i].a = a_rest + Motion::from(free);
            thetadd[k..k + 6].copy_from_slice(&free);
            continue;
        }
        scratch[i].a = body.joint.moved(a_rest, qdd[k]);
        thetadd[k] = qdd[k];
        let Some(drive) = &body.drive else { continue };
        let alpha = drive.rotor.mount().map_or(Vec3::zero(), |m| scratch[m].a.ang);
        if drive.elastic.is_some() {
            thetadd[k] = rotor_acceleration(&drive.rotor, scratch[i].on_rotor, alpha);
        } else {
            tau_j[k] -= rotor_torque(&drive.rotor, qdd[k], alpha);
        }
    }
}

/// Base to tips: velocities, accelerations with `q̈ = 0`, and the forces that they ask for.
fn outward<T: Scalar>(
    model: &Model<T::Param>,
    state: &State<T>,
    tau: &[T],
    ext: &External<T>,
    a_world: Motion<T>,
    scratch: &mut [JointSpaceScratch<T>],
    tau_j: &mut [T],
) {
    for (i, body) in model.bodies.iter().enumerate() {
        let (v_p, a_p) = body.parent().map_or((Motion::zero(), a_world), |p| (scratch[p].v, scratch[p].a));
        let x = transform(body, state.q);
        let v = velocity(body, v_p, state.q, state.qd);
        // c = v × S q̇,   a = X a_p + c,   f = I a + v ×* I v − f_ext
        let c = v.cross(v - x.motion(v_p));
        let a = x.motion(a_p) + c;
        let inertia: SpatialInertia<T> = body.inertia.map(T::from_param);
        let mut f = inertia.momentum(a) + v.cross_force(inertia.momentum(v));
        if let Some(wrench) = ext.wrenches.get(i) {
            f -= body.frame.map(T::from_param).inv_force(*wrench);
        }
        let zero = T::zero();
        scratch[i] = JointSpaceScratch { x, v, c, a, f, composite: inertia, u: zero, on_rotor: zero };
        let k = body.v_index();
        if body.joint == JointKind::Floating {
            tau_j[k..k + 6].copy_from_slice(&tau[k..k + 6]);
            continue;
        }
        let at =
            JointState { q: state.q[body.q_index()], qd: state.qd[k], theta: state.theta[k], thetad: state.thetad[k] };
        let known = drives(body, at, tau[k], ext.tau.get(k).copied().unwrap_or(zero), model.knots);
        (scratch[i].u, scratch[i].on_rotor, tau_j[k]) = (known.on_link, known.on_rotor, known.tau_j);

        // The rotor's couple on its carrier
        if let Some(drive) = &body.drive
            && let Some(m) = drive.rotor.mount()
        {
            let couple = rotor_couple(drive, drive.spin(at.qd, at.thetad), scratch[m].v.ang, known.on_rotor);
            scratch[m].f.ang += couple;
        }
    }
}

/// Tips to base: the inertia matrix by composite inertias, and what is left of the forces to accelerate the joints.
fn matrix_and_load<T: Scalar>(
    model: &Model<T::Param>,
    tau: &[T],
    ext: &External<T>,
    scratch: &mut [JointSpaceScratch<T>],
    matrix: &mut [T],
    load: &mut [T],
) {
    let nv = model.nv;
    matrix.fill(T::zero());
    for (i, body) in model.bodies.iter().enumerate().rev() {
        let (s, k) = (scratch[i], body.v_index());
        if let Some(p) = body.parent() {
            scratch[p].f += s.x.inv_force(s.f);
            scratch[p].composite = scratch[p].composite + s.composite.seen_from_parent(s.x);
        }
        let external = |k: usize| ext.tau.get(k).copied().unwrap_or(T::zero());
        for c in 0..body.joint.nv() {
            let mut unit = [T::zero(); 6];
            let entry = match body.joint {
                JointKind::Revolute => 2,
                JointKind::Prismatic => 5,
                JointKind::Floating => c,
            };
            unit[entry] = T::one();
            let mut f = s.composite.momentum(Motion::from(unit));
            let mut at = i;
            loop {
                let on = &model.bodies[at];
                for row in 0..on.joint.nv() {
                    let force = if on.joint == JointKind::Floating { f.to_array()[row] } else { on.joint.along(f) };
                    matrix[(on.v_index() + row) * nv + k + c] = force;
                    matrix[(k + c) * nv + on.v_index() + row] = force;
                }
                let Some(p) = on.parent() else { break };
                f = scratch[at].x.inv_force(f);
                if body.carrier() == on.parent {
                    f += body.rigid_coupling();
                }
                at = p;
            }
            if body.joint == JointKind::Floating {
                load[k + c] = tau[k + c] + external(k + c) - s.f.to_array()[c];
            }
        }
        if body.joint != JointKind::Floating {
            // A rigid rotor's own row: B on the diagonal, and N J n·α, α what its carrier's velocity alone makes of it.
            matrix[k * nv + k] += body.rigid_reflected_inertia();
            let at_carrier = body.carrier().map_or(Vec3::zero(), |m| scratch[usize::from(m)].a.ang);
            load[k] = s.u - body.joint.along(s.f) - body.rigid_coupling().ang.dot(at_carrier);
        }
    }
}
