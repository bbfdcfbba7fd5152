//! Torques of one joint's transmission, rotor and friction: all that a drive adds to a joint.

use crate::Scalar;
use crate::model::{Body, Drive, Elastic, Knot, Rotor};
use crate::spatial::Vec3;

/// Coordinates of one joint of one degree of freedom and of its motor, reflected.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointState<T> {
    pub(super) q: T,
    pub(super) qd: T,
    pub(super) theta: T,
    pub(super) thetad: T,
}

/// Deflection of an elastic transmission and the torque through it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transmitted<T> {
    /// `δ = θ − q − e(θ)` [rad].
    pub(super) deflection: T,
    /// `δ̇ = (1 − e') θ̇ − q̇` [rad/s].
    pub(super) rate: T,
    /// `τ_J = k(δ) + D δ̇` [N m], on the link.
    pub(super) tau_j: T,
    /// `1 − e'(θ)`: what of `τ_J` the motor feels, by virtual work (PHYSICS §1).
    pub(super) on_motor: T,
}

/// The transmission at its present state.
#[inline(always)]
pub(super) fn transmitted<T: Scalar>(
    elastic: &Elastic<T::Param>,
    rotor: &Rotor<T::Param>,
    at: JointState<T>,
    knots: &[Knot<T::Param>],
) -> Transmitted<T> {
    let (e, slope) = transmission_error(elastic, rotor, at.theta);
    let on_motor = T::one() - slope;
    let deflection = at.theta - at.q - e;
    let rate = on_motor.mul_add(at.thetad, -at.qd);
    let tau_j = T::from_param(elastic.damping).mul_add(rate, elastic.spring.torque(deflection, knots));
    Transmitted { deflection, rate, tau_j, on_motor }
}

/// `e(θ)` and `e'(θ)`, both zero for a perfect gear.
#[inline(always)]
pub(super) fn transmission_error<T: Scalar>(elastic: &Elastic<T::Param>, rotor: &Rotor<T::Param>, theta: T) -> (T, T) {
    match &elastic.error {
        Some(error) => error.value_and_slope(theta, T::from_param(rotor.gear_ratio)),
        None => (T::zero(), T::zero()),
    }
}

/// What acts on a joint before anything moves: on its link, and on its rotor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drives<T> {
    /// Generalised force on the joint's link side: transmission or motor, external load, link friction [N m].
    pub(super) on_link: T,
    /// Net torque on an elastic joint's rotor, reflected: `τ − (1 − e') τ_J − N f_m` [N m]; zero elsewhere.
    pub(super) on_rotor: T,
    /// Torque of the transmission, or what motor and motor friction leave for a rigid gear [N m].
    pub(super) tau_j: T,
}

/// Collects the known torques at a joint of one degree of freedom.
#[inline(always)]
pub(super) fn drives<T: Scalar>(
    body: &Body<T::Param>,
    at: JointState<T>,
    tau: T,
    tau_ext: T,
    knots: &[Knot<T::Param>],
) -> Drives<T> {
    let load = tau_ext - body.friction.torque(at.qd);
    let Some(drive) = &body.drive else {
        return Drives { on_link: tau + load, on_rotor: T::zero(), tau_j: tau };
    };
    match &drive.elastic {
        Some(elastic) => {
            let t = transmitted(elastic, &drive.rotor, at, knots);
            let on_rotor = tau - t.on_motor * t.tau_j - drive.rotor.reflected_friction(at.thetad);
            Drives { on_link: t.tau_j + load, on_rotor, tau_j: t.tau_j }
        }
        None => {
            let net = tau - drive.rotor.reflected_friction(at.qd);
            Drives { on_link: net + load, on_rotor: T::zero(), tau_j: net }
        }
    }
}

/// Couple that a rotor needs of its carrier, of angular velocity `omega`, as far as the state alone says: elastic, of
/// reflected speed `spin = θ̇`, `ω × h n + (τ − τ_J)/N n`, rigid, `spin = q̇`, `ω × N J q̇ n`, in the carrier's axes.
#[inline(always)]
pub(super) fn rotor_couple<T: Scalar>(drive: &Drive<T::Param>, spin: T, omega: Vec3<T>, on_rotor: T) -> Vec3<T> {
    let rotor = &drive.rotor;
    let (h, h_dot) = match drive.elastic {
        Some(_) => (rotor.axial_momentum(spin, omega), on_rotor * T::from_param(rotor.inv_gear_ratio)),
        None => (rotor.axial_momentum(spin, Vec3::zero()), T::zero()),
    };
    let axis = rotor.axis_in();
    omega.cross_plus(axis.scale(h), axis.scale(h_dot))
}

/// Acceleration of an elastic rotor, reflected: `θ̈ = (τ − τ_J)/B − (n·α)/N`, `alpha` that of its carrier.
#[inline(always)]
pub(super) fn rotor_acceleration<T: Scalar>(rotor: &Rotor<T::Param>, on_rotor: T, alpha: Vec3<T>) -> T {
    let own = on_rotor * T::from_param(rotor.inv_reflected_inertia);
    own - rotor.axis_in().dot(alpha) * T::from_param(rotor.inv_gear_ratio)
}

/// Torque that a rigidly geared rotor takes, reflected: `B q̈ + N J n·α`, `alpha` that of its carrier.
#[inline(always)]
pub(super) fn rotor_torque<T: Scalar>(rotor: &Rotor<T::Param>, qdd: T, alpha: Vec3<T>) -> T {
    T::from_param(rotor.reflected_inertia).mul_add(qdd, rotor.coupling().dot(alpha))
}

/// How the torques of [`drives`] change with `q, q̇, θ, θ̇, τ` of their joint.
pub(super) struct Sensitivity<T> {
    /// Of what acts on the link.
    pub(super) on_link: [T; 5],
    /// Of what acts on an elastic joint's rotor.
    pub(super) on_rotor: [T; 5],
}

/// The same at the present state.
#[inline(always)]
pub(super) fn sensitivity<T: Scalar>(
    body: &Body<T::Param>,
    at: JointState<T>,
    knots: &[Knot<T::Param>],
) -> Sensitivity<T> {
    let (zero, one) = (T::zero(), T::one());
    let link = body.friction.slope(at.qd);
    let rigid = |friction: T| Sensitivity { on_link: [zero, -friction, zero, zero, one], on_rotor: [zero; 5] };
    let Some(drive) = &body.drive else { return rigid(link) };
    let rotor = &drive.rotor;
    let Some(elastic) = &drive.elastic else { return rigid(link + rotor.reflected_friction_slope(at.qd)) };

    // τ_J = k(δ) + D δ̇ with δ = θ − q − e(θ),   r = τ − (1 − e') τ_J − N f_m
    let (e, _) = transmission_error(elastic, rotor, at.theta);
    let t = transmitted(elastic, rotor, at, knots);
    let curvature = elastic.error.map_or(zero, |error| error.curvature(e, T::from_param(rotor.gear_ratio)));
    let (stiffness, damping) = (elastic.spring.slope(t.deflection, knots), T::from_param(elastic.damping));
    let by_theta = stiffness.mul_add(t.on_motor, -(damping * curvature * at.thetad));
    let tau_j = [-stiffness, -damping, by_theta, damping * t.on_motor, zero];
    let mut on_rotor = tau_j.map(|x| -(t.on_motor * x));
    on_rotor[2] += curvature * t.tau_j;
    on_rotor[3] -= rotor.reflected_friction_slope(at.thetad);
    on_rotor[4] = one;
    let mut on_link = tau_j;
    on_link[1] -= link;
    Sensitivity { on_link, on_rotor }
}
