//! Reference gaits of planar bipeds: where hip, trunk and feet are to be at any time, and the joints that put them there.
//!
//! The world has x ahead and z up, rotations are about +y. Steps are counted from 0; in step `k` one foot stands at `x = k L`, the left one
//! where `k` is even, and the other one swings from `(k−1) L` to `(k+1) L`. A step begins with the lift-off of the swing foot. (Mu & Wu
//! 2003, Synthesis of a complete sagittal gait cycle for a five-link biped, Robotica 21, 581–587, for which quantities describe a gait.)

mod leg;
mod parameters;
mod path;
mod reach;

pub use leg::{Leg, LegAngles};
pub use parameters::{Gait, HipPath, LegLengths};

use crate::error::Error;
use crate::load::yaml::Keys;
use crate::reference::Point;
use std::ops::Sub;

/// A point of the sagittal plane with its velocity and acceleration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Planar {
    /// Ahead [m, m/s, m/s²].
    pub x: Point,
    /// Up [m, m/s, m/s²].
    pub z: Point,
}

impl Planar {
    /// A point of the ground, at rest.
    pub fn on_ground(x: f64) -> Self {
        Self { x: Point { q: x, ..Point::default() }, z: Point::default() }
    }

    fn ahead(self, by: f64) -> Self {
        Self { x: Point { q: self.x.q + by, ..self.x }, ..self }
    }
}

impl Sub for Planar {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        let minus = |a: Point, b: Point| Point { q: a.q - b.q, qd: a.qd - b.qd, qdd: a.qdd - b.qdd };
        Self { x: minus(self.x, other.x), z: minus(self.z, other.z) }
    }
}

/// How many feet are on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// One foot.
    Single,
    /// Both feet.
    Double,
}

/// One of the legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

/// What the parts of the biped are to do at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture {
    /// The step.
    pub step: i64,
    /// Its phase.
    pub phase: Phase,
    /// The hip.
    pub hip: Planar,
    /// How far the trunk leans forward [rad, rad/s, rad/s²].
    pub trunk: Point,
    /// The tip of the left leg.
    pub left: Planar,
    /// The tip of the right leg.
    pub right: Planar,
}

/// A gait that the legs can walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarGait {
    gait: Gait,
    height: f64,
}

impl PlanarGait {
    /// Names of the coordinates of [`PlanarGait::joints`]: hip and trunk in the world, then the legs.
    pub const COORDINATES: [&str; 7] =
        ["hip_x", "hip_z", "trunk_pitch", "left_hip", "left_knee", "right_hip", "right_knee"];

    /// Checks a gait.
    ///
    /// # Errors
    /// Names the parameter that cannot be, and what to do about it.
    pub fn new(gait: Gait) -> Result<Self, Error> {
        Self::of_file(gait, &Keys::default(), "")
    }

    /// Checks a gait from a file. `keys` are the places of the file's keys, and `at` is what comes before those of the gait, such as `gait.`.
    ///
    /// # Errors
    /// Names the parameter that cannot be, with its line, and what to do about it.
    pub fn of_file(gait: Gait, keys: &Keys, at: &str) -> Result<Self, Error> {
        gait.check(keys, at)?;
        Ok(Self { gait, height: Self::height(&gait, keys, at)? })
    }

    /// What describes it.
    pub fn parameters(&self) -> &Gait {
        &self.gait
    }

    /// Mean height of the hip [m].
    pub fn hip_height(&self) -> f64 {
        self.height
    }

    /// The leg that stands on one foot in a step.
    pub fn stance(step: i64) -> Side {
        if step.rem_euclid(2) == 0 { Side::Left } else { Side::Right }
    }

    /// The footprint of the leg that stands in a step [m].
    pub fn footprint(&self, step: i64) -> f64 {
        step as f64 * self.gait.step_length
    }

    /// Step and phase at time `t` [s], if feet lift off and touch down when they are to.
    pub fn phase(&self, t: f64) -> (i64, Phase) {
        let step = (t / self.gait.step_time()).floor();
        let single = t - step * self.gait.step_time() < self.gait.single_support();
        (step as i64, if single { Phase::Single } else { Phase::Double })
    }

    /// What is to be at time `t` [s].
    pub fn at(&self, t: f64) -> Posture {
        let (step, phase) = self.phase(t);
        self.during(step, phase, t)
    }

    /// What is to be at time `t` [s] in a phase that may last longer or end earlier than planned: on one foot, the swing foot goes on
    /// downwards with the touch-down speed.
    pub fn during(&self, step: i64, phase: Phase, t: f64) -> Posture {
        let (start, foothold) = (step as f64 * self.gait.step_time(), self.footprint(step));
        let hip = self.gait.hip(t - start, self.height).ahead(foothold);
        let stance = Planar::on_ground(foothold);
        let swing = match phase {
            Phase::Single => self.gait.swing(t - start).ahead(foothold),
            Phase::Double => Planar::on_ground(self.footprint(step + 1)),
        };
        let trunk = Point { q: self.gait.trunk_pitch, ..Point::default() };
        let (left, right) = match Self::stance(step) {
            Side::Left => (stance, swing),
            Side::Right => (swing, stance),
        };
        Posture { step, phase, hip, trunk, left, right }
    }

    /// The coordinates [`PlanarGait::COORDINATES`] of a posture, of this gait or with feet elsewhere; `None` if a leg is too short
    /// for it, which it never is at the times of [`PlanarGait::at`].
    pub fn joints(&self, posture: &Posture) -> Option<[Point; 7]> {
        let Posture { hip, trunk, left, right, .. } = *posture;
        let leg = self.gait.leg();
        let (l, r) = (leg.angles(hip, left, trunk)?, leg.angles(hip, right, trunk)?);
        Some([hip.x, hip.z, trunk, l.hip, l.knee, r.hip, r.knee])
    }
}
