//! Inverse dynamics in one sweep out and one in: the recursive Newton–Euler algorithm (RBDA table 5.1) with rotors.
//!
//! A rotor's absolute axial momentum is `h = J (N θ̇ + n·ω)`. Its carrier must supply the couple `ḣ n + ω × h n`, its motor
//! the reflected torque `N ḣ = B θ̈ + N J n·α` (PHYSICS §3). An elastic rotor's `J n nᵀ` is not part of the carrier's inertia,
//! so the whole of `h` counts; a rigid one's is, so only `N J q̇` counts for the carrier.
//!
//! Cost O(n). No allocation, no panic, no branch on values.

use super::drive_torque::transmission_error;
use super::{Acceleration, External, Inverse, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::model::{JointKind, Model, SizeError};
use crate::spatial::{Force, Motion, Transform, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct RneaScratch<T> {
    x: Transform<T>,
    v: Motion<T>,
    a: Motion<T>,
    f: Force<T>,
}

impl<T: Scalar> RneaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self { x: Transform::identity(), v: Motion::zero(), a: Motion::zero(), f: Force::zero() }
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
    model: &Model<T>,
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
    let Inverse { tau_j, tau } = out;

    // Pass 1, base to tips: velocities, accelerations, and the force each body needs.
    let a_world = Motion { ang: Vec3::zero(), lin: -model.gravity };
    for (i, body) in model.bodies.iter().enumerate() {
        // v = X v_p + S q̇,   a = X a_p + S q̈ + v × S q̇
        let x = body.transform(state.q);
        let v_joint = body.joint_velocity(state.qd);
        let (v_p, a_p) = body.parent().map_or((Motion::zero(), a_world), |p| (scratch[p].v, scratch[p].a));
        let v = x.motion(v_p) + v_joint;
        let a = x.motion(a_p) + body.joint_velocity(accel.qdd) + v.cross(v_joint);

        // f = I a + v ×* I v − f_ext
        let mut f = body.inertia.momentum(a) + v.cross_force(body.inertia.momentum(v));
        if let Some(wrench) = ext.wrenches.get(i) {
            f -= body.frame.inv_force(*wrench);
        }
        scratch[i] = RneaScratch { x, v, a, f };

        // Rotor: N ḣ = B θ̈ + N J n·α for its motor, and the couple ḣ n + ω × h n on its carrier
        let k = body.v_index();
        let Some(drive) = &body.drive else { continue };
        let (rotor, nj) = (&drive.rotor, drive.rotor.gear_ratio * drive.rotor.inertia);
        let (omega, alpha) =
            rotor.mount().map_or((Vec3::zero(), Vec3::zero()), |m| (scratch[m].v.ang, scratch[m].a.ang));
        let (thetad, thetadd) = match drive.elastic {
            Some(_) => (state.thetad[k], accel.thetadd[k]),
            None => (state.qd[k], accel.qdd[k]),
        };
        tau[k] = rotor.reflected_inertia * thetadd + nj * rotor.axis.dot(alpha) + rotor.reflected_friction(thetad);
        if let Some(m) = rotor.mount() {
            let (h, h_dot) = match drive.elastic {
                Some(_) => (rotor.axial_momentum(thetad, omega), rotor.axial_momentum(thetadd, alpha)),
                None => (nj * thetad, nj * thetadd),
            };
            scratch[m].f.ang += omega.cross(rotor.axis.scale(h)) + rotor.axis.scale(h_dot);
        }
    }

    // Pass 2, tips to base: forces across the joints.
    for (i, body) in model.bodies.iter().enumerate().rev() {
        let (f, k) = (scratch[i].f, body.v_index());
        if body.joint == JointKind::Floating {
            let mut wrench = f;
            if let Some(e) = ext.tau.get(k..k + 6) {
                wrench -= Force::from([e[0], e[1], e[2], e[3], e[4], e[5]]);
            }
            tau_j[k..k + 6].copy_from_slice(&wrench.to_array());
            tau[k..k + 6].copy_from_slice(&wrench.to_array());
            continue;
        }
        // τ_J = Sᵀ f + f_l(q̇) − τ_ext,   τ = (1 − e') τ_J + N ḣ + N f_m
        let external = ext.tau.get(k).copied().unwrap_or(T::zero());
        tau_j[k] = body.along_joint(f) + body.friction.torque(state.qd[k]) - external;
        tau[k] = match &body.drive {
            None => tau_j[k],
            Some(drive) => {
                let slope = match &drive.elastic {
                    Some(elastic) => transmission_error(elastic, &drive.rotor, state.theta[k]).1,
                    None => T::zero(),
                };
                (T::one() - slope) * tau_j[k] + tau[k]
            }
        };
        // f_p += Xᵀ f
        if let Some(p) = body.parent() {
            scratch[p].f += scratch[i].x.inv_force(f);
        }
    }
    Ok(())
}
