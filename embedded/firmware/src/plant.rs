//! The arm the controller moves, in simulation.

use crate::arm::N;
use crate::controller::{Measured, PERIOD};
use crate::reference::Target;
use gyroflex::dynamics::{AbaScratch, External, ForwardScratch};
use gyroflex::integrate::{StateMut, rk4};
use gyroflex::model::{Model, SizeError};

/// Steps in one period of the controller: the last joint on its spring turns at 376 Hz.
const STEPS: usize = 4;
/// What [`gyroflex::integrate::rk4_len`] asks for.
const WORK: usize = 3 * (N + 3 * N) + N;

/// The moving arm.
#[derive(Clone, Debug)]
pub struct Plant<'a> {
    model: &'a Model<'a, f32>,
    pub now: Measured,
    scratch: [AbaScratch<f32>; N],
    work: [f32; WORK],
}

impl<'a> Plant<'a> {
    /// At rest where the transmissions carry `tau_j`.
    pub fn at_rest(model: &'a Model<'a, f32>, start: &Target, tau_j: &[f32; N]) -> Self {
        let mut now = Measured { q: start.q, theta: start.q, ..Measured::default() };
        for (i, body) in model.bodies().iter().enumerate().take(N) {
            if let Some(elastic) = body.drive.as_ref().and_then(|d| d.elastic.as_ref()) {
                now.theta[i] += tau_j[i] / elastic.spring.stiffness;
            }
        }
        Self { model, now, scratch: [AbaScratch::new(); N], work: [0.0; WORK] }
    }

    /// Moves on by one period.
    pub fn step(&mut self, tau: &[f32; N], on_links: &[f32; N]) -> Result<(), SizeError> {
        for _ in 0..STEPS {
            let Measured { q, qd, theta, thetad } = &mut self.now;
            let state = StateMut { q, qd, theta, thetad };
            let ext = External { tau: on_links, wrenches: &[] };
            let scratch = ForwardScratch { bodies: &mut self.scratch, joint_space: &mut [], matrix: &mut [] };
            rk4(self.model, state, tau, ext, PERIOD / STEPS as f32, scratch, &mut self.work)?;
        }
        Ok(())
    }
}
