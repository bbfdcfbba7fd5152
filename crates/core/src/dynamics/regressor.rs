//! Inverse dynamics as a linear function of the robot's parameters (Siciliano et al., *Robotics*, §7.2.2), with rotors.
//!
//! Three equations hold at a driven joint, and each is linear in parameters of its own:
//!
//! ```text
//! link            τ_J = Sᵀ f + f_l(q̇)                        inertia of links and rotors, link-side friction
//! transmission    τ_J = K δ + K₃ δ³ + D δ̇                    stiffness and damping, where the transmission is elastic
//! motor           τ − (1 − e') τ_J = B θ̈ + N J n·α + N f_m    rotor inertia, motor-side friction
//! ```
//!
//! Cost O(n·depth). No allocation, no branch on values.

use super::at_base::{DerivativeScratch, carrier, outward};
use super::drive_torque::transmission_error;
use super::pairs::{OnCarrier, for_each_carrying};
use super::{Acceleration, State, check_scratch, check_state};
use crate::Scalar;
use crate::model::{Body, Drive, Friction, JointKind, Model, SizeError};
use crate::spatial::{Force, SpatialInertia, SymMat3, Vec3};

/// Parameters of one body, its joint and its joint's drive, in this order: mass; first moment of mass x, y, z; rotational inertia about the
/// origin of the link frame xx, yy, zz, xy, xz, yz, all with what is fixed to the link and with its rotors at rest, in the link frame;
/// spin inertia `J` of the joint's rotor; link-side friction viscous, coulomb, stribeck; the same on the motor side; `K`, `K₃`, `D`.
///
/// In SI units, each on its own side of the gear. A spring that is a table has no `K` and `K₃` here. What is not linear, the speeds at
/// which friction turns and fades, gear ratios and transmission errors, is taken from the model.
pub const PARAMETERS: usize = 20;

const ROTOR: usize = 10;
const LINK_FRICTION: usize = 11;
const MOTOR_FRICTION: usize = 14;
const STIFFNESS: usize = 17;

/// What [`regressor`] writes: `nv` rows of [`PARAMETERS`] entries for each body, by rows.
#[derive(Debug)]
pub struct Regressor<'a, T> {
    /// Of the torque that the links need of the transmission.
    pub link: &'a mut [T],
    /// Of the torque that the transmission exerts.
    pub transmission: &'a mut [T],
    /// Of the torque that the motor must exert beside the transmission's, reflected to the link side.
    pub motor: &'a mut [T],
}

/// The regressor of inverse dynamics: with the model's [`parameters`] `π`, `tau_j` of [`super::rnea`] without external loads is `link π`, and
/// `tau` is `(1 − e') tau_j + motor π`. `scratch` has one record per body.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn regressor<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    accel: Acceleration<T>,
    scratch: &mut [DerivativeScratch<T>],
    out: Regressor<T>,
) -> Result<(), SizeError> {
    let Regressor { link, transmission, motor } = out;
    check_state(model, &state)?;
    check_scratch(model, scratch)?;
    SizeError::check("qdd", accel.qdd.len(), model.nv)?;
    SizeError::check("thetadd", accel.thetadd.len(), model.nv)?;
    let width = PARAMETERS * model.bodies.len();
    for (name, matrix) in [("link", &mut *link), ("transmission", &mut *transmission), ("motor", &mut *motor)] {
        SizeError::check(name, matrix.len(), model.nv * width)?;
        matrix.fill(T::zero());
    }
    outward::<T, T, false>(
        model,
        state.q,
        |k| state.qd[k],
        |k| accel.qdd[k],
        |body| body.inertia.map(T::from_param),
        scratch,
    )?;

    for (i, body) in model.bodies.iter().enumerate() {
        // The force of each inertial parameter, and what it asks of the joints that carry the body.
        let x = body.frame.map(T::from_param).after(scratch[i].pose);
        let (v, a) = (x.motion(scratch[i].v), x.motion(scratch[i].a));
        for parameter in 0..ROTOR {
            let inertia = unit_inertia::<T>(parameter);
            let f = x.inv_force(inertia.momentum(a) + v.cross_force(inertia.momentum(v)));
            for_each_support(model, scratch, i, f, |row, torque| {
                link[row * width + i * PARAMETERS + parameter] = torque;
            });
        }
        if body.joint == JointKind::Floating {
            continue;
        }
        let k = body.v_index();
        let own = k * width + i * PARAMETERS;
        write(link, own + LINK_FRICTION, parts(&body.friction, state.qd[k]));
        let Some(Drive { rotor, elastic }) = &body.drive else { continue };
        let (mut speed, mut acceleration) = (state.qd[k], accel.qdd[k]);
        if let Some(elastic) = elastic {
            (speed, acceleration) = (state.thetad[k], accel.thetadd[k]);
            let (e, slope) = transmission_error(elastic, rotor, state.theta[k]);
            let deflection = state.theta[k] - state.q[body.q_index()] - e;
            let rate = (T::one() - slope) * speed - state.qd[k];
            let cube = deflection * deflection * deflection;
            let [linear, cubic] = if elastic.spring.knots == 0 { [deflection, cube] } else { [T::zero(); 2] };
            write(transmission, own + STIFFNESS, [linear, cubic, rate]);
        }
        // N² θ̈ + N n·α for the motor, the couple N (θ̈ n + θ̇ ω × n) on the carrier
        let n = T::from_param(rotor.gear_ratio);
        let reflected = parts(&rotor.friction, n * speed).map(|part| n * part);
        write(motor, own + MOTOR_FRICTION, reflected);
        let mut inertial = n * n * acceleration;
        if let Some(at) = carrier::<T, T>(rotor, scratch) {
            inertial += n * at.2.dot(scratch[at.0].a.ang);
            for_each_carrying(model, scratch, at, |on: OnCarrier<T>| {
                link[on.column * width + i * PARAMETERS + ROTOR] = n * (acceleration * on.speed + speed * on.across);
            });
        }
        motor[own + ROTOR] = inertial;
    }
    Ok(())
}

/// The parameters of a model, [`PARAMETERS`] for each body.
///
/// # Errors
/// [`SizeError`] if the slice does not fit the model; nothing is written then.
pub fn parameters<P: Scalar<Param = P>>(model: &Model<P>, out: &mut [P]) -> Result<(), SizeError> {
    SizeError::check("parameters", out.len(), PARAMETERS * model.bodies.len())?;
    out.fill(P::zero());
    for (body, out) in model.bodies.iter().zip(out.chunks_exact_mut(PARAMETERS)) {
        let SpatialInertia { mass, first_moment: h, rotational: r } = in_link_frame(body);
        write(out, 0, [mass, h.x, h.y, h.z, r.xx, r.yy, r.zz, r.xy, r.xz, r.yz]);
        let of = |friction: &Friction<P>| [friction.viscous, friction.coulomb, friction.stribeck];
        write(out, LINK_FRICTION, of(&body.friction));
        let Some(Drive { rotor, elastic }) = &body.drive else { continue };
        out[ROTOR] = rotor.inertia;
        write(out, MOTOR_FRICTION, of(&rotor.friction));
        if let Some(elastic) = elastic {
            let spring = &elastic.spring;
            let [linear, cubic] = if spring.knots == 0 { [spring.stiffness, spring.cubic] } else { [P::zero(); 2] };
            write(out, STIFFNESS, [linear, cubic, elastic.damping]);
        }
    }
    Ok(())
}

fn in_link_frame<P: Scalar<Param = P>>(body: &Body<P>) -> SpatialInertia<P> {
    body.inertia_with_rotors::<P>().seen_from_parent(body.frame.inverse())
}

/// The inertia whose ten numbers are zero but for one.
fn unit_inertia<T: Scalar>(parameter: usize) -> SpatialInertia<T> {
    let mut x = [T::zero(); ROTOR];
    x[parameter] = T::one();
    let [mass, hx, hy, hz, xx, yy, zz, xy, xz, yz] = x;
    let rotational = SymMat3 { xx, yy, zz, xy, xz, yz };
    SpatialInertia { mass, first_moment: Vec3::new(hx, hy, hz), rotational }
}

/// Viscous, Coulomb and Stribeck friction per unit of their coefficients.
fn parts<T: Scalar>(friction: &Friction<T::Param>, v: T) -> [T; 3] {
    let x = v / T::from_param(friction.stribeck_velocity);
    let sign = (v / T::from_param(friction.smoothing_velocity)).tanh();
    [v, sign, (-(x * x)).exp() * sign]
}

/// `put(coordinate, Sᵀ f)` for the joints that carry body `i`.
fn for_each_support<T: Scalar>(
    model: &Model<T::Param>,
    scratch: &[DerivativeScratch<T>],
    i: usize,
    f: Force<T>,
    mut put: impl FnMut(usize, T),
) {
    let mut at = Some(i);
    while let Some(p) = at {
        let on = &model.bodies[p];
        if on.joint == JointKind::Floating {
            for (c, torque) in f.to_array().into_iter().enumerate() {
                put(on.v_index() + c, torque);
            }
            break;
        }
        put(on.v_index(), scratch[p].axis.dot(f));
        at = on.parent();
    }
}

fn write<T: Copy, const N: usize>(out: &mut [T], at: usize, x: [T; N]) {
    out[at..at + N].copy_from_slice(&x);
}
