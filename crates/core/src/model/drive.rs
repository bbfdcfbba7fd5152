//! The record of one motor, its gear and its transmission.

use super::{Friction, Spring, body::index};
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
    pub(crate) mount: u16,
    /// Spin axis in the carrying body's frame; zero where rotor and carrier do not act on each other (the reduced and the
    /// rigid reflected model, a rotor on the fixed world).
    pub(crate) axis: Vec3<T>,
    /// `J`: spin inertia [kg m²], motor side.
    pub inertia: T,
    /// `N`: rotor turns per joint turn.
    pub gear_ratio: T,
    /// `1 / N`.
    pub(crate) inv_gear_ratio: T,
    /// `B = N² J`: reflected inertia [kg m²], link side.
    pub reflected_inertia: T,
    /// `1 / B`.
    pub(crate) inv_reflected_inertia: T,
    /// Friction on the motor side, in rotor velocity and motor torque.
    pub friction: Friction<T>,
}

impl<T: Scalar> Rotor<T> {
    /// The body that carries the rotor; `None` is the fixed world.
    pub fn mount(&self) -> Option<usize> {
        index(self.mount)
    }

    /// The rotor's absolute axial angular momentum `h = N J θ̇ + J n·ω` [N m s], `ω` that of the carrier.
    #[inline]
    pub(crate) fn axial_momentum(&self, thetad: T, omega: Vec3<T>) -> T {
        self.inertia * (self.gear_ratio * thetad + self.axis.dot(omega))
    }

    /// Motor friction reflected to the link side, `N f(N θ̇)` [N m].
    #[inline]
    pub fn reflected_friction(&self, thetad: T) -> T {
        self.gear_ratio * self.friction.torque(self.gear_ratio * thetad)
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
    #[inline]
    pub fn value_and_slope(&self, theta: T, gear_ratio: T) -> (T, T) {
        let cycles = self.cycles_per_rotor_turn * gear_ratio;
        let (s, c) = (cycles * theta + self.phase).sin_cos();
        (self.amplitude * s, self.amplitude * cycles * c)
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
