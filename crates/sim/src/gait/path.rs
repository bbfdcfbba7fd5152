//! The paths of hip and swing foot within a step.

use super::{Gait, Planar};
use crate::reference::Point;
use std::f64::consts::TAU;

/// What share of the way is behind the swing foot: velocity and acceleration vanish at both ends, and the peak velocity is 1.56 times the
/// mean. Its derivative is `20 u²(1−u)² (3 − 7u(1−u)) ≥ 0`. The quintic with the same ends has a peak of 1.875, leaves later and arrives
/// earlier, for which legs would have to be longer.
const WAY: [f64; 8] = [0.0, 0.0, 0.0, 20.0, -65.0, 96.0, -70.0, 20.0];
/// `64 u³(1−u)³`: up to one and down again, at rest at both ends.
const LIFT: [f64; 7] = [0.0, 0.0, 0.0, 64.0, -192.0, 192.0, -64.0];
/// `u³(1−u)(4−3u)`: arrives at zero with the slope −1 and without acceleration.
const LANDING: [f64; 6] = [0.0, 0.0, 0.0, 4.0, -7.0, 3.0];
/// `LANDING` at the middle.
pub(super) const LANDING_AT_MIDDLE: f64 = 5.0 / 32.0;

/// A polynomial of `u = t/duration` with its derivatives with respect to `t`.
fn polynomial(coefficients: &[f64], u: f64, duration: f64) -> Point {
    let [mut q, mut qd, mut half_qdd] = [0.0; 3];
    for c in coefficients.iter().rev() {
        half_qdd = half_qdd * u + qd;
        qd = qd * u + q;
        q = q * u + c;
    }
    Point { q, qd: qd / duration, qdd: 2.0 * half_qdd / (duration * duration) }
}

impl Gait {
    /// Time of a step, from one lift-off to the next [s].
    pub fn step_time(&self) -> f64 {
        self.step_length / self.speed
    }

    /// Time on one foot [s].
    pub fn single_support(&self) -> f64 {
        self.step_time() - self.double_support
    }

    /// The hip a time `t` [s] after a lift-off from which on a foot stands at the origin: a uniform motion and one harmonic of the step in each
    /// direction, so that all derivatives are continuous for ever. `height` is the mean one [m].
    pub(super) fn hip(&self, t: f64, height: f64) -> Planar {
        let omega = TAU / self.step_time();
        let from_middle = t - 0.5 * self.single_support();
        let (sin, cos) = (omega * from_middle).sin_cos();
        let path = &self.hip;
        Planar {
            x: Point {
                q: self.speed * from_middle + path.lead - path.surge * sin,
                qd: self.speed - path.surge * omega * cos,
                qdd: path.surge * omega * omega * sin,
            },
            z: Point {
                q: height + path.rise * cos,
                qd: -path.rise * omega * sin,
                qdd: -path.rise * omega * omega * cos,
            },
        }
    }

    /// The swing foot a time `t` [s] after lift-off, with the other foot at the origin. After the time on one foot it goes on downwards
    /// with the touch-down speed.
    pub(super) fn swing(&self, t: f64) -> Planar {
        let (duration, speed) = (self.single_support(), self.touchdown_speed);
        if t >= duration {
            return Planar {
                x: Point { q: self.step_length, qd: 0.0, qdd: 0.0 },
                z: Point { q: -speed * (t - duration), qd: -speed, qdd: 0.0 },
            };
        }
        let u = t / duration;
        let [way, lift, landing] = [&WAY[..], &LIFT, &LANDING].map(|c| polynomial(c, u, duration));
        let fall = speed * duration;
        let rise = self.clearance - fall * LANDING_AT_MIDDLE;
        let mix = |a: f64, b: f64| rise * a + fall * b;
        Planar {
            x: Point {
                q: self.step_length * (2.0 * way.q - 1.0),
                qd: 2.0 * self.step_length * way.qd,
                qdd: 2.0 * self.step_length * way.qdd,
            },
            z: Point { q: mix(lift.q, landing.q), qd: mix(lift.qd, landing.qd), qdd: mix(lift.qdd, landing.qdd) },
        }
    }
}
