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

/// Accelerations in a turning body: `Ω = α× + ω ω× `, so that the point at `r` accelerates by `Ω r` more than the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct AccelerationField<T> {
    rows: Mat3<T>,
    /// `ω_y² − ω_z²`, `ω_z² − ω_x²`, `ω_x² − ω_y²`
    squares: Vec3<T>,
    /// `ω_y ω_z`, `ω_z ω_x`, `ω_x ω_y`
    products: Vec3<T>,
}

impl<T: Scalar> Moving<T> {
    #[inline(always)]
    pub(super) fn new(omega: Vec3<T>, accel: Motion<T>) -> Self {
        Self { omega, accel }
    }

    #[inline(always)]
    pub(super) fn field(&self) -> AccelerationField<T> {
        let (w, a) = (self.omega, self.accel.ang);
        let (xx, yy, zz) = (w.x * w.x, w.y * w.y, w.z * w.z);
        let (yz, zx, xy) = (w.y * w.z, w.z * w.x, w.x * w.y);
        AccelerationField {
            rows: Mat3::from_rows(
                Vec3::new(-(yy + zz), xy - a.z, zx + a.y),
                Vec3::new(xy + a.z, -(zz + xx), yz - a.x),
                Vec3::new(zx - a.y, yz + a.x, -(xx + yy)),
            ),
            squares: Vec3::new(yy - zz, zz - xx, xx - yy),
            products: Vec3::new(yz, zx, xy),
        }
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
    pub(super) fn at(self, field: &AccelerationField<T>, r: Vec3<T>) -> Self {
        Self::new(self.omega, Motion { ang: self.accel.ang, lin: self.accel.lin + field.rows * r })
    }

    /// The body across a joint of velocity `qd` and acceleration `qdd` that sits where `self` is said.
    #[inline(always)]
    pub(super) fn across(self, x: &JointTransform<T>, joint: JointKind, qd: T, qdd: T) -> Self {
        // ω = E ω_p,   α = E α_p,   a = E a_p, and what the joint adds:
        let (omega, ang, lin) = (x.rotate(self.omega), x.rotate(self.accel.ang), x.rotate(self.accel.lin));
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
    pub(super) fn force_on(&self, field: &AccelerationField<T>, body: SpatialInertia<T>) -> Force<T> {
        // f = m a + Ω h,   n = I α + ω × I ω + h × a, the first two by entries of Ω
        let (h, i, a) = (body.first_moment, body.rotational, self.accel);
        let (o, squares, products) = (field.rows.rows, field.squares, field.products);
        let n = Vec3::new(
            i.xx.mul_add(a.ang.x, (-i.xy).mul_add(o[2].x, i.xz * o[1].x)),
            i.yy.mul_add(a.ang.y, (-i.yz).mul_add(o[0].y, i.xy * o[2].y)),
            i.zz.mul_add(a.ang.z, (-i.xz).mul_add(o[1].z, i.yz * o[0].z)),
        );
        let gyro = Vec3::new(
            i.yz.mul_add(squares.x, (i.zz - i.yy) * products.x),
            i.xz.mul_add(squares.y, (i.xx - i.zz) * products.y),
            i.xy.mul_add(squares.z, (i.yy - i.xx) * products.z),
        );
        Force { ang: h.cross_plus(a.lin, n + gyro), lin: (field.rows * h).plus_scaled(body.mass, a.lin) }
    }
}
