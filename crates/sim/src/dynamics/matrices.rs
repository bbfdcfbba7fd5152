//! The matrices of the equations of motion beside inertia, the regressor, and the dynamics of a frame.

use super::Dynamics;
use crate::error::Error;
use gyroflex::dynamics::{
    self, Acceleration, Bias, CoriolisMatrices, InertiaRates, OperationalSpace, PARAMETERS, Regressor, SingularValues,
    State, Task,
};

impl Dynamics {
    /// `C, C₁, C₂`, `nv × nv` by rows each; see [`dynamics::coriolis_matrices`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn coriolis_matrices(&mut self, state: State<f64>, out: CoriolisMatrices<f64>) -> Result<(), Error> {
        if self.bending.is_some() {
            return self.flexible_coriolis(state, out);
        }
        Ok(dynamics::coriolis_matrices(&self.model.view(), state, &mut self.derivative, out)?)
    }

    /// `Ṁ, Ṡ`, `nv × nv` by rows each; see [`dynamics::inertia_rates`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn inertia_rates(&mut self, state: State<f64>, out: InertiaRates<f64>) -> Result<(), Error> {
        if self.bending.is_some() {
            return self.flexible_inertia_rates(state, out);
        }
        Ok(dynamics::inertia_rates(&self.model.view(), state, &mut self.derivative, out)?)
    }

    /// `C q̇ + C₁ θ̇ + g` and `C₂ q̇`; see [`dynamics::bias`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn bias(&mut self, state: State<f64>, out: Bias<f64>) -> Result<(), Error> {
        if self.bending.is_some() {
            return self.flexible_bias(state, out);
        }
        Ok(dynamics::bias(&self.model.view(), state, &mut self.derivative, out)?)
    }

    /// `g(q)`; see [`dynamics::gravity_torques`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn gravity_torques(&mut self, q: &[f64], g: &mut [f64]) -> Result<(), Error> {
        if self.bending.is_some() {
            return self.flexible_gravity(q, g);
        }
        Ok(dynamics::gravity_torques(&self.model.view(), q, &mut self.derivative, g)?)
    }

    /// The matrices that the robot's parameters enter linearly; see [`dynamics::regressor`].
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn regressor(&mut self, state: State<f64>, accel: Acceleration<f64>, out: Regressor<f64>) -> Result<(), Error> {
        self.model.refuse_bending("the regressor")?;
        Ok(dynamics::regressor(&self.model.view(), state, accel, &mut self.derivative, out)?)
    }

    /// The parameters of the regressor, [`PARAMETERS`] for each body; see [`dynamics::parameters`].
    pub fn parameters(&self) -> Vec<f64> {
        let model = self.model.view();
        let mut out = vec![0.0; PARAMETERS * model.bodies().len()];
        dynamics::parameters(&model, &mut out).expect("made for the model");
        out
    }

    /// The dynamics that a frame feels; see [`dynamics::operational_space`].
    ///
    /// # Errors
    /// A slice that does not fit the model, or a direction that does not exist.
    pub fn operational_space(
        &mut self,
        state: State<f64>,
        task: Task<f64>,
        out: OperationalSpace<f64>,
    ) -> Result<SingularValues<f64>, Error> {
        self.model.refuse_bending("the dynamics of a frame")?;
        let model = self.model.view();
        self.operational.resize(dynamics::operational_len(&model, task.directions.len()), 0.0);
        Ok(dynamics::operational_space(&model, state, task, &mut self.derivative, &mut self.operational, out)?)
    }
}
