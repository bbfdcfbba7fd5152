//! The coordinates of `robots/biped5`, a tree that begins at the trunk, and the paper's chain that begins at a tip.

use super::{Biped, Links, Planar};
use core::f64::consts::PI;

/// The leg whose tip is the paper's `b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stance {
    /// The left leg is links 1 and 2.
    Left,
    /// The right leg is links 1 and 2.
    Right,
}

impl Stance {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Indices of hip and knee of the standing leg, then of the other, among the robot's coordinates.
    const fn legs(self) -> [[usize; 2]; 2] {
        match self {
            Self::Left => [[3, 4], [5, 6]],
            Self::Right => [[5, 6], [3, 4]],
        }
    }
}

/// One number per coordinate of the robot: `hip_x`, `hip_z`, `trunk_pitch`, `left_hip`, `left_knee`, `right_hip`, `right_knee`;
/// positions, velocities or accelerations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrunkRooted(pub [f64; 7]);

impl TrunkRooted {
    /// The paper's `θ`: a thigh that stands is the one between knee and hip, a thigh that swings points the other way [rad].
    pub fn angles(&self, stance: Stance) -> Links {
        self.along_chain(stance, PI)
    }

    /// `θ̇` or `θ̈` of these velocities or accelerations.
    pub fn rates(&self, stance: Stance) -> Links {
        self.along_chain(stance, 0.0)
    }

    fn along_chain(&self, stance: Stance, half_turn: f64) -> Links {
        let (q, [[hip, knee], [other_hip, other_knee]]) = (&self.0, stance.legs());
        let (thigh, other) = (q[2] + q[hip], q[2] + q[other_hip]);
        Links::from([thigh + q[knee], thigh, q[2], other + half_turn, other + q[other_knee] + half_turn])
    }

    /// The robot's coordinates in the pose `θ` with the tip `b` at `foot`.
    pub fn from_angles(biped: &Biped, stance: Stance, theta: &Links, foot: &Planar) -> Self {
        let hip = biped.joint(2, &(*theta).into());
        Self::from_chain(stance, theta, [foot[0] + hip[0], foot[1] + hip[1]], PI)
    }

    /// The robot's velocities while the tip `b` rests.
    pub fn from_rates(biped: &Biped, stance: Stance, theta: &Links, rate: &Links) -> Self {
        let hip = biped.outputs(theta, rate).jacobian * rate;
        Self::from_chain(stance, rate, [hip[0], hip[1]], 0.0)
    }

    /// The robot's accelerations while the tip `b` rests.
    pub fn from_accelerations(
        biped: &Biped,
        stance: Stance,
        theta: &Links,
        rate: &Links,
        acceleration: &Links,
    ) -> Self {
        let outputs = biped.outputs(theta, rate);
        let hip = outputs.jacobian * acceleration + outputs.jacobian_rate * rate;
        Self::from_chain(stance, acceleration, [hip[0], hip[1]], 0.0)
    }

    fn from_chain(stance: Stance, x: &Links, hip: [f64; 2], half_turn: f64) -> Self {
        let [[at_hip, at_knee], [other_hip, other_knee]] = stance.legs();
        let mut q = [0.0; 7];
        (q[0], q[1], q[2]) = (hip[0], hip[1], x[2]);
        (q[at_hip], q[at_knee]) = (x[1] - x[2], x[0] - x[1]);
        (q[other_hip], q[other_knee]) = (x[3] - half_turn - x[2], x[4] - x[3]);
        Self(q)
    }

    /// The robot's joint torques from the paper's `T_q` (eq. 24), those of the standing leg against its joints' sense.
    /// The ankle's `τ_1` acts from outside and is no joint of the robot.
    pub fn from_joint_torques(stance: Stance, torque: &Links) -> Self {
        let [[hip, knee], [other_hip, other_knee]] = stance.legs();
        let mut tau = [0.0; 7];
        (tau[hip], tau[knee]) = (-torque[2], -torque[1]);
        (tau[other_hip], tau[other_knee]) = (torque[3], torque[4]);
        Self(tau)
    }

    /// The paper's `T_q` with an ankle torque `τ_1` on the standing tip.
    pub fn joint_torques(&self, stance: Stance, ankle: f64) -> Links {
        let (tau, [[hip, knee], [other_hip, other_knee]]) = (&self.0, stance.legs());
        Links::from([ankle, -tau[knee], -tau[hip], tau[other_hip], tau[other_knee]])
    }
}
