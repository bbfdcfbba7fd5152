//! Frames in any number type: only where they are, never how they move.

use super::lagrange::Pair;
use gyroflex::Scalar;
use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};

/// Axes and origin of a frame, in world axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose<T> {
    pub(super) axes: [Vec3<T>; 3],
    pub(super) origin: Vec3<T>,
}

impl<T: Scalar> Pose<T> {
    pub(super) fn world() -> Self {
        let (o, i) = (T::zero(), T::one());
        Self { axes: [Vec3::new(i, o, o), Vec3::new(o, i, o), Vec3::new(o, o, i)], origin: Vec3::zero() }
    }

    /// A vector given in this frame, in world axes.
    pub(super) fn out(&self, v: Vec3<T>) -> Vec3<T> {
        self.axes[0] * v.x + self.axes[1] * v.y + self.axes[2] * v.z
    }

    /// A point given in this frame, in the world.
    pub(super) fn point(&self, p: Vec3<T>) -> Vec3<T> {
        self.origin + self.out(p)
    }

    /// A frame whose axes and origin are given in this one.
    fn frame(&self, axes: [Vec3<T>; 3], origin: Vec3<T>) -> Self {
        Self { axes: axes.map(|a| self.out(a)), origin: self.point(origin) }
    }

    /// Placed in this frame the URDF way; the core stores the transposed rotation, whose rows are the axes.
    pub(super) fn placed(&self, at: &Transform<f64>) -> Self {
        self.frame(at.rot.rows.map(number), number(at.pos))
    }

    /// Turned about a unit axis of this frame (Rodrigues).
    pub(super) fn turned(&self, axis: Vec3<f64>, angle: T) -> Self {
        let n = number(axis);
        let (sin, cos) = angle.sin_cos();
        let turn = |a: Vec3<T>| a * cos + n.cross(a) * sin + n * (n.dot(a) * (T::one() - cos));
        self.frame(Self::world().axes.map(turn), Vec3::zero())
    }

    /// Shifted along an axis of this frame.
    pub(super) fn slid(&self, axis: Vec3<f64>, by: T) -> Self {
        Self { origin: self.point(number(axis) * by), ..*self }
    }

    /// At the pose `x y z qx qy qz qw` in this frame.
    pub(super) fn flying(&self, q: &[T]) -> Self {
        let (u, w) = (Vec3::new(q[3], q[4], q[5]), q[6]);
        let twice = T::from_f64(2.0) / (u.dot(u) + w * w);
        let turn = |v: Vec3<T>| {
            let side = u.cross(v);
            v + (side * w + u.cross(side)) * twice
        };
        self.frame(Self::world().axes.map(turn), Vec3::new(q[0], q[1], q[2]))
    }

    /// Moved along as if fixed to a cross-section that rests at `s`, moves by `u` and turns by the Cayley rotation of `theta`,
    /// `R = 1 + κ (θ~ + ½ θ~²)`, `κ = 4/(4 + |θ|²)`: the point at `p` goes to `s + u + R (p − s)`.
    pub(super) fn bent(&self, s: Vec3<f64>, u: Vec3<T>, theta: Vec3<T>) -> Self {
        let (four, half) = (T::from_f64(4.0), T::from_f64(0.5));
        let kappa = four / (four + theta.dot(theta));
        let turn = |v: Vec3<T>| v + (theta.cross(v) + theta.cross(theta.cross(v)) * half) * kappa;
        let s = number(s);
        self.frame(Self::world().axes.map(turn), s + u - turn(s))
    }

    /// The same turned by `1 + θ~` instead, which leaves the axes at right angles to first order only (Cetinkunt & Book, eq. 9).
    pub(super) fn bent_linearly(&self, s: Vec3<f64>, u: Vec3<T>, theta: Vec3<T>) -> Self {
        self.frame(Self::world().axes.map(|a| a + theta.cross(a)), number(s) + u)
    }

    /// `½ ∫ |v|² dm` over a rigid body in this frame, `v = ṗ + Σ r_k ȧ_k` by origin and axes. No angular velocity is needed:
    /// `∫ r_k r_l dm = ½ tr(I) δ_kl − I_kl`.
    pub(super) fn rigid(&self, body: &SpatialInertia<f64>) -> impl Iterator<Item = Pair<T>> + use<T> {
        let (i, p, a) = (body.rotational, self.origin, self.axes);
        let half = 0.5 * (i.xx + i.yy + i.zz);
        [
            Pair { weight: 0.5 * body.mass, a: p, b: p },
            Pair { weight: 1.0, a: p, b: self.out(number(body.first_moment)) },
            Pair { weight: 0.5 * (half - i.xx), a: a[0], b: a[0] },
            Pair { weight: 0.5 * (half - i.yy), a: a[1], b: a[1] },
            Pair { weight: 0.5 * (half - i.zz), a: a[2], b: a[2] },
            Pair { weight: -i.xy, a: a[0], b: a[1] },
            Pair { weight: -i.xz, a: a[0], b: a[2] },
            Pair { weight: -i.yz, a: a[1], b: a[2] },
        ]
        .into_iter()
    }

    /// `m c` of a rigid body in this frame, in the world.
    pub(super) fn moment(&self, body: &SpatialInertia<f64>) -> Vec3<T> {
        self.origin * T::from_f64(body.mass) + self.out(number(body.first_moment))
    }
}

/// A vector of the description in the number type.
pub(super) fn number<T: Scalar>(v: Vec3<f64>) -> Vec3<T> {
    v.map(T::from_f64)
}

/// Of a body symmetric about the unit axis `n`: `J` about it, `J_t` across it.
pub(super) fn symmetric_about(n: Vec3<f64>, along: f64, across: f64) -> SymMat3<f64> {
    SymMat3::diagonal(across, across, across) + SymMat3::outer(n).scale(along - across)
}
