//! The record of one motor, its gear and its transmission.

use super::{Friction, Spring};
use crate::Scalar;
use crate::spatial::Vec3;

/// The drive of a joint: a rotor, a gear and, unless the gear is rigid, an elastic transmission.
#[derive(Clone, Copy, Debug)]
pub struct Drive<T> {
    /// The rotor and its gear.
    pub rotor: Rotor<T>,
    /// The transmission; `None` is a rigid gear, `theta = q`.
    pub elastic: Option<Elastic<T>>,
}

/// A balanced rotor, spinning about an axis fixed in the body that carries it.
///
/// Its mass and its inertia at rest are part of that body's inertia; what is left for run time is one scalar equation
/// and one couple (PHYSICS §3).
#[derive(Clone, Copy, Debug)]
pub struct Rotor<T> {
    /// Index of the body that carries the rotor; `None` is the fixed world.
    pub mount: Option<u16>,
    /// Spin axis in the carrying body's frame; zero where rotor and carrier do not act on each other (the reduced and the
    /// rigid reflected model, a rotor on the fixed world).
    pub axis: Vec3<T>,
    /// `J`: spin inertia [kg m²], motor side.
    pub inertia: T,
    /// `N`: rotor turns per joint turn.
    pub gear_ratio: T,
    /// `1 / N`.
    pub inv_gear_ratio: T,
    /// `B = N² J`: reflected inertia [kg m²], link side.
    pub reflected_inertia: T,
    /// `1 / B`.
    pub inv_reflected_inertia: T,
    /// Friction on the motor side, in rotor velocity and motor torque.
    pub friction: Friction<T>,
}

impl<T: Scalar> Rotor<T> {
    /// The body that carries the rotor; `None` is the fixed world.
    pub fn mount(&self) -> Option<usize> {
        self.mount.map(usize::from)
    }

    /// `n`.
    #[inline(always)]
    pub(crate) fn axis_in<F: Scalar<Param = T>>(&self) -> Vec3<F> {
        self.axis.map(F::from_param)
    }

    /// `N J n`: what accelerating the joint asks of the carrier, and the carrier of the joint.
    #[inline(always)]
    pub(crate) fn coupling<F: Scalar<Param = T>>(&self) -> Vec3<F> {
        self.axis_in().scale(F::from_param(self.gear_ratio) * F::from_param(self.inertia))
    }

    /// `J (N θ̇ + n·ω)`: the rotor's absolute axial angular momentum [N m s], `ω` that of the carrier; with accelerations its rate.
    #[inline(always)]
    pub(crate) fn axial_momentum<F: Scalar<Param = T>>(&self, thetad: F, omega: Vec3<F>) -> F {
        let spin = F::from_param(self.gear_ratio).mul_add(thetad, self.axis_in().dot(omega));
        F::from_param(self.inertia) * spin
    }

    /// Motor friction reflected to the link side, `N f(N θ̇)` [N m].
    #[inline(always)]
    pub fn reflected_friction<F: Scalar<Param = T>>(&self, thetad: F) -> F {
        let n = F::from_param(self.gear_ratio);
        n * self.friction.torque(n * thetad)
    }

    /// `N² f'(N θ̇)`: how fast that friction grows with the reflected speed [N m s/rad].
    #[inline(always)]
    pub fn reflected_friction_slope<F: Scalar<Param = T>>(&self, thetad: F) -> F {
        let n = F::from_param(self.gear_ratio);
        n * n * self.friction.slope(n * thetad)
    }
}

/// An elastic transmission: spring and damper side by side, on the link side.
#[derive(Clone, Copy, Debug)]
pub struct Elastic<T> {
    /// `k(δ)`: torque over deflection.
    pub spring: Spring<T>,
    /// `D` [N m s/rad].
    pub damping: T,
    /// `e(θ)`: periodic error of the gear; `None` for a perfect one.
    pub error: Option<TransmissionError<T>>,
}

/// The periodic error of a gear on the link side, `e = A sin(c θ_m + φ)`, so that the deflection is `δ = θ − q − e`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransmissionError<T> {
    /// `A` [rad].
    pub amplitude: T,
    /// `c`: cycles per rotor turn [–].
    pub cycles_per_rotor_turn: T,
    /// `φ` [rad].
    pub phase: T,
}

impl<T: Scalar> TransmissionError<T> {
    /// A gear without error.
    pub fn none() -> Self {
        Self { amplitude: T::zero(), cycles_per_rotor_turn: T::one(), phase: T::zero() }
    }

    /// `e(θ)` [rad] and `e'(θ) = de/dθ` [–] at the reflected motor position `θ` of a gear of ratio `N`.
    #[inline(always)]
    pub fn value_and_slope<F: Scalar<Param = T>>(&self, theta: F, gear_ratio: F) -> (F, F) {
        let (amplitude, cycles) =
            (F::from_param(self.amplitude), F::from_param(self.cycles_per_rotor_turn) * gear_ratio);
        let (s, c) = cycles.mul_add(theta, F::from_param(self.phase)).sin_cos();
        (amplitude * s, amplitude * cycles * c)
    }

    /// `e''(θ) = −(c N)² e` [1/rad] where the error is `e`.
    #[inline(always)]
    pub(crate) fn curvature<F: Scalar<Param = T>>(&self, e: F, gear_ratio: F) -> F {
        let cycles = F::from_param(self.cycles_per_rotor_turn) * gear_ratio;
        -(cycles * cycles * e)
    }

    fn map<U>(self, mut f: impl FnMut(T) -> U) -> TransmissionError<U> {
        TransmissionError {
            amplitude: f(self.amplitude),
            cycles_per_rotor_turn: f(self.cycles_per_rotor_turn),
            phase: f(self.phase),
        }
    }
}

impl<T: Scalar> Drive<T> {
    /// Reflected speed of the rotor: `θ̇`, behind a rigid gear `q̇`.
    #[inline(always)]
    pub(crate) fn spin<F: Scalar<Param = T>>(&self, qd: F, thetad: F) -> F {
        if self.elastic.is_some() { thetad } else { qd }
    }

    pub(crate) fn map<U>(self, mut f: impl FnMut(T) -> U) -> Drive<U> {
        let r = self.rotor;
        Drive {
            rotor: Rotor {
                mount: r.mount,
                axis: r.axis.map(&mut f),
                inertia: f(r.inertia),
                gear_ratio: f(r.gear_ratio),
                inv_gear_ratio: f(r.inv_gear_ratio),
                reflected_inertia: f(r.reflected_inertia),
                inv_reflected_inertia: f(r.inv_reflected_inertia),
                friction: r.friction.map(&mut f),
            },
            elastic: self.elastic.map(|e| Elastic {
                spring: e.spring.map(&mut f),
                damping: f(e.damping),
                error: e.error.map(|t| t.map(&mut f)),
            }),
        }
    }
}
