//! One contact point: where it is held, and how.

use crate::robot::ContactPoint;
use crate::scenario::Ground;
use gyroflex::dynamics::{Anchor, Constraint, Contact, Directions, Frame, Hold};
use gyroflex::spatial::{Transform, Vec3};
use serde::Serialize;

/// What a contact point does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// It is off the ground.
    #[default]
    Open,
    /// The ground holds it.
    Stick,
    /// It slips on the ground.
    Slip,
}

impl Mode {
    /// Its number in logs: 0, 1, 2.
    pub fn number(self) -> f64 {
        f64::from(self as u8)
    }
}

/// Errors of contacts are drawn back this fast, critically damped [rad/s].
pub(crate) const STABILISATION: f64 = 100.0;
/// Below this speed the direction in which a point slips is the one in which it began to [m/s].
pub(super) const SLOW: f64 = 1e-6;

#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) name: String,
    pub(super) body: usize,
    pub(super) point: Vec3<f64>,
    pub(super) mode: Mode,
    /// Where it is held [m].
    anchor: Vec3<f64>,
    /// Unit direction in which it slips.
    pub(super) direction: Vec3<f64>,
    /// Whether it has moved in that direction: before, rounding may have it move back.
    moving: bool,
    /// Gap at which it last opened, zero or just below [m].
    pub(super) armed: f64,
}

impl Point {
    pub(super) fn new(contact: &ContactPoint) -> Self {
        Self {
            name: contact.name.clone(),
            body: contact.body,
            point: contact.point,
            mode: Mode::Open,
            anchor: Vec3::zero(),
            direction: Vec3::zero(),
            moving: false,
            armed: 0.0,
        }
    }

    /// In the world.
    pub(super) fn place(&self, poses: &[Transform<f64>]) -> Vec3<f64> {
        poses[self.body].point(self.point)
    }

    /// Held from now on where it is. It is on the ground but for rounding, which must not set feet of one body at odds.
    pub(super) fn close(&mut self, at: Vec3<f64>) {
        self.mode = Mode::Stick;
        self.anchor = at;
    }

    pub(super) fn slip(&mut self, direction: Vec3<f64>) {
        self.mode = Mode::Slip;
        self.direction = direction;
        self.moving = false;
    }

    /// Takes notice of a velocity along the ground at the end of a step while it slips [m/s].
    pub(super) fn heed(&mut self, velocity: Vec3<f64>) {
        if velocity.dot(self.direction) > 0.0 {
            self.moving = true;
            let speed = velocity.norm();
            if speed > SLOW {
                self.direction = velocity.scale(1.0 / speed);
            }
        }
    }

    /// Whether it has turned back while it slips with `velocity` [m/s].
    pub(super) fn turned(&self, velocity: Vec3<f64>) -> bool {
        velocity.dot(self.direction) < if self.moving { 0.0 } else { -SLOW }
    }

    /// Force along the ground for every newton of normal force while it slips with `velocity` [m/s].
    pub(super) fn ratio(&self, velocity: Vec3<f64>, friction: f64) -> Vec3<f64> {
        let speed = velocity.norm();
        // Behind a point of rest friction goes on as before it: where the velocity passes through zero is then seen at the end of the step.
        let ahead = speed > SLOW && velocity.dot(self.direction) > 0.0;
        let direction = if ahead { velocity.scale(1.0 / speed) } else { self.direction };
        direction.scale(-friction)
    }

    pub(super) fn constraint(&self, ground: &Ground) -> Constraint<f64> {
        let placement = Transform { pos: self.point, ..Transform::identity() };
        let anchor = Anchor { body: None, placement: Transform { pos: self.anchor, ..Transform::identity() } };
        let directions = if ground.planar { Directions::PLANAR_POINT } else { Directions::POINT };
        let hold = Hold::Frame { frame: Frame { body: self.body, placement }, anchor, directions };
        let slip = (self.mode == Mode::Slip).then(|| self.direction.scale(-ground.friction));
        let contact = Some(Contact { normal: 5, restitution: 0.0, slip });
        Constraint { hold, stabilisation: STABILISATION, contact }
    }
}
