//! What the articulated-body algorithm says of the base and of a body's velocity.

use super::External;
use super::tree::{RootMotion, Tree, first};
use crate::Scalar;
use crate::dispatch::Over;
use crate::spatial::{ArticulatedInertia, Force, Motion, SpatialInertia, Vec3};

/// The base: at rest, or a root moving freely.
pub(super) struct Base<F> {
    /// `ω`.
    pub(super) omega: Vec3<F>,
    /// `pᴬ`.
    pub(super) p: Force<F>,
    /// `Iᴬ`.
    pub(super) ia: ArticulatedInertia<F>,
    /// The root's coordinates, if it moves.
    free: Option<RootMotion<F>>,
}

impl<F: Scalar> Base<F> {
    #[inline(always)]
    pub(super) fn of<T: Scalar>(tree: &Tree<'_, T::Param>, q: &[T], qd: &[T], ext: &External<T>) -> Self
    where
        F: Over<T>,
    {
        let Some(root) = tree.root else {
            return Self { omega: Vec3::zero(), p: Force::zero(), ia: ArticulatedInertia::zero(), free: None };
        };
        let at = RootMotion::of(q, qd);
        let inertia = root.inertia.map(F::from_param);
        let mut p = velocity_force(inertia, at.v.ang);
        if let Some(wrench) = ext.wrenches.first() {
            p -= root.frame.map(F::from_param).inv_force(wrench.map(F::load));
        }
        Self { omega: at.v.ang, p, ia: inertia.into(), free: Some(at) }
    }

    /// Acceleration of the base as a point in space, `lift` being that against gravity, under the wrench `tau` on a root that
    /// moves; and what of it is the root's spatial acceleration, if it moves.
    #[inline(always)]
    pub(super) fn acceleration<T: Scalar>(
        &self,
        lift: Vec3<F>,
        tau: &[T],
        ext: &External<T>,
    ) -> (Motion<F>, Option<Motion<F>>)
    where
        F: Over<T>,
    {
        let Some(at) = &self.free else { return (Motion { ang: Vec3::zero(), lin: lift }, None) };
        // a = Iᴬ⁻¹ (τ − pᴬ);   as spatial acceleration, without gravity: q̈ = a − [0; E a_0 + ω × v]
        let wrench = Force::from(first::<T, F, 6>(tau)) + Force::from(first::<T, F, 6>(ext.tau));
        let a = self.ia.solve(wrench - self.p);
        (a, Some(Motion { ang: a.ang, lin: a.lin - at.rot * lift - at.v.ang.cross(at.v.lin) }))
    }
}

/// `ω × (ω × r)`.
#[inline(always)]
pub(super) fn centripetal<T: Scalar>(omega: Vec3<T>, r: Vec3<T>) -> Vec3<T> {
    omega.scale(omega.dot(r)).plus_scaled(-omega.dot(omega), r)
}

/// Force that a body needs for its angular velocity alone: `[ω × I ω; ω × (ω × h)]`.
#[inline(always)]
pub(super) fn velocity_force<T: Scalar>(body: SpatialInertia<T>, omega: Vec3<T>) -> Force<T> {
    Force { ang: omega.cross(body.rotational * omega), lin: centripetal(omega, body.first_moment) }
}
