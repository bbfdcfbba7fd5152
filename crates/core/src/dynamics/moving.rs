//! The motion that inverse dynamics carries from body to body.

use crate::Scalar;
use crate::model::JointKind;
use crate::spatial::{Force, JointTransform, Motion, SpatialInertia, Turn, Vec3};

/// How a body turns, and how its origin accelerates as a point in space (the classical acceleration), gravity taken for an
/// acceleration upwards; all in the body's axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving<T> {
    /// `ω` [rad/s].
    pub(super) omega: Vec3<T>,
    /// `α` [rad/s²] and `a` [m/s²].
    pub(super) accel: Motion<T>,
}

impl<T: Scalar> Moving<T> {
    #[inline(always)]
    pub(super) fn new(omega: Vec3<T>, accel: Motion<T>) -> Self {
        Self { omega, accel }
    }

    /// `base + α × r + ω × (ω × r)`
    #[inline(always)]
    fn field(&self, r: Vec3<T>, base: Vec3<T>) -> Vec3<T> {
        let w = self.omega;
        self.accel.ang.cross_plus(r, base).plus_scaled(w.dot(r), w).plus_scaled(-w.dot(w), r)
    }

    #[inline(always)]
    pub(super) fn map<U>(self, mut f: impl FnMut(T) -> U) -> Moving<U> {
        Moving { omega: self.omega.map(&mut f), accel: self.accel.map(&mut f) }
    }

    #[inline(always)]
    pub(super) fn at_rest() -> Self {
        Self { omega: Vec3::zero(), accel: Motion::zero() }
    }

    /// The same in axes turned about z.
    #[inline(always)]
    pub(super) fn turned(self, turn: Turn<T>) -> Self {
        Self { omega: turn.z(self.omega), accel: turn.z_motion(self.accel) }
    }

    /// The body across a joint of velocity `qd` and acceleration `qdd`.
    #[inline(always)]
    pub(super) fn across(self, x: &JointTransform<T>, joint: JointKind, qd: T, qdd: T) -> Self {
        // ω = E ω_p,   α = E α_p,   a = E (a_p + α_p × r + ω_p × (ω_p × r)), and what the joint adds:
        let (omega, ang) = (x.rotate(self.omega), x.rotate(self.accel.ang));
        let lin = x.rotate(self.field(x.offset, self.accel.lin));
        match joint {
            // a += z q̈ + 2 ω × z q̇
            JointKind::Prismatic => {
                let twice = qd + qd;
                let lin = Vec3::new(omega.y.mul_add(twice, lin.x), (-omega.x).mul_add(twice, lin.y), lin.z + qdd);
                Self::new(omega, Motion { ang, lin })
            }
            // ω += z q̇,   α += z q̈ + ω × z q̇
            _ => {
                let ang = Vec3::new(omega.y.mul_add(qd, ang.x), (-omega.x).mul_add(qd, ang.y), ang.z + qdd);
                Self::new(Vec3::new(omega.x, omega.y, omega.z + qd), Motion { ang, lin })
            }
        }
    }

    /// Force about its origin that a body of this inertia needs.
    #[inline(always)]
    pub(super) fn force_on(&self, body: SpatialInertia<T>) -> Force<T> {
        // f = m a + α × h + ω × (ω × h),   n = I α + ω × I ω + h × a
        let (h, i, a) = (body.first_moment, body.rotational, self.accel);
        Force {
            ang: h.cross_plus(a.lin, self.omega.cross_plus(i * self.omega, i * a.ang)),
            lin: self.field(h, a.lin.scale(body.mass)),
        }
    }
}
