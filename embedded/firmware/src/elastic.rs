//! The inverse of the elastic arm: motors and torques from six derivatives of the motion of its links.

use crate::arm::N;
use crate::orders::ORDERS;
use crate::random::{ORDER, Point};
use gyroflex::dynamics::{
    Deflections, ElasticInverse, ElasticInverseScratch, External, InverseError, JointMotion, Smoothness,
    elastic_inverse,
};
use gyroflex::model::Model;

/// Taylor coefficients of accelerations that this arm needs, and that code is generated for.
pub const COEFFICIENTS: usize = ORDER - 1;

/// What it works in and what it finds.
#[derive(Clone, Debug)]
pub struct Elastic {
    series: [ElasticInverseScratch<f32>; (N + 1) * COEFFICIENTS],
    /// `θ, θ̇, θ̈`.
    pub theta: [[f32; N]; 3],
    pub tau_j: [f32; N],
    pub tau: [f32; N],
    pub deflection: [f32; N],
    pub deflection_rate: [f32; N],
}

impl Elastic {
    pub fn new() -> Self {
        Self {
            series: [ElasticInverseScratch::new(); (N + 1) * COEFFICIENTS],
            theta: [[0.0; N]; 3],
            tau_j: [0.0; N],
            tau: [0.0; N],
            deflection: [0.0; N],
            deflection_rate: [0.0; N],
        }
    }

    /// Inverts the motion of a point; its deflections are those of the transmissions, and a millisecond later those that are written.
    pub fn invert(&mut self, model: &Model<f32>, p: &Point) -> Result<(), InverseError> {
        let now: [f32; N] = core::array::from_fn(|i| p.theta[i] - p.q[i]);
        elastic_inverse::<f32, COEFFICIENTS>(
            model,
            &Smoothness { joints: &ORDERS, torque_derivatives: 0 },
            JointMotion { q: &p.q, derivatives: p.derivatives.as_flattened() },
            External::none(),
            Deflections { now: &now, step: 1e-3 },
            &mut self.series,
            ElasticInverse {
                theta: self.theta.as_flattened_mut(),
                tau_j: &mut self.tau_j,
                tau: &mut self.tau,
                deflection: &mut self.deflection,
                deflection_rate: &mut self.deflection_rate,
            },
        )
    }
}

impl Default for Elastic {
    fn default() -> Self {
        Self::new()
    }
}
