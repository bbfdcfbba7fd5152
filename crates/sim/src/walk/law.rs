//! The sliding mode laws of the two phases (Mu & Wu 2004, equations 31 to 34; on one foot that of Tzafestas, Raibert & Tzafestas 1996).

use super::chain::{Chain, Five};
use crate::error::{Error, ErrorKind};
use gyroflex::control::{InputOutput, Outputs, SlidingMode, SlidingModeError, SlidingScratch};
use nalgebra::{Matrix2, Vector2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a sliding mode law is set to. SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sliding {
    /// `λ`: how fast errors die out on the sliding surface [1/s].
    pub lambda: f64,
    /// `α`: how steep the boundary layer is [s/rad, s/m].
    pub alpha: f64,
    /// `σ`: acceleration to reach the surface with [rad/s², m/s²].
    pub sigma: f64,
    /// `η`: bound of what the errors of the model are worth at each joint [N m].
    pub eta: f64,
}

/// What is followed, in as many outputs as the law has.
pub(super) struct Followed<'a> {
    pub(super) desired: Outputs<'a, f64>,
    pub(super) acceleration: &'a [f64],
    pub(super) measured: Outputs<'a, f64>,
}

/// A law and its memory; storage for up to five outputs and five inputs.
#[derive(Clone, Debug)]
pub(super) struct Law {
    gains: Sliding,
    integral: [f64; 5],
    /// `s` at the last tick.
    pub(super) sliding: [f64; 5],
}

impl Law {
    pub(super) fn new(gains: Sliding) -> Self {
        Self { gains, integral: [0.0; 5], sliding: [0.0; 5] }
    }

    /// Forgets the integral, as at the beginning of a phase.
    pub(super) fn reset(&mut self) {
        self.integral.fill(0.0);
    }

    fn tick(&mut self, plant: InputOutput<f64>, follow: &Followed, step: f64) -> Result<Five, Error> {
        let m = follow.acceleration.len();
        let [lambda, steepness, sigma, eta] =
            [self.gains.lambda, self.gains.alpha, self.gains.sigma, self.gains.eta].map(|gain| [gain; 5]);
        let mut law = SlidingMode {
            lambda: &lambda[..m],
            steepness: &steepness[..m],
            sigma: &sigma[..m],
            eta: &eta,
            weights: &[1.0; 5],
            independence: 1e-12,
            integral: &mut self.integral[..m],
        };
        let (mut matrix, mut input) = ([0.0; 30], [0.0; 5]);
        let scratch = SlidingScratch { sliding: &mut self.sliding[..m], matrix: &mut matrix[..m * (m + 1)] };
        law.tick(plant, follow.desired, follow.acceleration, follow.measured, step, scratch, &mut input)
            .map_err(cannot_control)?;
        Ok(Five::from(input))
    }

    /// Torques of the chain on one foot: every joint angle is an output, `s̈ = D⁻¹ (T − N)`.
    pub(super) fn on_one_foot(
        &mut self,
        chain: &mut Chain,
        (s, rates): (&Five, &Five),
        follow: &Followed,
        step: f64,
    ) -> Result<Five, Error> {
        let (d, n) = chain.equations(s, rates)?;
        let inverse = d.cholesky().ok_or_else(singular)?.inverse();
        let gain = inverse.transpose();
        let plant =
            InputOutput { drift: &[0.0; 5], gain: gain.as_slice(), bias: n.as_slice(), preferred: n.as_slice() };
        self.tick(plant, follow, step)
    }

    /// Torques of the chain on two feet: hip and trunk are the outputs, `p̈ = b + C (T − N)` (equation 19), and five inputs move them. Of all that
    /// do, those nearest to holding the chain with the force `rear` on its far foot [N].
    pub(super) fn on_two_feet(
        &mut self,
        chain: &mut Chain,
        (s, rates): (&Five, &Five),
        follow: &Followed,
        rear: Vector2<f64>,
        step: f64,
    ) -> Result<Five, Error> {
        let (d, n) = chain.equations(s, rates)?;
        let inverse = d.cholesky().ok_or_else(singular)?.inverse();
        let motion = chain.motion(s, rates);
        // λ = −(J D⁻¹ Jᵀ)⁻¹ (J D⁻¹ (T − N) + J̇ ṡ),   p̈ = Ṙ ṡ + R D⁻¹ (T − N + Jᵀ λ)
        let foot = motion.foot * inverse;
        let compliance: Matrix2<f64> = foot * motion.foot.transpose();
        let hold = compliance.cholesky().ok_or_else(singular)?;
        let outputs = motion.outputs * inverse;
        let across = outputs * motion.foot.transpose();
        let gain = outputs - across * hold.solve(&foot);
        let drift = motion.outputs_rate - across * hold.solve(&motion.foot_rate);
        let preferred = n - motion.foot.transpose() * rear;
        let gain = gain.transpose();
        let plant = InputOutput {
            drift: drift.as_slice(),
            gain: gain.as_slice(),
            bias: n.as_slice(),
            preferred: preferred.as_slice(),
        };
        self.tick(plant, follow, step)
    }
}

fn singular() -> Error {
    fell("the chain of the legs is singular")
}

fn cannot_control(error: SlidingModeError) -> Error {
    fell(&error.to_string())
}

/// The robot is where its controller cannot help it any more.
pub(super) fn fell(why: &str) -> Error {
    Error {
        kind: ErrorKind::Diverged,
        file: String::new(),
        element: "controller `walk`".to_owned(),
        problem: format!("the biped cannot be controlled any more: {why}"),
        remedy: "check gait and gains, and that the robot starts on its reference".to_owned(),
    }
}
