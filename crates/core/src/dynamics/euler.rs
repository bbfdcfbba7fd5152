//! Orientation as three angles, and their rates: `ω = T(φ) φ̇` (Siciliano et al., *Robotics*, §3.6).

use crate::Scalar;
use crate::spatial::{Mat3, Vec3};

/// The coordinates in which the rotation of a frame counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rotation {
    /// Angular velocity in world axes, as in the geometric Jacobian.
    Geometric,
    /// Rates of roll, pitch and yaw, about the world's x, y and z in this order, as URDF has them; singular at a pitch of ±90°.
    RollPitchYaw,
    /// Rates of the angles about z, the new y and the new z; singular where the second is zero or 180°.
    Zyz,
}

/// Three turns one after the other: about z, about the horizontal axis `b` and about `e`. `ω = z ȧ + b ḃ + e ċ`.
pub(super) struct Angles<T> {
    rotation: Rotation,
    b: Vec3<T>,
    e: Vec3<T>,
    /// What a rate of the third costs: `1 / |e × z|`, zero where the first and the third axis coincide.
    third: T,
    /// Smallest singular value of `T`.
    pub(super) smallest: T,
}

impl<T: Scalar> Angles<T> {
    /// Of a frame with the given rotation to world axes; `None` for the geometric rates.
    pub(super) fn of(rotation: Rotation, r: Mat3<T>, threshold: T) -> Option<Self> {
        let column = |c: usize| r.rows.map(|row| row.to_array()[c]);
        // e is the frame's x-axis before the roll, its z-axis before the last turn.
        let e = match rotation {
            Rotation::Geometric => return None,
            Rotation::RollPitchYaw => column(0),
            Rotation::Zyz => column(2),
        };
        let (sin, cos) = e[1].atan2(e[0]).sin_cos();
        let level = (e[0] * e[0] + e[1] * e[1]).sqrt();
        let safe = level.select_less(threshold, T::one(), level);
        let third = level.select_less(threshold, T::zero(), T::one() / safe);
        // Squares of the singular values are 1 ± |e·z| and 1, and 1 − |e·z| = |e × z|² / (1 + |e·z|)
        let height = (e[2] * e[2]).sqrt();
        let smallest = level / (T::one() + height).sqrt();
        Some(Self { rotation, b: Vec3::new(-sin, cos, T::zero()), e: e.into(), third, smallest })
    }

    /// `T⁻¹ ω`, in the order of the coordinates.
    pub(super) fn rates(&self, omega: Vec3<T>) -> Vec3<T> {
        let [a, b, c] = self.turns(omega);
        match self.rotation {
            Rotation::Zyz => Vec3::new(a, b, c),
            _ => Vec3::new(c, b, a),
        }
    }

    /// `Ṫ φ̇` at the angular velocity `omega`.
    pub(super) fn turning(&self, omega: Vec3<T>) -> Vec3<T> {
        let [a, b, c] = self.turns(omega);
        let first = Vec3::z_axis().scale(a);
        first.cross(self.b).scale(b) + (first + self.b.scale(b)).cross(self.e).scale(c)
    }

    fn turns(&self, omega: Vec3<T>) -> [T; 3] {
        // b = (−sin, cos, 0): its level normal (cos, sin, 0) sees only the third turn.
        let c = (self.b.y * omega.x - self.b.x * omega.y) * self.third;
        [omega.z - self.e.z * c, self.b.dot(omega), c]
    }
}
