//! Where the arm should be.

use crate::arm::N;

/// There and back between two poses, at rest at both, each way a polynomial of fifth degree in time.
#[derive(Clone, Debug)]
pub struct Reference {
    from: [f32; N],
    to: [f32; N],
    /// Duration of one way [s].
    duration: f32,
}

/// Position, velocity and acceleration asked for.
#[derive(Clone, Debug)]
pub struct Target {
    pub q: [f32; N],
    pub qd: [f32; N],
    pub qdd: [f32; N],
}

impl Reference {
    pub const fn new(from: [f32; N], to: [f32; N], duration: f32) -> Self {
        Self { from, to, duration }
    }

    /// `way` [s] after the arm left one pose, for the other if `back`.
    pub fn at(&self, way: f32, back: bool) -> Target {
        let (from, to) = if back { (&self.to, &self.from) } else { (&self.from, &self.to) };
        let x = (way / self.duration).clamp(0.0, 1.0);
        // s = 10 x³ − 15 x⁴ + 6 x⁵ and its derivatives in time
        let s = x * x * x * (10.0 + x * (6.0 * x - 15.0));
        let sd = 30.0 * x * x * (1.0 + x * (x - 2.0)) / self.duration;
        let sdd = 60.0 * x * (1.0 + x * (2.0 * x - 3.0)) / (self.duration * self.duration);
        let path: [f32; N] = core::array::from_fn(|i| to[i] - from[i]);
        Target {
            q: core::array::from_fn(|i| from[i] + s * path[i]),
            qd: path.map(|p| sd * p),
            qdd: path.map(|p| sdd * p),
        }
    }
}
