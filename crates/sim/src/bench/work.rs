//! The algorithms with everything they read and write, so that a timed call is the call and nothing else.

use super::states::Point;
use crate::error::Error;
use gyroflex::dynamics::{
    self, AbaScratch, Acceleration, CrbaScratch, DerivativeScratch, External, Forward, ForwardDerivatives,
    ForwardScratch, Inverse, JointSpaceScratch, RneaScratch, State,
};
use gyroflex::integrate::{self, StateMut};
use gyroflex::model::Model;
use gyroflex::spatial::Transform;

/// Length of the Runge–Kutta step [s]; its time does not depend on it.
const STEP: f64 = 1e-4;

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Algorithm {
    /// [`dynamics::rnea`].
    Inverse,
    /// [`dynamics::forward_dynamics`].
    Forward,
    /// [`dynamics::forward_derivatives`].
    ForwardDerivatives,
    /// [`dynamics::crba`].
    Matrix,
    /// [`dynamics::placements`].
    Placements,
    /// [`integrate::rk4`].
    RungeKutta,
}

impl Algorithm {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 6] =
        [Self::Inverse, Self::Forward, Self::ForwardDerivatives, Self::Matrix, Self::Placements, Self::RungeKutta];

    /// What people call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Inverse => "inverse dynamics",
            Self::Forward => "forward dynamics",
            Self::ForwardDerivatives => "forward derivatives",
            Self::Matrix => "inertia matrix",
            Self::Placements => "link poses",
            Self::RungeKutta => "RK4 step",
        }
    }
}

/// One model with room for every algorithm.
pub(super) struct Work<'a> {
    model: Model<'a, f64>,
    aba: Vec<AbaScratch<f64>>,
    joint_space: Vec<JointSpaceScratch<f64>>,
    matrix: Vec<f64>,
    rnea: Vec<RneaScratch<f64>>,
    crba: Vec<CrbaScratch<f64>>,
    poses: Vec<Transform<f64>>,
    sensitivities: Vec<DerivativeScratch<f64>>,
    derivative_matrix: Vec<f64>,
    derivatives: [Vec<f64>; 2],
    mass: Vec<f64>,
    out: [Vec<f64>; 3],
    moving: [Vec<f64>; 4],
    steps: Vec<f64>,
}

impl<'a> Work<'a> {
    pub(super) fn new(model: Model<'a, f64>) -> Self {
        let (n, nq, nv) = (model.bodies().len(), model.nq(), model.nv());
        let zeros = |n| vec![0.0; n];
        Self {
            aba: vec![AbaScratch::new(); n],
            joint_space: vec![JointSpaceScratch::new(); dynamics::joint_space_len(&model)],
            matrix: zeros(dynamics::matrix_len(&model)),
            rnea: vec![RneaScratch::new(); n],
            crba: vec![CrbaScratch::new(); n],
            poses: vec![Transform::identity(); n],
            sensitivities: vec![DerivativeScratch::new(); n],
            derivative_matrix: zeros(dynamics::derivative_matrix_len(&model)),
            derivatives: [zeros(5 * nv * nv), zeros(5 * nv * nv)],
            mass: zeros(nv * nv),
            out: [zeros(nv), zeros(nv), zeros(nv)],
            moving: [zeros(nq), zeros(nv), zeros(nv), zeros(nv)],
            steps: zeros(integrate::rk4_len(&model)),
            model,
        }
    }

    /// What must be there before a call and is not its work: a step moves its state.
    pub(super) fn prepare(&mut self, algorithm: Algorithm, point: &Point) {
        if algorithm == Algorithm::RungeKutta {
            let from = [&point.q, &point.qd, &point.theta, &point.thetad];
            self.moving.iter_mut().zip(from).for_each(|(to, from)| to.copy_from_slice(from));
        }
    }

    #[inline]
    pub(super) fn call(&mut self, algorithm: Algorithm, point: &Point) -> Result<(), Error> {
        let Self { model, aba, joint_space, matrix, rnea, crba, poses, mass, out: [a, b, c], moving, steps, .. } = self;
        let Point { q, qd, theta, thetad, tau, qdd } = point;
        let state = State { q, qd, theta, thetad };
        let scratch = ForwardScratch { bodies: aba, joint_space, matrix };
        let ext = External::none();
        let done = match algorithm {
            Algorithm::Inverse => {
                let (accel, out) = (Acceleration { qdd, thetadd: qdd }, Inverse { tau_j: a, tau: b });
                dynamics::rnea(model, state, accel, ext, rnea, out)
            }
            Algorithm::Forward => {
                let out = Forward { qdd: a, thetadd: b, tau_j: c };
                dynamics::forward_dynamics(model, state, tau, ext, scratch, out)
            }
            Algorithm::ForwardDerivatives => {
                let value = Forward { qdd: a, thetadd: b, tau_j: c };
                let [qdd, thetadd] = &mut self.derivatives;
                let (scratch, matrix) = (&mut self.sensitivities, &mut self.derivative_matrix);
                let out = ForwardDerivatives { qdd, thetadd };
                dynamics::forward_derivatives(model, state, tau, ext, scratch, matrix, value, out)
            }
            Algorithm::Matrix => dynamics::crba(model, q, crba, mass),
            Algorithm::Placements => dynamics::placements(model, q, poses),
            Algorithm::RungeKutta => {
                let [q, qd, theta, thetad] = moving;
                integrate::rk4(model, StateMut { q, qd, theta, thetad }, tau, ext, STEP, scratch, steps)
            }
        };
        Ok(done?)
    }
}
