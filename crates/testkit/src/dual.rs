//! Automatic differentiation of any algorithm of the core, in one direction.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use gyroflex::Scalar;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// `value + slope ε` with `ε² = 0`: what a function gives for it has the function's derivative along `slope` beside its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The number.
    pub value: f64,
    /// Its derivative.
    pub slope: f64,
}

impl Dual {
    /// A number and its derivative.
    pub const fn new(value: f64, slope: f64) -> Self {
        Self { value, slope }
    }

    /// A function of one number, given its value and derivative there.
    fn through(self, value: f64, derivative: f64) -> Self {
        Self { value, slope: derivative * self.slope }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::new(self.value + b.value, self.slope + b.slope)
    }
}
impl Sub for Dual {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::new(self.value - b.value, self.slope - b.slope)
    }
}
impl Mul for Dual {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self::new(self.value * b.value, self.slope * b.value + self.value * b.slope)
    }
}
impl Div for Dual {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        Self::new(value, (self.slope - value * b.slope) / b.value)
    }
}
impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.value, -self.slope)
    }
}
impl AddAssign for Dual {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
impl SubAssign for Dual {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl Scalar for Dual {
    type Param = f64;

    fn from_param(x: f64) -> Self {
        Self::new(x, 0.0)
    }
    fn from_f64(x: f64) -> Self {
        Self::new(x, 0.0)
    }
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slope.is_finite()
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.through(root, 0.5 / root)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (self.through(s, c), self.through(c, -s))
    }
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        Self::new(self.value.atan2(x.value), (self.slope * x.value - self.value * x.slope) / square)
    }
    fn tanh(self) -> Self {
        let t = self.value.tanh();
        self.through(t, 1.0 - t * t)
    }
    fn exp(self) -> Self {
        let e = self.value.exp();
        self.through(e, e)
    }
    fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self {
        if self.value < threshold.value { less } else { otherwise }
    }
}

/// The positions of a robot that moves with `qd`: a floating root's pose changes by its twist in its own frame, `ṗ = R v`,
/// `Q̇ = ½ Q (ω, 0)`.
pub fn moving_positions(q: &[f64], qd: &[f64]) -> Vec<Dual> {
    if q.len() == qd.len() {
        return q.iter().zip(qd).map(|(q, qd)| Dual::new(*q, *qd)).collect();
    }
    let turn = Quaternion::new(q[6], q[3], q[4], q[5]);
    let turning = turn * Quaternion::new(0.0, qd[0], qd[1], qd[2]) * 0.5;
    let flying = UnitQuaternion::new_unchecked(turn) * Vector3::new(qd[3], qd[4], qd[5]);
    let root = [flying.x, flying.y, flying.z, turning.i, turning.j, turning.k, turning.w];
    q.iter().zip(root.iter().chain(&qd[6..])).map(|(q, rate)| Dual::new(*q, *rate)).collect()
}
