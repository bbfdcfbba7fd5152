//! The equations of motion and everything computed from them, one algorithm a file.
//!
//! Every function takes a [`Model`], input slices, scratch records of its own family and output slices. Scratch keeps
//! nothing between calls. Slices over the joints (`qd`, `theta`, `tau`, …) have [`Model::nv`] entries, `q` has
//! [`Model::nq`]. `theta`, `thetad` and `thetadd` are read and written in full length, but mean something only at joints
//! with an elastic transmission; everywhere else the motor turns with the joint.

mod aba;
mod aba_base;
mod aba_scratch;
mod at_base;
mod branches;
mod constraint;
mod coriolis;
mod crba;
mod dense;
mod drive_torque;
mod elastic_inverse;
mod energy;
mod euler;
mod flexible;
mod forward;
mod forward_derivatives;
mod inverse_derivatives;
mod joint_space;
mod kinematics;
mod moving;
mod operational;
mod pairs;
mod regressor;
mod rnea;
mod singular;
mod smoothness;
mod tree;

pub use aba::aba;
pub use aba_scratch::AbaScratch;
pub use at_base::DerivativeScratch;
pub use constraint::{
    Anchor, Constrained, ConstrainedScratch, Constraint, ConstraintError, ConstraintMotion, ConstraintScratch, Contact,
    Directions, Hold, Impact, PropagatedScratch, Regularisation, Solved, SupportScratch, TorqueDistribution,
    constrained_aba, constrained_forward_dynamics, constrained_inverse_dynamics, constrained_inverse_len,
    constrained_joint_matrix_len, constraint_matrix_len, constraint_motion, constraint_rows, impact, impact_aba,
    propagated_len,
};
pub use coriolis::{Bias, CoriolisMatrices, InertiaRates, bias, coriolis_matrices, gravity_torques, inertia_rates};
pub use crba::{CrbaScratch, coupling, crba, reflected_inertia};
pub use elastic_inverse::{
    Deflections, ElasticInverse, ElasticInverseScratch, InverseError, JointMotion, MAX_COEFFICIENTS, elastic_inverse,
    elastic_inverse_len,
};
pub use energy::{Energy, Power, energy, power};
pub use euler::Rotation;
pub use flexible::{
    FlexibleBody, FlexibleMatrices, FlexibleMode, FlexiblePlacements, FlexibleScratch, FlexibleStation, flexible_aba,
    flexible_energy, flexible_hybrid, flexible_mass_matrix, flexible_matrix_len, flexible_placements, flexible_power,
    flexible_rnea, flexible_shapes_len, flexible_velocities,
};
pub use forward::{ForwardScratch, forward_dynamics, joint_space_len, matrix_len};
pub use forward_derivatives::{ForwardDerivatives, derivative_matrix_len, forward_derivatives};
pub use inverse_derivatives::{InverseDerivatives, inverse_derivatives};
pub use joint_space::{JointSpaceScratch, forward_in_joint_space};
pub use kinematics::{Axes, Frame, jacobian, placements, velocities};
pub use operational::{OperationalSpace, Task, operational_len, operational_space};
pub use regressor::{PARAMETERS, Regressor, parameters, regressor};
pub use rnea::{RneaScratch, rnea};
pub use singular::SingularValues;
pub use smoothness::{
    Contains, JointOrders, Smoothness, SmoothnessScratch, VANISHING, required_smoothness, smoothness_len,
};

use crate::Scalar;
use crate::model::{Model, SizeError};
use crate::spatial::Force;

/// Where a robot is and how it moves.
#[derive(Clone, Copy, Debug)]
pub struct State<'a, T> {
    /// Joint positions: `nq` entries [rad or m]; a floating root leads with `x y z qx qy qz qw`.
    pub q: &'a [T],
    /// Joint velocities: `nv` entries; a floating root leads with its twist in its own frame, angular first.
    pub qd: &'a [T],
    /// Motor positions reflected through the gear: `nv` entries, read at joints with an elastic transmission.
    pub theta: &'a [T],
    /// Motor velocities reflected through the gear: `nv` entries, read at joints with an elastic transmission.
    pub thetad: &'a [T],
}

/// Loads from outside, besides the motors.
#[derive(Clone, Copy, Debug)]
pub struct External<'a, T> {
    /// Generalised forces on the link side of the joints: `nv` entries [N m or N], or empty for none.
    pub tau: &'a [T],
    /// One wrench per body, in its link frame about its origin, or empty for none.
    pub wrenches: &'a [Force<T>],
}

impl<T> External<'_, T> {
    /// No loads.
    pub const fn none() -> Self {
        Self { tau: &[], wrenches: &[] }
    }
}

/// What forward dynamics writes: `nv` entries each.
#[derive(Debug)]
pub struct Forward<'a, T> {
    /// Joint accelerations; of a floating root the spatial acceleration in its own frame, angular first.
    pub qdd: &'a mut [T],
    /// Reflected motor accelerations; equal to `qdd` where there is no elastic transmission.
    pub thetadd: &'a mut [T],
    /// Torque the transmission, rigid gear or ideal motor exerts on the joint, link side [N m or N].
    pub tau_j: &'a mut [T],
}

/// The motion inverse dynamics is asked for: `nv` entries each.
#[derive(Clone, Copy, Debug)]
pub struct Acceleration<'a, T> {
    /// Joint accelerations.
    pub qdd: &'a [T],
    /// Reflected motor accelerations, read at joints with an elastic transmission.
    pub thetadd: &'a [T],
}

/// What inverse dynamics writes: `nv` entries each.
#[derive(Debug)]
pub struct Inverse<'a, T> {
    /// Torque that the transmission must exert on the joint, link side [N m or N].
    pub tau_j: &'a mut [T],
    /// Torque that the motor must exert, reflected to the link side [N m or N].
    pub tau: &'a mut [T],
}

impl<T> Forward<'_, T> {
    fn check<P: Scalar>(&self, model: &Model<P>, tau: &[T]) -> Result<(), SizeError> {
        SizeError::check("tau", tau.len(), model.nv)?;
        SizeError::check("qdd", self.qdd.len(), model.nv)?;
        SizeError::check("thetadd", self.thetadd.len(), model.nv)?;
        SizeError::check("tau_j", self.tau_j.len(), model.nv)
    }
}

fn check_state<P: Scalar, T>(model: &Model<P>, state: &State<T>) -> Result<(), SizeError> {
    SizeError::check("q", state.q.len(), model.nq)?;
    SizeError::check("qd", state.qd.len(), model.nv)?;
    SizeError::check("theta", state.theta.len(), model.nv)?;
    SizeError::check("thetad", state.thetad.len(), model.nv)
}

fn check_external<P: Scalar, T>(model: &Model<P>, ext: &External<T>) -> Result<(), SizeError> {
    if !ext.tau.is_empty() {
        SizeError::check("external tau", ext.tau.len(), model.nv)?;
    }
    if !ext.wrenches.is_empty() {
        SizeError::check("external wrenches", ext.wrenches.len(), model.bodies.len())?;
    }
    Ok(())
}

fn check_scratch<P: Scalar, S>(model: &Model<P>, scratch: &[S]) -> Result<(), SizeError> {
    check_scratch_len(scratch, model.bodies.len())
}

fn check_scratch_len<S>(scratch: &[S], needed: usize) -> Result<(), SizeError> {
    SizeError::check("scratch", scratch.len(), needed)
}
