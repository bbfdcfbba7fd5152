//! Energies and powers, so that `d(kinetic + gravity + elastic)/dt = supplied − dissipated`.

use super::drive_torque::{JointState, transmitted};
use super::kinematics::{transform, velocity};
use super::{External, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::model::{Body, JointKind, Model, SizeError};
use crate::spatial::{Motion, SpatialInertia, Transform};

/// Energies of a robot [J].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy<T> {
    /// Of links and rotors.
    pub kinetic: T,
    /// Of moving links and rotors in the field of gravity, zero for a mass at the world's origin.
    pub gravity: T,
    /// In the springs of the transmissions, zero where they are unloaded.
    pub elastic: T,
}

/// Powers of a robot [W].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Power<T> {
    /// Put in by motors and external loads.
    pub supplied: T,
    /// Lost in the friction of both sides and the damping of the transmissions, ≥ 0.
    pub dissipated: T,
}

/// Kinetic, gravity and elastic energy. `scratch` has one record per body: pose and velocity in the recursion's frames.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model.
pub fn energy<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    scratch: &mut [(Transform<T>, Motion<T>)],
) -> Result<Energy<T>, SizeError> {
    check_state(model, &state)?;
    check_scratch(model, scratch)?;
    move_bodies(model, &state, scratch);
    let half = T::from_f64(0.5);
    let mut e = Energy { kinetic: T::zero(), gravity: T::zero(), elastic: T::zero() };
    for (i, body) in model.bodies.iter().enumerate() {
        // T = ½ vᵀ I v,   V = −m g·c
        let (x, v) = scratch[i];
        let inertia: SpatialInertia<T> = body.inertia.map(T::from_param);
        e.kinetic += half * v.dot(inertia.momentum(v));
        let moment = x.rot.transpose_mul(inertia.first_moment) + x.pos.scale(inertia.mass);
        e.gravity -= model.gravity.map(T::from_param).dot(moment);

        // Rotors: elastic ½ h²/J, since the carrier's inertia lacks J n nᵀ; rigid ½ B q̇² + N J q̇ n·ω on top of it.
        let Some(drive) = &body.drive else { continue };
        let k = body.v_index();
        let rotor = &drive.rotor;
        let axial = rotor.mount().map_or(T::zero(), |m| rotor.axis_in().dot(scratch[m].1.ang));
        let (n, j) = (T::from_param(rotor.gear_ratio), T::from_param(rotor.inertia));
        match &drive.elastic {
            Some(elastic) => {
                let spin = n * state.thetad[k] + axial;
                e.kinetic += half * j * spin * spin;
                let t = transmitted(elastic, rotor, joint_state(&state, body), model.knots);
                e.elastic += elastic.spring.energy(t.deflection, model.knots);
            }
            None => {
                let spin = n * state.qd[k];
                e.kinetic += j * spin * (half * spin + axial);
            }
        }
    }
    Ok(e)
}

/// Power supplied by motor torques `tau` and external loads, and dissipated by friction and damping.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model.
pub fn power<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: &mut [(Transform<T>, Motion<T>)],
) -> Result<Power<T>, SizeError> {
    check_state(model, &state)?;
    check_external(model, &ext)?;
    check_scratch(model, scratch)?;
    SizeError::check("tau", tau.len(), model.nv)?;
    move_bodies(model, &state, scratch);
    let mut p = Power { supplied: T::zero(), dissipated: T::zero() };
    for (i, body) in model.bodies.iter().enumerate() {
        if let Some(wrench) = ext.wrenches.get(i) {
            p.supplied += scratch[i].1.dot(body.frame.map(T::from_param).inv_force(*wrench));
        }
        let start = body.v_index();
        for k in start..start + body.joint.nv() {
            p.supplied += ext.tau.get(k).copied().unwrap_or(T::zero()) * state.qd[k];
        }
        if body.joint == JointKind::Floating {
            for k in start..start + 6 {
                p.supplied += tau[k] * state.qd[k];
            }
            continue;
        }
        p.dissipated += body.friction.torque(state.qd[start]) * state.qd[start];
        let mut motor_velocity = state.qd[start];
        if let Some(drive) = &body.drive {
            if let Some(elastic) = &drive.elastic {
                motor_velocity = state.thetad[start];
                let rate = transmitted(elastic, &drive.rotor, joint_state(&state, body), model.knots).rate;
                p.dissipated += T::from_param(elastic.damping) * rate * rate;
            }
            p.dissipated += drive.rotor.reflected_friction(motor_velocity) * motor_velocity;
        }
        p.supplied += tau[start] * motor_velocity;
    }
    Ok(p)
}

fn joint_state<T: Scalar>(state: &State<T>, body: &Body<T::Param>) -> JointState<T> {
    let k = body.v_index();
    JointState { q: state.q[body.q_index()], qd: state.qd[k], theta: state.theta[k], thetad: state.thetad[k] }
}

/// Poses in the world and velocities of all bodies, in the recursion's frames.
fn move_bodies<T: Scalar>(model: &Model<T::Param>, state: &State<T>, scratch: &mut [(Transform<T>, Motion<T>)]) {
    for (i, body) in model.bodies.iter().enumerate() {
        let x = transform(body, state.q);
        let (pose, v_p) = body.parent().map_or((x, Motion::zero()), |p| (x.after(scratch[p].0), scratch[p].1));
        scratch[i] = (pose, velocity(body, v_p, state.q, state.qd));
    }
}
