//! The articulated-body algorithm's record of one body.

use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Force, Motion, Turn, Vec3};

/// What [`aba`](super::aba) keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct AbaScratch<T> {
    /// Sine and cosine of the joint's angle.
    pub(super) theta: Turn<T>,
    /// `ω`, of a body that others than the next refer to.
    pub(super) omega: Vec3<T>,
    /// `c`: acceleration due to velocities alone.
    pub(super) c: Motion<T>,
    /// `pᴬ`.
    pub(super) p: Force<T>,
    /// `U = Iᴬ S`.
    pub(super) u_cap: Force<T>,
    /// `1 / d`, `d` the joint's apparent inertia.
    pub(super) d_inv: T,
    /// Generalised force at the joint that is left to accelerate it.
    pub(super) u: T,
    /// Net reflected torque on the joint's elastic rotor.
    pub(super) on_rotor: T,
    /// Couple of the joint's rotor on its carrier.
    pub(super) couple: Vec3<T>,
    /// `Iᴬ` so far, of a body that others than the next hang on.
    pub(super) ia: ArticulatedInertia<T>,
    /// Acceleration, gravity included, of a body that others than the next refer to.
    pub(super) a: Motion<T>,
}

impl<T: Scalar> AbaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            theta: Turn::none(),
            omega: Vec3::zero(),
            c: Motion::zero(),
            p: Force::zero(),
            u_cap: Force::zero(),
            d_inv: T::zero(),
            u: T::zero(),
            on_rotor: T::zero(),
            couple: Vec3::zero(),
            ia: ArticulatedInertia::zero(),
            a: Motion::zero(),
        }
    }
}

impl<T: Scalar> Default for AbaScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}
