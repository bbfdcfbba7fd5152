//! Derivatives of forward and inverse dynamics of one robot of the comparison.

use crate::robot::Robot;
use gyroflex::dynamics::{
    Acceleration, DerivativeScratch, External, Forward, ForwardDerivatives, InverseDerivatives, State,
    derivative_matrix_len, forward_derivatives, inverse_derivatives,
};
use gyroflex_benches::peers::{Point, Worker};
use std::cell::RefCell;
use std::hint::black_box;
use std::path::Path;
use std::rc::Rc;

/// Pinocchio's derivatives, which are what is expected, differ by 1e-10 from build to build where rotors are light and fast.
const TOLERANCE: f64 = 1e-9;

pub struct Derivatives {
    robot: Robot<f64>,
    scratch: Vec<DerivativeScratch<f64>>,
    matrix: Vec<f64>,
    value: [Vec<f64>; 3],
    /// Of the accelerations, by `q, q̇, θ, θ̇, τ`; of the torques, by `q, q̇, q̈, θ, θ̇, θ̈`: of the link side and of the rotors.
    forward: [Vec<f64>; 2],
    inverse: [Vec<f64>; 2],
}

/// Adds the rows of both derivatives.
pub fn add(worker: &mut Worker, name: &str) {
    let all = Rc::new(RefCell::new(Derivatives::load(&worker.folder, name)));
    let row = |algorithm: &str| format!("{name}/{algorithm}_derivatives");
    worker.add(row("aba"), TOLERANCE, &all, Derivatives::forward, Derivatives::forward_error);
    worker.add(row("rnea"), TOLERANCE, &all, Derivatives::inverse, Derivatives::inverse_error);
}

impl Derivatives {
    fn load(folder: &Path, name: &str) -> Self {
        let robot = Robot::load(folder, name);
        let nv = robot.model.nv();
        Self {
            scratch: vec![DerivativeScratch::new(); robot.model.bodies().len()],
            matrix: vec![0.0; derivative_matrix_len(&robot.model)],
            value: std::array::from_fn(|_| vec![0.0; nv]),
            forward: std::array::from_fn(|_| vec![0.0; 5 * nv * nv]),
            inverse: std::array::from_fn(|_| vec![0.0; 6 * nv * nv]),
            robot,
        }
    }

    fn forward(&mut self, k: usize) {
        let Point { q, qd, theta, thetad, tau, .. } = &self.robot.points[k];
        let ([a, b, tau_j], [qdd, thetadd]) = (&mut self.value, &mut self.forward);
        let value = Forward { qdd: a, thetadd: b, tau_j };
        let (state, out) = (State { q, qd, theta, thetad }, ForwardDerivatives { qdd, thetadd });
        let (scratch, matrix) = (&mut self.scratch, &mut self.matrix);
        let ext = External::none();
        let done = forward_derivatives(&self.robot.model, state, tau, ext, scratch, matrix, value, out);
        black_box((&self.value, &self.forward, done.is_ok()));
    }

    fn forward_error(&mut self, k: usize) -> f64 {
        let Self { robot, value: [qdd, thetadd, _], forward, .. } = self;
        let Point { qdd: links, thetadd: rotors, tau, .. } = &robot.points[k];
        let [by_q, by_qd, by_tau, ..] = robot.tree.expected_derivatives(k);
        let error = |[qdd, thetadd]: [&[f64]; 2], want: &[f64]| {
            robot.tree.acceleration_error(&robot.tree_order(qdd, thetadd, true), want)
        };
        let along = |directions: [&[f64]; 5], want: &[f64]| {
            let [qdd, thetadd] = forward.each_ref().map(|matrix| product(matrix, directions));
            error([&qdd, &thetadd], want)
        };
        let errors = [
            error([qdd, thetadd], robot.tree.expected(k)[0]),
            along([links, &[], rotors, &[], &[]], by_q),
            along([&[], links, &[], rotors, &[]], by_qd),
            along([&[], &[], &[], &[], tau], by_tau),
        ];
        errors.into_iter().fold(0.0, f64::max)
    }

    fn inverse(&mut self, k: usize) {
        let Point { q, qd, theta, thetad, qdd, thetadd, .. } = &self.robot.points[k];
        let [tau_j, tau] = &mut self.inverse;
        let (state, accel) = (State { q, qd, theta, thetad }, Acceleration { qdd, thetadd });
        let (ext, out) = (External::none(), InverseDerivatives { tau_j, tau });
        let done = inverse_derivatives(&self.robot.model, state, accel, ext, &mut self.scratch, out);
        black_box((&self.inverse, done.is_ok()));
    }

    fn inverse_error(&mut self, k: usize) -> f64 {
        let Self { robot, inverse, .. } = self;
        let Point { qdd: links, thetadd: rotors, .. } = &robot.points[k];
        let [.., by_q, by_qd] = robot.tree.expected_derivatives(k);
        let along = |directions: [&[f64]; 6], want: &[f64]| {
            let [tau_j, tau] = inverse.each_ref().map(|matrix| product(matrix, directions));
            let on_rotors: Vec<f64> = tau.iter().zip(&tau_j).map(|(motor, joint)| motor - joint).collect();
            robot.tree.torque_error(&robot.tree_order(&tau_j, &on_rotors, false), want)
        };
        let errors = [
            along([links, &[], &[], rotors, &[], &[]], by_q),
            along([&[], links, &[], &[], rotors, &[]], by_qd),
            along([&[], &[], links, &[], &[], rotors], robot.tree.expected(k)[2]),
        ];
        errors.into_iter().fold(0.0, f64::max)
    }
}

/// The change along one direction per block of columns; along an empty one nothing moves.
fn product<const BLOCKS: usize>(matrix: &[f64], directions: [&[f64]; BLOCKS]) -> Vec<f64> {
    let nv = directions.iter().map(|x| x.len()).max().unwrap_or(0).max(1);
    let row = |row: &[f64]| {
        let blocks = row.chunks_exact(nv).zip(&directions);
        blocks.map(|(block, x)| block.iter().zip(*x).map(|(a, b)| a * b).sum::<f64>()).sum()
    };
    matrix.chunks_exact(BLOCKS * nv).map(row).collect()
}
