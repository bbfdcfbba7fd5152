//! Forward dynamics by whichever route is exact for the robot.

use super::{AbaScratch, External, Forward, State, aba, forward_in_joint_space};
use crate::Scalar;
use crate::model::{Model, SizeError};

/// Scratch for [`forward_dynamics`].
#[derive(Debug)]
pub struct ForwardScratch<'a, T> {
    /// One record per body.
    pub bodies: &'a mut [AbaScratch<T>],
    /// [`matrix_len`] entries: none, unless a rigidly geared rotor sits away from its joint's parent.
    pub matrix: &'a mut [T],
}

/// Length of [`ForwardScratch::matrix`] for a robot.
pub fn matrix_len<T: Scalar>(model: &Model<T>) -> usize {
    if model.has_remote_rigid_rotor() { model.nv() * model.nv() } else { 0 }
}

/// Accelerations of all joints and motors: [`aba`] where it is exact, else [`forward_in_joint_space`].
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn forward_dynamics<T: Scalar>(
    model: &Model<T>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: ForwardScratch<T>,
    out: Forward<T>,
) -> Result<(), SizeError> {
    if model.has_remote_rigid_rotor() {
        forward_in_joint_space(model, state, tau, ext, scratch.bodies, scratch.matrix, out)
    } else {
        aba(model, state, tau, ext, scratch.bodies, out)
    }
}
