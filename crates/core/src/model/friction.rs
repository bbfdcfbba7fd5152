//! Friction of a shaft.

use crate::Scalar;

/// Smooth friction, odd in the velocity `v` of its side:
/// `f(v) = viscous v + (coulomb + stribeck exp(−(v / v_stribeck)²)) tanh(v / v_smoothing)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction<T> {
    /// Viscous coefficient [N m s/rad], ≥ 0.
    pub viscous: T,
    /// Coulomb torque at high speed [N m], ≥ 0.
    pub coulomb: T,
    /// Velocity over which the sign of the dry torque turns [rad/s], > 0.
    pub smoothing_velocity: T,
    /// Breakaway torque in excess of `coulomb` [N m], ≥ 0.
    pub stribeck: T,
    /// Velocity at which that excess has faded to 1/e [rad/s], > 0.
    pub stribeck_velocity: T,
    /// Whether `coulomb` or `stribeck` is not zero; decided once, so that smooth robots do not pay for `tanh` and `exp`.
    pub dry: bool,
}

impl<T: Scalar> Friction<T> {
    /// No friction.
    pub fn none() -> Self {
        Self::viscous(T::zero())
    }

    /// Viscous friction alone.
    pub fn viscous(viscous: T) -> Self {
        Self {
            viscous,
            coulomb: T::zero(),
            smoothing_velocity: T::from_f64(DEFAULT_SMOOTHING_VELOCITY),
            stribeck: T::zero(),
            stribeck_velocity: T::from_f64(DEFAULT_STRIBECK_VELOCITY),
            dry: false,
        }
    }

    /// The opposing torque at velocity `v` [N m].
    #[inline(always)]
    pub fn torque<F: Scalar<Param = T>>(&self, v: F) -> F {
        let viscous = F::from_param(self.viscous) * v;
        if !self.dry {
            return viscous;
        }
        let x = v / F::from_param(self.stribeck_velocity);
        let dry = F::from_param(self.coulomb) + F::from_param(self.stribeck) * (-(x * x)).exp();
        dry.mul_add((v / F::from_param(self.smoothing_velocity)).tanh(), viscous)
    }

    /// `df/dv` at velocity `v` [N m s/rad].
    #[inline(always)]
    pub fn slope<F: Scalar<Param = T>>(&self, v: F) -> F {
        let viscous = F::from_param(self.viscous);
        if !self.dry {
            return viscous;
        }
        let (fade, smoothing) = (F::from_param(self.stribeck_velocity), F::from_param(self.smoothing_velocity));
        let x = v / fade;
        let excess = F::from_param(self.stribeck) * (-(x * x)).exp();
        let sign = (v / smoothing).tanh();
        let dry = F::from_param(self.coulomb) + excess;
        viscous + dry * (F::one() - sign * sign) / smoothing - (x + x) / fade * excess * sign
    }

    /// The same friction in another scalar.
    pub fn map<U>(self, mut f: impl FnMut(T) -> U) -> Friction<U> {
        Friction {
            viscous: f(self.viscous),
            coulomb: f(self.coulomb),
            smoothing_velocity: f(self.smoothing_velocity),
            stribeck: f(self.stribeck),
            stribeck_velocity: f(self.stribeck_velocity),
            dry: self.dry,
        }
    }
}

impl Friction<f64> {
    /// Viscous and Coulomb friction, the sign of the latter smoothed over `smoothing_velocity`.
    pub fn coulomb(viscous: f64, coulomb: f64, smoothing_velocity: f64) -> Self {
        Self { coulomb, smoothing_velocity, dry: coulomb != 0.0, ..Self::viscous(viscous) }
    }

    /// Adds a breakaway torque `stribeck` above the Coulomb torque, fading over `stribeck_velocity`.
    pub fn with_stribeck(self, stribeck: f64, stribeck_velocity: f64) -> Self {
        Self { stribeck, stribeck_velocity, dry: self.dry || stribeck != 0.0, ..self }
    }
}

/// Velocity over which the sign of Coulomb friction turns, where a file is silent [rad/s].
pub(crate) const DEFAULT_SMOOTHING_VELOCITY: f64 = 0.01;
/// Velocity of the Stribeck effect, where a file is silent [rad/s].
pub(crate) const DEFAULT_STRIBECK_VELOCITY: f64 = 0.1;
