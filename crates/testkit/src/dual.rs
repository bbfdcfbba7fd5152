//! Automatic differentiation of any algorithm of the core, in one direction.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use gyroflex::Scalar;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// `value + slope ε` with `ε² = 0`: what a function gives for it has the function's derivative along `slope` beside its value.
/// Of dual numbers, it has second derivatives, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T = f64> {
    /// The number.
    pub value: T,
    /// Its derivative.
    pub slope: T,
}

impl<T> Dual<T> {
    /// A number and its derivative.
    pub const fn new(value: T, slope: T) -> Self {
        Self { value, slope }
    }
}

impl<T: Scalar> Dual<T> {
    /// A function of one number, given its value and derivative there.
    fn through(self, value: T, derivative: T) -> Self {
        Self { value, slope: derivative * self.slope }
    }
}

impl<T: Scalar> Add for Dual<T> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::new(self.value + b.value, self.slope + b.slope)
    }
}
impl<T: Scalar> Sub for Dual<T> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::new(self.value - b.value, self.slope - b.slope)
    }
}
impl<T: Scalar> Mul for Dual<T> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self::new(self.value * b.value, self.slope * b.value + self.value * b.slope)
    }
}
impl<T: Scalar> Div for Dual<T> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        Self::new(value, (self.slope - value * b.slope) / b.value)
    }
}
impl<T: Scalar> Neg for Dual<T> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.value, -self.slope)
    }
}
impl<T: Scalar> AddAssign for Dual<T> {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
impl<T: Scalar> SubAssign for Dual<T> {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<T: Scalar<Param = f64>> Scalar for Dual<T> {
    type Param = f64;

    fn from_param(x: f64) -> Self {
        Self::from_f64(x)
    }
    fn from_f64(x: f64) -> Self {
        Self::new(T::from_f64(x), T::zero())
    }
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slope.is_finite()
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.through(root, T::from_f64(0.5) / root)
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
        self.through(t, T::one() - t * t)
    }
    fn exp(self) -> Self {
        let e = self.value.exp();
        self.through(e, e)
    }
    fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self {
        let select = |less: T, otherwise: T| self.value.select_less(threshold.value, less, otherwise);
        Self::new(select(less.value, otherwise.value), select(less.slope, otherwise.slope))
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
