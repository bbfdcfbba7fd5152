//! Sees what the model cannot explain.

use crate::arm::N;
use crate::controller::{Measured, PERIOD};
use crate::scratch::{Accelerations, Scratch, forward, mass_matrix};
use gyroflex::model::{Model, SizeError};

/// Part of a velocity's error that is made good in one period.
const GAIN: f32 = 0.05;

/// Predicts the velocities of links and motors by forward dynamics. What must be added to keep the prediction on the
/// measurement is acceleration that no motor caused: a contact, seen without a torque sensor.
#[derive(Clone, Debug)]
pub struct Observer {
    qd: [f32; N],
    /// Torque from outside, on the link side of each joint [N m].
    pub contact: [f32; N],
    predicted: Accelerations,
    matrix: [[f32; N]; N],
}

impl Observer {
    /// An observer of an arm at rest.
    pub fn new() -> Self {
        let predicted = Accelerations::default();
        Self { qd: [0.0; N], contact: [0.0; N], predicted, matrix: [[0.0; N]; N] }
    }

    /// Takes a measurement and the torques that act from now to the next one.
    pub fn observe(
        &mut self,
        model: &Model<f32>,
        measured: &Measured,
        tau: &[f32; N],
        scratch: &mut Scratch,
    ) -> Result<(), SizeError> {
        forward(model, measured.state(), tau, &[], scratch, &mut self.predicted)?;
        mass_matrix(model, &measured.q, scratch, &mut self.matrix)?;
        // v̂ ← v̂ + h q̈ + L (v − v̂),   τ_ext = M L (v − v̂) / h
        let error: [f32; N] = core::array::from_fn(|i| measured.qd[i] - self.qd[i]);
        for i in 0..N {
            let row = &self.matrix[i];
            self.contact[i] = (0..N).fold(0.0, |sum, j| sum + row[j] * error[j]) * (GAIN / PERIOD);
            self.qd[i] += PERIOD * self.predicted.qdd[i] + GAIN * error[i];
        }
        Ok(())
    }
}

impl Default for Observer {
    fn default() -> Self {
        Self::new()
    }
}
