//! Forward dynamics by whichever route is exact for the robot.

use super::{AbaScratch, External, Forward, JointSpaceScratch, State, aba, forward_in_joint_space};
use crate::Scalar;
use crate::model::{Model, SizeError};

/// Scratch for [`forward_dynamics`].
#[derive(Debug)]
pub struct ForwardScratch<'a, T> {
    /// One record per body.
    pub bodies: &'a mut [AbaScratch<T>],
    /// [`joint_space_len`] records.
    pub joint_space: &'a mut [JointSpaceScratch<T>],
    /// [`matrix_len`] entries.
    pub matrix: &'a mut [T],
}

/// Length of [`ForwardScratch::joint_space`] for a robot: zero, unless a rigidly geared rotor sits away from its joint's parent.
pub fn joint_space_len<P: Scalar>(model: &Model<P>) -> usize {
    if model.has_remote_rigid_rotor() { model.bodies().len() } else { 0 }
}

/// Length of [`ForwardScratch::matrix`] for a robot, zero likewise.
pub fn matrix_len<P: Scalar>(model: &Model<P>) -> usize {
    if model.has_remote_rigid_rotor() { model.nv() * model.nv() } else { 0 }
}

/// Accelerations of all joints and motors: [`aba`] where it is exact, else [`forward_in_joint_space`].
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn forward_dynamics<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: ForwardScratch<T>,
    out: Forward<T>,
) -> Result<(), SizeError> {
    if model.has_remote_rigid_rotor() {
        forward_in_joint_space(model, state, tau, ext, scratch.joint_space, scratch.matrix, out)
    } else {
        aba(model, state, tau, ext, scratch.bodies, out)
    }
}
