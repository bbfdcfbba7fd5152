//! What the algorithms of flexible links keep during a call, and how much of it.

use crate::Scalar;
use crate::model::{FlexibleModel, SizeError};
use crate::spatial::{ArticulatedInertia, Force, Mat3, Motion, SpatialInertia, Transform, Turn, Vec3};

/// Storage of the caller for one call. Its content means nothing before and after.
#[derive(Debug)]
pub struct FlexibleScratch<'a, T> {
    /// One record per body.
    pub bodies: &'a mut [FlexibleBody<T>],
    /// One record per station.
    pub stations: &'a mut [FlexibleStation<T>],
    /// One record per mode.
    pub modes: &'a mut [FlexibleMode<T>],
    /// One motion per mode and station, [`flexible_shapes_len`] in all.
    pub shapes: &'a mut [Motion<T>],
    /// [`flexible_matrix_len`] numbers.
    pub matrix: &'a mut [T],
}

/// How many motions the shapes at all stations take.
pub fn flexible_shapes_len<T: Scalar>(model: &FlexibleModel<T>) -> usize {
    model.shapes.len()
}

/// How many numbers the modal inertia matrices of all links take.
pub fn flexible_matrix_len<T: Scalar>(model: &FlexibleModel<T>) -> usize {
    model.pairs.len()
}

impl<T: Scalar> FlexibleScratch<'_, T> {
    pub(super) fn check<P: Scalar>(&self, model: &FlexibleModel<P>) -> Result<(), SizeError> {
        SizeError::check("scratch.bodies", self.bodies.len(), model.rigid.bodies.len())?;
        SizeError::check("scratch.stations", self.stations.len(), model.stations.len())?;
        SizeError::check("scratch.modes", self.modes.len(), model.modes.len())?;
        SizeError::check("scratch.shapes", self.shapes.len(), model.shapes.len())?;
        SizeError::check("scratch.matrix", self.matrix.len(), model.pairs.len())
    }
}

/// What is kept for one body.
#[derive(Clone, Copy, Debug)]
pub struct FlexibleBody<T> {
    /// Sine and cosine of the joint's angle.
    pub(super) theta: Turn<T>,
    /// `ω`.
    pub(super) omega: Vec3<T>,
    /// `c`: acceleration across the joint due to velocities alone.
    pub(super) c: Motion<T>,
    /// Inertia of the link at its present deflection, without what is fixed to its stations.
    pub(super) inertia: SpatialInertia<T>,
    /// `pᴬ`; in inverse dynamics the force that the body needs.
    pub(super) p: Force<T>,
    /// `Iᴬ` so far.
    pub(super) ia: ArticulatedInertia<T>,
    /// `U = Iᴬ S`.
    pub(super) u_cap: Force<T>,
    /// `1 / d`, `d` the joint's apparent inertia.
    pub(super) d_inv: T,
    /// Generalised force at the joint that is left to accelerate it.
    pub(super) u: T,
    /// Net reflected torque on the joint's elastic rotor.
    pub(super) on_rotor: T,
    /// Acceleration of the origin as a point in space, gravity included; in energies the twist.
    pub(super) a: Motion<T>,
    /// From the world; where poses are asked for.
    pub(super) pose: Transform<T>,
}

/// What is kept for one station: the frame that coincides with the link's while the link is straight and is carried by the
/// station as if fixed to it.
#[derive(Clone, Copy, Debug)]
pub struct FlexibleStation<T> {
    /// From the link's frame.
    pub(super) x: Transform<T>,
    /// `ω`.
    pub(super) omega: Vec3<T>,
    /// `c`: acceleration beside the link's due to velocities alone.
    pub(super) c: Motion<T>,
    /// `pᴬ`.
    pub(super) p: Force<T>,
    /// `Iᴬ`.
    pub(super) ia: ArticulatedInertia<T>,
    /// Acceleration as of [`FlexibleBody`].
    pub(super) a: Motion<T>,
}

/// What is kept for one mode.
#[derive(Clone, Copy, Debug)]
pub struct FlexibleMode<T> {
    /// `B_j = ∫ r φ_jᵀ dm` at the present deflection.
    pub(super) moments: Mat3<T>,
    /// `∫ φ_j dm` at the present deflection.
    pub(super) momentum: Vec3<T>,
    /// Force of the link per unit of acceleration of the mode; once the modes before are eliminated, `U` of this one.
    pub(super) u_cap: Force<T>,
    /// `1 / d`, `d` the mode's apparent inertia once those before are eliminated.
    pub(super) d_inv: T,
    /// What the mode needs for velocities and deflection alone; once those before are eliminated, what is left.
    pub(super) p: T,
    /// `η̈`.
    pub(super) etadd: T,
}

impl<T: Scalar> FlexibleBody<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            theta: Turn::none(),
            omega: Vec3::zero(),
            c: Motion::zero(),
            inertia: SpatialInertia::zero(),
            p: Force::zero(),
            ia: ArticulatedInertia::zero(),
            u_cap: Force::zero(),
            d_inv: T::zero(),
            u: T::zero(),
            on_rotor: T::zero(),
            a: Motion::zero(),
            pose: Transform::identity(),
        }
    }
}

impl<T: Scalar> FlexibleStation<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            x: Transform::identity(),
            omega: Vec3::zero(),
            c: Motion::zero(),
            p: Force::zero(),
            ia: ArticulatedInertia::zero(),
            a: Motion::zero(),
        }
    }
}

impl<T: Scalar> FlexibleMode<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            moments: Mat3::zero(),
            momentum: Vec3::zero(),
            u_cap: Force::zero(),
            d_inv: T::zero(),
            p: T::zero(),
            etadd: T::zero(),
        }
    }
}

impl<T: Scalar> Default for FlexibleBody<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Scalar> Default for FlexibleStation<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Scalar> Default for FlexibleMode<T> {
    fn default() -> Self {
        Self::new()
    }
}
