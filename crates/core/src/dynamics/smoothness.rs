//! How many derivatives of a motion the inverse of an elastic robot depends on, joint by joint.
//!
//! To find `θ` to some order, the torque through an elastic transmission must be known to the same order (a damped one carries
//! its deflection as a state: one order less). A rotor's couple brings `θ̈`, or `θ̇` where its axis is always across a joint,
//! into the torques of the joints nearer to the base; so orders grow from the base to the tips. With `a_i` the order to which the
//! torque `τ_J` of joint `i` is needed and `o_ij` the highest derivative of `θ_j` in it (`∂τ_J/∂θ̈ = S`, `∂τ_J/∂θ̇ = C₁`):
//!
//! ```text
//! a_j ≥ 2 (undamped), 1 (damped)                    the motor's own B θ̈
//! a_j ≥ a_i + o_ij (undamped), a_i + o_ij − 1 (damped)
//! order of q_k = max over i of a_i + o_ik           o_ik: the highest derivative of q_k in τ_J,i
//! ```
//!
//! For an arm of `n` joints that is at most `2 (n + 1)` undamped and `n + 2` damped (De Luca & Tomei 1996; Thümmel, Otter & Bals,
//! §5). Which derivatives a torque does not contain is decided at several configurations.

use super::{Acceleration, DerivativeScratch, External, InverseDerivatives, State, inverse_derivatives};
use crate::model::{Body, JointKind, Model, SizeError};

/// What the inverse asks of one joint: orders are numbers of time derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct JointOrders {
    /// Derivatives of the joint's position that the torques depend on; of a floating root those of its pose, its twist being the first.
    pub position: u8,
    /// Order to which the torque through the joint's transmission is needed.
    pub torque: u8,
    /// Order to which the force on the body is needed: the most of its own joint and those nearer to the base.
    pub force: u8,
    /// Order to which the acceleration of the body is needed: the most of its own force and those beyond it.
    pub motion: u8,
    /// Whether the joint's transmission is elastic and damped, so that its deflection is a state of the inverse.
    pub damped: bool,
}

/// The orders of all joints of a robot, in storage that someone else owns.
#[derive(Clone, Copy, Debug)]
pub struct Smoothness<'a> {
    /// One entry per body.
    pub joints: &'a [JointOrders],
    /// How many time derivatives of the motor torques are asked for besides the torques themselves.
    pub torque_derivatives: usize,
}

impl Smoothness<'_> {
    /// Derivatives that the most demanding joint needs.
    pub fn order(&self) -> usize {
        self.joints.iter().map(|j| usize::from(j.position)).max().unwrap_or(0)
    }

    /// Taylor coefficients of accelerations that the recursions carry.
    pub fn coefficients(&self) -> usize {
        1 + self.joints.iter().map(|j| usize::from(j.motion)).max().unwrap_or(0)
    }
}

/// What [`required_smoothness`] works in.
#[derive(Debug)]
pub struct SmoothnessScratch<'a> {
    /// One record per body.
    pub bodies: &'a mut [DerivativeScratch<f64>],
    /// [`smoothness_len`] numbers.
    pub numbers: &'a mut [f64],
    /// `nv × nv` entries: what of each coordinate and motor each torque contains.
    pub contains: &'a mut [Contains],
}

/// Length of [`SmoothnessScratch::numbers`].
pub fn smoothness_len<T: crate::Scalar>(model: &Model<T>) -> usize {
    2 * BLOCKS * model.nv * model.nv + model.nq + 5 * model.nv
}

/// The highest derivatives that the torques of one joint contain; `None` if they contain none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contains {
    /// Of another joint's position, in the torque on the joint.
    position: Option<u8>,
    /// Of another joint's motor position, in the torque on the joint.
    motor: Option<u8>,
    /// Of another joint's position, in the torque of the motor.
    in_motor: Option<u8>,
}

/// Part of a coupling's natural size below which it counts as vanishing: well above rounding [–].
pub const VANISHING: f64 = 1e-9;

/// Blocks of the derivatives of inverse dynamics.
const BLOCKS: usize = 6;

/// Configurations that are looked at.
const SAMPLES: usize = 6;

/// Finds, for the robot and its drives, the orders of all joints; `orders` and `scratch.bodies` have one entry per body.
///
/// `torque_derivatives` asks for that many time derivatives of the motor torques besides the torques themselves. Couplings below
/// `vanishing` of their natural size ([`VANISHING`] is a good value) count as absent: the inverse then leaves out what they do at the
/// orders that they alone would ask for.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model.
pub fn required_smoothness<'o>(
    model: &Model<f64>,
    torque_derivatives: usize,
    vanishing: f64,
    scratch: SmoothnessScratch,
    orders: &'o mut [JointOrders],
) -> Result<Smoothness<'o>, SizeError> {
    let (nq, nv, n) = (model.nq, model.nv, model.bodies.len());
    SizeError::check("orders", orders.len(), n)?;
    SizeError::check("scratch.numbers", scratch.numbers.len(), smoothness_len(model))?;
    SizeError::check("scratch.contains", scratch.contains.len(), nv * nv)?;
    let SmoothnessScratch { bodies, numbers, contains } = scratch;
    contains.fill(Contains::default());

    let (tau_j, rest) = numbers.split_at_mut(BLOCKS * nv * nv);
    let (tau, rest) = rest.split_at_mut(BLOCKS * nv * nv);
    let (q, rest) = rest.split_at_mut(nq);
    for sample in 0..SAMPLES {
        spread(model.bodies, sample, q, rest);
        let (qd, rest) = rest.split_at(nv);
        let (qdd, rest) = rest.split_at(nv);
        let (theta, rest) = rest.split_at(nv);
        let (thetad, thetadd) = rest.split_at(nv);
        let state = State { q, qd, theta, thetad };
        let accel = Acceleration { qdd, thetadd };
        let out = InverseDerivatives { tau_j: &mut *tau_j, tau: &mut *tau };
        inverse_derivatives(model, state, accel, External::none(), bodies, out)?;
        note(model, tau_j, tau, vanishing, contains);
    }
    propagate(model, torque_derivatives, contains, orders);
    Ok(Smoothness { joints: orders, torque_derivatives })
}

/// Positions, velocities and accelerations that have nothing to do with each other: an additive recurrence of golden ratios.
fn spread(bodies: &[Body<f64>], sample: usize, q: &mut [f64], rates: &mut [f64]) {
    let mut count = (sample * (q.len() + rates.len()) + 1) as f64;
    let mut next = || {
        count += 1.0;
        let x = count * 0.618_033_988_749_894_9;
        2.0 * (x - x as u64 as f64) - 1.0
    };
    for body in bodies {
        let i = body.q_index();
        match body.joint {
            JointKind::Revolute => q[i] = 3.0 * next(),
            JointKind::Prismatic => q[i] = 0.5 * next(),
            JointKind::Floating => {
                // Any unit quaternion: three of its entries are small enough for a real fourth.
                let [x, y, z] = [0.55 * next(), 0.55 * next(), 0.55 * next()];
                let w = crate::Scalar::sqrt(1.0 - x * x - y * y - z * z);
                q[i..i + 7].copy_from_slice(&[next(), next(), next(), x, y, z, w]);
            }
        }
    }
    for rate in rates {
        *rate = 2.0 * next();
    }
}

/// Notes what every torque contains at one configuration.
fn note(model: &Model<f64>, tau_j: &[f64], tau: &[f64], vanishing: f64, contains: &mut [Contains]) {
    let nv = model.nv;
    let entry = |of: &[f64], block: usize, i: usize, k: usize| f64::abs(of[i * BLOCKS * nv + block * nv + k]);
    let own = |i: usize| crate::Scalar::sqrt(entry(tau_j, 2, i, i));
    for i in 0..nv {
        let speeds =
            |of: &[f64]| (0..nv).fold(0.0, |most, k| f64::max(most, f64::max(entry(of, 0, i, k), entry(of, 1, i, k))));
        let (on_joint, on_motor) = (speeds(tau_j), speeds(tau));
        for k in 0..nv {
            let inertia = own(i) * own(k);
            let highest = |of: &[f64], speeds: f64| match () {
                _ if entry(of, 2, i, k) > vanishing * inertia => Some(2),
                _ if entry(of, 1, i, k) > vanishing * f64::max(speeds, inertia) => Some(1),
                _ if entry(of, 0, i, k) > vanishing * f64::max(speeds, inertia) => Some(0),
                _ => None,
            };
            let (position, in_motor) = (highest(tau_j, on_joint), highest(tau, on_motor));
            let noted = &mut contains[i * nv + k];
            noted.position = Option::max(noted.position, position);
            noted.in_motor = Option::max(noted.in_motor, in_motor);
        }
    }
    for body in model.bodies.iter().filter(|b| b.is_elastic()) {
        let (k, Some(drive)) = (body.v_index(), &body.drive) else { continue };
        let spin = f64::abs(drive.rotor.gear_ratio * drive.rotor.inertia);
        for i in 0..nv {
            let highest = match () {
                _ if entry(tau_j, 5, i, k) > vanishing * spin => Some(2),
                _ if entry(tau_j, 4, i, k) > vanishing * spin => Some(1),
                _ => None,
            };
            let noted = &mut contains[i * nv + k].motor;
            *noted = Option::max(*noted, highest);
        }
    }
}

/// From what torques contain to orders, base to tips and back.
fn propagate(model: &Model<f64>, torque_derivatives: usize, contains: &[Contains], orders: &mut [JointOrders]) {
    let (bodies, nv, extra) = (model.bodies, model.nv, u8::try_from(torque_derivatives).unwrap_or(u8::MAX));
    for (body, order) in bodies.iter().zip(orders.iter_mut()) {
        let elastic = body.drive.as_ref().and_then(|d| d.elastic.as_ref());
        let damped = elastic.is_some_and(|e| e.damping > 0.0);
        let own = if elastic.is_none() { 0 } else { 2 - u8::from(damped) };
        *order = JointOrders { torque: extra.saturating_add(own), damped, ..JointOrders::default() };
    }
    for (i, body) in bodies.iter().enumerate() {
        let row = |k: usize| (body.v_index()..body.v_index() + body.joint.nv()).map(move |r| contains[r * nv + k]);
        let needed = orders[i].torque;
        // Rotors that this torque contains sit beyond the joint, and so do their own joints.
        for (j, outer) in bodies.iter().enumerate().skip(i + 1) {
            let Some(motor) = row(outer.v_index()).filter_map(|c| c.motor).max() else { continue };
            let own = needed.saturating_add(motor - u8::from(orders[j].damped));
            orders[j].torque = orders[j].torque.max(own);
        }
        for (k, other) in bodies.iter().enumerate() {
            let columns = other.v_index()..other.v_index() + other.joint.nv();
            for of in columns.flat_map(row) {
                let on_joint = of.position.map_or(0, |highest| needed.saturating_add(highest));
                let on_motor = of.in_motor.map_or(0, |highest| extra.saturating_add(highest));
                orders[k].position = orders[k].position.max(on_joint).max(on_motor);
            }
        }
        orders[i].force = body.parent().map_or(0, |p| orders[p].force).max(needed);
        orders[i].motion = orders[i].force;
    }
    for (i, body) in bodies.iter().enumerate().rev() {
        if let Some(parent) = body.parent() {
            orders[parent].motion = orders[parent].motion.max(orders[i].motion);
        }
    }
}
