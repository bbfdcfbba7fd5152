//! Random states from a seed.

use crate::arm::N;
use gyroflex::dynamics::{Acceleration, State};

/// Marsaglia's xorshift: the same numbers from the same seed on every machine.
#[derive(Clone, Debug)]
pub struct Dice(u32);

impl Dice {
    /// A generator; the seed must not be zero.
    pub const fn new(seed: u32) -> Self {
        Self(seed)
    }

    /// A number in `[-size, size)`.
    pub fn within(&mut self, size: f32) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        // The upper 24 bits are a whole number that f32 holds exactly.
        ((self.0 >> 8) as f32 / 8_388_608.0 - 1.0) * size
    }

    fn all(&mut self, size: f32) -> [f32; N] {
        core::array::from_fn(|_| self.within(size))
    }
}

/// A state of the arm, an acceleration asked for, and motor torques.
#[derive(Clone, Debug)]
pub struct Point {
    pub q: [f32; N],
    pub qd: [f32; N],
    pub theta: [f32; N],
    pub thetad: [f32; N],
    pub qdd: [f32; N],
    pub thetadd: [f32; N],
    pub tau: [f32; N],
    /// `q̇, q̈, q⁽³⁾, …`, for the inverse of the elastic arm.
    pub derivatives: [[f32; N]; ORDER],
}

/// Derivatives of the motion that the inverse of the elastic arm needs.
pub const ORDER: usize = 6;

impl Point {
    /// Sizes as in the tests of the whole project; the transmissions carry torques of the size of the motors'.
    pub fn random(dice: &mut Dice) -> Self {
        let q = dice.all(3.0);
        let deflection = dice.all(5e-3);
        Self {
            theta: core::array::from_fn(|i| q[i] + deflection[i]),
            q,
            qd: dice.all(2.0),
            thetad: dice.all(2.0),
            qdd: dice.all(10.0),
            thetadd: dice.all(10.0),
            tau: dice.all(30.0),
            // Of some 4 rad/s.
            derivatives: core::array::from_fn(|row| dice.all(0.5 * [4.0, 16.0, 64.0, 256.0, 1024.0, 4096.0][row])),
        }
    }

    pub fn state(&self) -> State<'_, f32> {
        State { q: &self.q, qd: &self.qd, theta: &self.theta, thetad: &self.thetad }
    }

    pub fn acceleration(&self) -> Acceleration<'_, f32> {
        Acceleration { qdd: &self.qdd, thetadd: &self.thetadd }
    }

    /// The same point with its motors turning with the joints, as a rigid gear has it.
    pub fn geared(self) -> Self {
        Self { theta: self.q, thetad: self.qd, thetadd: self.qdd, ..self }
    }
}
