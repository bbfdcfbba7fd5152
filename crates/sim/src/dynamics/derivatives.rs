//! How accelerations and torques change with the state.

use super::Dynamics;
use crate::error::Error;
use gyroflex::dynamics::{self, Acceleration, External, Forward, ForwardDerivatives, InverseDerivatives, State};

impl Dynamics {
    /// The accelerations of [`Dynamics::forward`] and how they change with `q, q̇, θ, θ̇, τ`: `nv` rows of `5 nv` columns; see
    /// [`dynamics::forward_derivatives`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn forward_derivatives(
        &mut self,
        state: State<f64>,
        tau: &[f64],
        ext: External<f64>,
        value: Forward<f64>,
        out: ForwardDerivatives<f64>,
    ) -> Result<(), Error> {
        self.model.refuse_bending("what differentiates by formulas")?;
        let (model, scratch, matrix) = (self.model.view(), &mut self.derivative, &mut self.derivative_matrix);
        Ok(dynamics::forward_derivatives(&model, state, tau, ext, scratch, matrix, value, out)?)
    }

    /// How the torques of [`Dynamics::inverse`] change with `q, q̇, q̈, θ, θ̇, θ̈`: `nv` rows of `6 nv` columns; see
    /// [`dynamics::inverse_derivatives`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn inverse_derivatives(
        &mut self,
        state: State<f64>,
        accel: Acceleration<f64>,
        ext: External<f64>,
        out: InverseDerivatives<f64>,
    ) -> Result<(), Error> {
        self.model.refuse_bending("what differentiates by formulas")?;
        Ok(dynamics::inverse_derivatives(&self.model.view(), state, accel, ext, &mut self.derivative, out)?)
    }
}
