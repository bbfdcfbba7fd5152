//! A leg of two links in the sagittal plane: which angles bring the foot where it is to be.

use super::Planar;
use crate::reference::Point;

/// A leg whose thigh and shank hang straight down from the hip where hip and knee are at zero. Rotations are about +y, with x ahead and z
/// up: a positive hip takes the knee back, a positive knee bends it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Length of the thigh [m].
    pub thigh: f64,
    /// Length of the shank [m].
    pub shank: f64,
}

/// Hip and knee of a leg with their derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegAngles {
    /// Of the thigh about the trunk [rad, rad/s, rad/s²].
    pub hip: Point,
    /// Of the shank about the thigh, positive where the knee is bent [rad, rad/s, rad/s²].
    pub knee: Point,
}

impl Leg {
    /// Longest and shortest distance from hip to foot [m].
    pub fn reach(&self) -> [f64; 2] {
        [(self.thigh - self.shank).abs(), self.thigh + self.shank]
    }

    /// The angles, with their exact velocities and accelerations, that put the foot at `foot` while the hip is at `hip` and the trunk leans
    /// forward by `trunk` [rad, rad/s, rad/s²]. `None` unless the distance between them is strictly within [`Leg::reach`]: a straight
    /// knee has no velocity that would let the foot go on as it is asked to.
    pub fn angles(&self, hip: Planar, foot: Planar, trunk: Point) -> Option<LegAngles> {
        let (a, b) = (self.thigh, self.shank);
        let d = foot - hip;
        let [x, z] = [d.x.q, d.z.q];
        let square = x * x + z * z;
        // tan²(k/2), without the cancellation of a cosine near a straight knee.
        let half = ((a + b).powi(2) - square) / (square - (a - b).powi(2));
        if !(half > 0.0 && half.is_finite()) {
            return None;
        }
        let knee = 2.0 * half.sqrt().atan();
        // Angles from straight down, positive backward as all rotations about +y.
        let thigh = (-x).atan2(-z) - (b * knee.sin()).atan2(a + b * knee.cos());
        let shank = thigh + knee;
        // d = Σ l (−sin β, −cos β), so that ḋ = Σ l (−cos β, sin β) β̇.
        let ([s1, c1], [s2, c2]) = ([thigh.sin(), thigh.cos()], [shank.sin(), shank.cos()]);
        let determinant = -knee.sin();
        let rates = |x: f64, z: f64| [(s2 * x + c2 * z) / (a * determinant), -(s1 * x + c1 * z) / (b * determinant)];
        let [w1, w2] = rates(d.x.qd, d.z.qd);
        let towards_hip = [a * w1 * w1, b * w2 * w2];
        let [dw1, dw2] = rates(
            d.x.qdd - towards_hip[0] * s1 - towards_hip[1] * s2,
            d.z.qdd - towards_hip[0] * c1 - towards_hip[1] * c2,
        );
        Some(LegAngles {
            hip: Point { q: thigh - trunk.q, qd: w1 - trunk.qd, qdd: dw1 - trunk.qdd },
            knee: Point { q: knee, qd: w2 - w1, qdd: dw2 - dw1 },
        })
    }
}
