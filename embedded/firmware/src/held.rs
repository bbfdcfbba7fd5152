//! The arm with its tip held: constrained forward dynamics, the impact that catches it, and the torques of least norm that move it so.

use crate::arm::N;
use crate::random::Point;
use gyroflex::dynamics::{
    AbaScratch, Acceleration, Anchor, Constrained, ConstrainedScratch, Constraint, ConstraintError, ConstraintScratch,
    Directions, External, Forward, Frame, Hold, Impact, Inverse, PropagatedScratch, Regularisation, RneaScratch,
    Solved, State, SupportScratch, TorqueDistribution, constrained_aba, constrained_inverse_dynamics, impact_aba,
};
use gyroflex::model::Model;
use gyroflex::spatial::{Force, Transform};

/// Constrained directions: the tip's position.
pub const ROWS: usize = 3;

/// What it works in and what it finds.
#[derive(Clone, Debug)]
pub struct Held {
    bodies: [AbaScratch<f32>; N],
    recursion: [RneaScratch<f32>; N],
    supports: [SupportScratch<f32>; N],
    constraints: [ConstraintScratch<f32>; 1],
    propagated: [PropagatedScratch<f32>; N],
    matrix: [f32; 2 * (ROWS * ROWS + ROWS)],
    inverse: [f32; (ROWS + 1) * N + 2 * (ROWS * ROWS + ROWS) + ROWS],
    /// Accelerations, or velocities after an impact.
    pub links: [f32; N],
    pub motors: [f32; N],
    pub tau_j: [f32; N],
    pub tau: [f32; N],
    pub multipliers: [f32; ROWS],
    pub wrench: [Force<f32>; 1],
}

impl Held {
    pub fn new() -> Self {
        Self {
            bodies: [AbaScratch::new(); N],
            recursion: [RneaScratch::new(); N],
            supports: [SupportScratch::new(); N],
            constraints: [ConstraintScratch::new(); 1],
            propagated: [PropagatedScratch::new(); N],
            matrix: [0.0; 2 * (ROWS * ROWS + ROWS)],
            inverse: [0.0; (ROWS + 1) * N + 2 * (ROWS * ROWS + ROWS) + ROWS],
            links: [0.0; N],
            motors: [0.0; N],
            tau_j: [0.0; N],
            tau: [0.0; N],
            multipliers: [0.0; ROWS],
            wrench: [Force::zero(); 1],
        }
    }

    /// Accelerations with the tip held.
    pub fn accelerate(&mut self, model: &Model<f32>, p: &Point) -> Result<Solved<f32>, ConstraintError> {
        let state = State { q: &p.q, qd: &p.qd, theta: &p.theta, thetad: &p.thetad };
        let out = Forward { qdd: &mut self.links, thetadd: &mut self.motors, tau_j: &mut self.tau_j };
        constrained_aba(
            model,
            state,
            &p.tau,
            External::none(),
            &[tip()],
            Regularisation::rank_revealing(1e-4),
            ConstrainedScratch {
                bodies: &mut self.bodies,
                supports: &mut self.supports,
                constraints: &mut self.constraints,
                propagated: &mut self.propagated,
                matrix: &mut self.matrix,
                joint_space: &mut [],
                joint_matrix: &mut [],
            },
            out,
            Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrench },
        )
    }

    /// Velocities when the tip is caught.
    pub fn catch(&mut self, model: &Model<f32>, p: &Point) -> Result<Solved<f32>, ConstraintError> {
        let state = State { q: &p.q, qd: &p.qd, theta: &p.theta, thetad: &p.thetad };
        impact_aba(
            model,
            state,
            &[tip()],
            false,
            Regularisation::rank_revealing(1e-4),
            ConstrainedScratch {
                bodies: &mut self.bodies,
                supports: &mut self.supports,
                constraints: &mut self.constraints,
                propagated: &mut self.propagated,
                matrix: &mut self.matrix,
                joint_space: &mut [],
                joint_matrix: &mut [],
            },
            Impact { qd: &mut self.links, thetad: &mut self.motors, gears: &mut self.tau_j },
            Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrench },
        )
    }

    /// Torques of least norm for the accelerations that were found.
    pub fn drive(&mut self, model: &Model<f32>, p: &Point) -> Result<Solved<f32>, ConstraintError> {
        let state = State { q: &p.q, qd: &p.qd, theta: &p.theta, thetad: &p.thetad };
        let distribution =
            TorqueDistribution { torques: &[1.0; N], passive: &[], multipliers: &[1e-3; ROWS], wanted: &[] };
        constrained_inverse_dynamics(
            model,
            state,
            Acceleration { qdd: &self.links, thetadd: &self.motors },
            External::none(),
            &[tip()],
            distribution,
            Regularisation::rank_revealing(1e-4),
            &mut self.recursion,
            &mut self.supports,
            &mut self.inverse,
            Inverse { tau_j: &mut self.tau_j, tau: &mut self.tau },
            &mut self.multipliers,
        )
    }
}

impl Default for Held {
    fn default() -> Self {
        Self::new()
    }
}

/// The origin of the last link, held at the world's.
fn tip() -> Constraint<f32> {
    let frame = Frame { body: N - 1, placement: Transform::identity() };
    let anchor = Anchor { body: None, placement: Transform::identity() };
    let hold = Hold::Frame { frame, anchor, directions: Directions::POINT };
    Constraint { hold, stabilisation: 0.0, contact: None }
}
