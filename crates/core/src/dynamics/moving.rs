//! The motion that inverse dynamics carries from body to body.

use crate::Scalar;
use crate::model::JointKind;
use crate::spatial::{Force, JointTransform, Mat3, Motion, SpatialInertia, Turn, Vec3};

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

    /// `Ω = α× + ω× ω×`: the point at `r` accelerates by `Ω r` more than the origin.
    #[inline(always)]
    pub(super) fn field(&self) -> Mat3<T> {
        let (w, a) = (self.omega, self.accel.ang);
        let (xx, yy, zz) = (w.x * w.x, w.y * w.y, w.z * w.z);
        let (yz, zx, xy) = (w.y * w.z, w.z * w.x, w.x * w.y);
        Mat3::from_rows(
            Vec3::new(-(yy + zz), xy - a.z, zx + a.y),
            Vec3::new(xy + a.z, -(zz + xx), yz - a.x),
            Vec3::new(zx - a.y, yz + a.x, -(xx + yy)),
        )
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

    /// The same at the point `r`: `a + Ω r`.
    #[inline(always)]
    pub(super) fn at(self, field: Mat3<T>, r: Vec3<T>) -> Self {
        Self::new(self.omega, Motion { ang: self.accel.ang, lin: self.accel.lin + field * r })
    }

    /// The body across a joint of velocity `qd` and acceleration `qdd` that sits where `self` is said.
    #[inline(always)]
    pub(super) fn across(self, x: &JointTransform<T>, joint: JointKind, qd: T, qdd: T) -> Self {
        // ω = E ω_p,   α = E α_p,   a = E a_p, and what the joint adds
        let (omega, ang, lin) = (x.rotate(self.omega), x.rotate(self.accel.ang), x.rotate(self.accel.lin));
        Self::new(omega, Motion { ang, lin }).driven(joint, qd, qdd)
    }

    /// With what a joint about or along z adds, `self` being said in the axes beyond it.
    #[inline(always)]
    pub(super) fn driven(self, joint: JointKind, qd: T, qdd: T) -> Self {
        let Self { omega, accel: Motion { ang, lin } } = self;
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

    /// Force about its origin that a body of this inertia needs; `o` is [`Moving::field`].
    #[inline(always)]
    pub(super) fn force_on(&self, o: Mat3<T>, body: &SpatialInertia<T::Param>) -> Force<T> {
        // f = m a + Ω h
        let (h, a) = (body.first_moment.map(T::from_param), self.accel.lin);
        let lin = (o * h).plus_scaled(T::from_param(body.mass), a);
        // n = I α + ω × I ω + h × a, whose first part is that of Ω Σ − (Ω Σ)ᵀ about each axis, where Σ = ½ tr(I) 1 − I
        let i = body.rotational;
        let half = (i.xx + i.yy + i.zz) * Scalar::from_f64(0.5);
        let sigma = Vec3::new(half - i.xx, half - i.yy, half - i.zz).map(T::from_param);
        let (i, [x, y, z]) = (i.map(T::from_param), o.rows);
        let n = Vec3::new(
            sigma.y.mul_add(z.y, (-sigma.z).mul_add(y.z, i.yz * (y.y - z.z))),
            sigma.z.mul_add(x.z, (-sigma.x).mul_add(z.x, i.xz * (z.z - x.x))),
            sigma.x.mul_add(y.x, (-sigma.y).mul_add(x.y, i.xy * (x.x - y.y))),
        );
        let n = Vec3::new(
            i.xz.mul_add(y.x, (-i.xy).mul_add(z.x, n.x)),
            i.xy.mul_add(z.y, (-i.yz).mul_add(x.y, n.y)),
            i.yz.mul_add(x.z, (-i.xz).mul_add(y.z, n.z)),
        );
        Force { ang: h.cross_plus(a, n), lin }
    }
}
