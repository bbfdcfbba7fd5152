//! Forward dynamics: the articulated-body algorithm ([`aba`](crate::dynamics::aba)) with the modes of every link eliminated in place.

use super::modes::substitute;
use super::outward::Known;
use super::scratch::FlexibleScratch;
use crate::Scalar;
use crate::dynamics::drive_torque::{JointState, drives, rotor_acceleration, rotor_couple, rotor_torque};
use crate::dynamics::tree::RootMotion;
use crate::dynamics::{External, Forward, State};
use crate::model::{FlexibleModel, JointKind, SizeError};
use crate::spatial::{Force, Motion, Vec3};

/// Accelerations of all joints, motors and modes from state, motor torques and external loads.
///
/// Every vector is as [`FlexibleModel`] says, joints first, then modes; units of modal coordinates and forces are those of their shapes
/// (metres and newtons where a shape has no unit). What `tau` says of a mode is a generalised force on it, besides its own stiffness
/// and damping.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn flexible_aba<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    mut scratch: FlexibleScratch<T>,
    out: Forward<T>,
) -> Result<(), SizeError> {
    let known = Known::of(model, state, ext)?;
    scratch.check(model)?;
    let (nv, rigid) = (model.nv(), model.rigid.nv);
    SizeError::check("tau", tau.len(), nv)?;
    SizeError::check("qdd", out.qdd.len(), nv)?;
    SizeError::check("thetadd", out.thetadd.len(), nv)?;
    SizeError::check("tau_j", out.tau_j.len(), nv)?;
    let load = |k: usize| ext.tau.get(k).copied().unwrap_or(T::zero());
    let bodies = model.rigid.bodies;

    known.outward(&mut scratch);
    for (j, mode) in scratch.modes.iter_mut().enumerate() {
        mode.p -= tau[rigid + j] + load(rigid + j);
        out.tau_j[rigid + j] = tau[rigid + j];
    }

    // At each joint for itself: τ on its link side, τ − τ_J on its rotor, whose couple its carrier bears.
    for (i, body) in bodies.iter().enumerate() {
        if body.joint == JointKind::Floating {
            continue;
        }
        let v = body.v_index();
        let (theta, thetad) = (state.theta[v], state.thetad[v]);
        let at = JointState { q: known.q(body), qd: known.qd(body), theta, thetad };
        let acting = drives(body, at, tau[v], load(v), model.rigid.knots);
        (scratch.bodies[i].u, scratch.bodies[i].on_rotor) = (acting.on_link, acting.on_rotor);
        out.tau_j[v] = acting.tau_j;
        if let Some(drive) = &body.drive {
            let omega = known.of_carrier(i, &scratch, (|s| s.omega, |b| b.omega), Vec3::zero());
            let couple = rotor_couple(drive, drive.spin(at.qd, thetad), omega, acting.on_rotor);
            known.burden_carrier(i, &mut scratch, couple);
        }
    }

    for (i, body) in bodies.iter().enumerate().rev() {
        let (ia, p) = known.articulate(i, &mut scratch);
        let s = &mut scratch.bodies[i];
        (s.ia, s.p) = (ia, p);
        if body.joint == JointKind::Floating {
            continue;
        }
        // U = Iᴬ S,  d = Sᵀ U (+ B),  u' = τ − Sᵀ pᴬ − Uᵀ c
        s.u_cap = body.joint.column_of(&ia);
        s.d_inv = T::one() / (body.joint.along(s.u_cap) + body.rigid_reflected_inertia());
        s.u = s.u - body.joint.along(p) - s.c.dot(s.u_cap);

        // Iᵃ = Xᵀ Iᴬ X − W Wᵀ/d,   pᵃ = Xᵀ (Iᴬ c + pᴬ) + W u'/d,   W = Xᵀ U + [N J n; 0]: a rigidly geared rotor leans on the parent, too
        let x = known.across(i, s);
        let w = x.inv_force(s.u_cap) + body.rigid_coupling();
        let pa = x.inv_force(ia.force(s.c) + p).plus_scaled(s.u * s.d_inv, w);
        let ia = x.inv_articulated(ia).minus_outer(w, s.d_inv);
        known.hang(i, &mut scratch, ia, pa);
    }

    let lift = -model.rigid.gravity.map(T::from_param);
    let base = Motion { ang: Vec3::zero(), lin: lift };
    for (i, body) in bodies.iter().enumerate() {
        let v = body.v_index();
        if body.joint == JointKind::Floating {
            // a = Iᴬ⁻¹ (τ − pᴬ);   as spatial acceleration, without gravity: q̈ = a − [0; E a_0 + ω × v]
            let at = RootMotion::<T>::of(state.q, state.qd);
            let wrench = core::array::from_fn(|k| tau[v + k] + load(v + k));
            let s = &mut scratch.bodies[i];
            s.a = s.ia.solve(Force::from(wrench) - s.p);
            let free = Motion { ang: s.a.ang, lin: s.a.lin - at.rot * lift - at.v.ang.cross(at.v.lin) };
            for (k, value) in free.to_array().into_iter().enumerate() {
                (out.qdd[v + k], out.thetadd[v + k], out.tau_j[v + k]) = (value, value, tau[v + k]);
            }
        } else {
            // q̈ = (u' − Uᵀ X a_p − N J n·α_p)/d,   a = X a_p + c + S q̈
            let parent = known.of_parent(i, &scratch, (|s| s.a, |b| b.a), base);
            let carrier = known.of_carrier(i, &scratch, (|s| s.a, |b| b.a), base);
            let s = &mut scratch.bodies[i];
            let moved = known.across(i, s).motion(parent);
            let mut left = s.u - moved.dot(s.u_cap);
            if let Some(rotor) = body.rigid_rotor() {
                left -= rotor.coupling().dot(parent.ang);
            }
            let qdd = left * s.d_inv;
            s.a = body.joint.moved(moved + s.c, qdd);
            (out.qdd[v], out.thetadd[v]) = (qdd, qdd);

            // The rotor follows: an elastic one accelerates by itself, a rigid one takes its part of the torque
            match &body.drive {
                Some(drive) if drive.elastic.is_some() => {
                    out.thetadd[v] = rotor_acceleration(&drive.rotor, s.on_rotor, carrier.ang);
                }
                Some(drive) => out.tau_j[v] -= rotor_torque(&drive.rotor, qdd, carrier.ang),
                None => {}
            }
        }
        if let Some(link) = model.link_of(i) {
            let a = scratch.bodies[i].a;
            substitute(&mut scratch.modes[link.mode_range()], &scratch.matrix[link.pair_range()], a);
            known.accelerate_stations(i, &mut scratch);
        }
    }
    for (j, mode) in scratch.modes.iter().enumerate() {
        (out.qdd[rigid + j], out.thetadd[rigid + j]) = (mode.etadd, mode.etadd);
    }
    Ok(())
}
