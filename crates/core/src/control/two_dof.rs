//! The controller with two structural degrees of freedom: an inverse model for what is asked, feedback for what is not as it should be.

use super::{Motors, Pd};
use crate::Scalar;
use crate::dynamics::{
    Deflections, ElasticInverse, ElasticInverseScratch, External, InverseError, JointMotion, Smoothness,
    elastic_inverse,
};
use crate::model::Model;

/// Reference model → inverse model → plant, with feedback on the motors (Kreisselmeier 1999; Thümmel, Otter & Bals, figure 2): the
/// inverse gives the motor torques and the motor positions that go with the motion of the links, and feedback acts on the
/// difference between those positions and the measured ones.
#[derive(Debug)]
pub struct TwoDof<'a, T: Scalar> {
    /// The model to invert.
    pub model: Model<'a, T::Param>,
    /// What its inverse needs.
    pub smoothness: Smoothness<'a>,
    /// The feedback.
    pub feedback: Pd<'a, T>,
    /// Deflections of damped transmissions, the state of the inverse: `nv` entries; at the start those of rest.
    pub deflection: &'a mut [T],
}

/// What [`TwoDof::tick`] works in.
#[derive(Debug)]
pub struct TwoDofScratch<'a, T> {
    /// As many as [`elastic_inverse_len`](crate::dynamics::elastic_inverse_len) says.
    pub series: &'a mut [ElasticInverseScratch<T>],
    /// Desired motor positions, velocities and accelerations, left for the caller to look at: `3 nv` entries.
    pub theta: &'a mut [T],
    /// Desired torques through the transmissions, likewise: `nv` entries.
    pub tau_j: &'a mut [T],
    /// `2 nv` entries.
    pub rates: &'a mut [T],
}

impl<T: Scalar> TwoDof<'_, T> {
    /// Motor torques `tau` (`nv` entries, reflected) for the motion asked for now and the motors measured now; `step` is the time to the
    /// next tick [s]. `MAX` is that of [`elastic_inverse`].
    ///
    /// # Errors
    /// [`InverseError`]; the deflections are as they were then.
    pub fn tick<const MAX: usize>(
        &mut self,
        motion: JointMotion<T>,
        measured: Motors<T>,
        step: T,
        scratch: TwoDofScratch<T>,
        tau: &mut [T],
    ) -> Result<(), InverseError> {
        let nv = self.model.nv();
        let TwoDofScratch { series, theta, tau_j, rates } = scratch;
        let (deflection, deflection_rate) = rates.split_at_mut(nv.min(rates.len()));
        elastic_inverse::<T, MAX>(
            &self.model,
            &self.smoothness,
            motion,
            External::none(),
            Deflections { now: self.deflection, step },
            series,
            ElasticInverse { theta: &mut *theta, tau_j, tau: &mut *tau, deflection: &mut *deflection, deflection_rate },
        )?;
        let (theta, rest) = theta.split_at(nv.min(theta.len()));
        let thetad = rest.get(..nv).unwrap_or(rest);
        self.feedback.add(Motors { theta, thetad }, measured, tau)?;
        self.deflection.copy_from_slice(deflection);
        Ok(())
    }
}
