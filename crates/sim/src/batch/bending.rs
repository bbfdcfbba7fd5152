//! Robots whose links bend: one state after the other, in `f64`.

use super::algorithm::write_pose;
use super::{Algorithm, Given, Real};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::robot::OwnedModel;
use gyroflex::dynamics::{Acceleration, Bias, CoriolisMatrices, External, Forward, InertiaRates, Inverse, State};
use gyroflex::spatial::Transform;

/// One state, results, and the robot with its scratch.
pub(super) struct One {
    pub(super) dynamics: Dynamics,
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    pub(super) theta: Vec<f64>,
    pub(super) thetad: Vec<f64>,
    pub(super) tau: Vec<f64>,
    qdd: Vec<f64>,
    thetadd: Vec<f64>,
    tau_ext: Vec<f64>,
    /// Each with room for the largest result.
    out: [Vec<f64>; 3],
    poses: Vec<Transform<f64>>,
}

impl One {
    pub(super) fn new(model: &OwnedModel) -> Self {
        let (nq, nv) = (model.nq(), model.nv());
        let zeros = |n| vec![0.0; n];
        Self {
            poses: vec![Transform::identity(); model.view().bodies().len()],
            dynamics: Dynamics::new(model.clone()),
            q: zeros(nq),
            qd: zeros(nv),
            theta: zeros(nv),
            thetad: zeros(nv),
            tau: zeros(nv),
            qdd: zeros(nv),
            thetadd: zeros(nv),
            tau_ext: zeros(nv),
            out: core::array::from_fn(|_| zeros((nv * nv).max(6 * nv).max(16))),
        }
    }

    /// Takes the state of a row.
    pub(super) fn load<F: Real>(&mut self, given: Given<F>, row: usize) {
        let Given { q, qd, theta, thetad, qdd, thetadd, tau, tau_ext } = given;
        take(q, row, &mut self.q);
        take(qd, row, &mut self.qd);
        take(theta, row, &mut self.theta);
        take(thetad, row, &mut self.thetad);
        take(qdd, row, &mut self.qdd);
        take(thetadd, row, &mut self.thetadd);
        take(tau, row, &mut self.tau);
        take(tau_ext, row, &mut self.tau_ext);
    }

    pub(super) fn run(&mut self, algorithm: &Algorithm) -> Result<(), Error> {
        let columns = algorithm.columns(self.dynamics.nv());
        let room = |i: usize| columns.get(i).copied().unwrap_or(0);
        let Self { dynamics, q, qd, theta, thetad, tau, qdd, thetadd, tau_ext, out: [a, b, c], poses } = self;
        let (a, b, c) = (&mut a[..room(0)], &mut b[..room(1)], &mut c[..room(2)]);
        let state = State { q: &*q, qd, theta, thetad };
        let ext = External { tau: &*tau_ext, wrenches: &[] };
        match algorithm {
            Algorithm::ForwardDynamics => dynamics.forward(state, tau, ext, Forward { qdd: a, thetadd: b, tau_j: c }),
            Algorithm::InverseDynamics => {
                dynamics.inverse(state, Acceleration { qdd, thetadd }, ext, Inverse { tau_j: a, tau: b })
            }
            Algorithm::MassMatrix => dynamics.mass_matrix(q, a),
            Algorithm::CouplingMatrix => dynamics.coupling(q, a),
            Algorithm::CoriolisMatrices => dynamics.coriolis_matrices(state, CoriolisMatrices { c: a, c1: b, c2: c }),
            Algorithm::InertiaRates => dynamics.inertia_rates(state, InertiaRates { m: a, s: b }),
            Algorithm::Bias => dynamics.bias(state, Bias { link: a, motor: b }),
            Algorithm::GravityTorques => dynamics.gravity_torques(q, a),
            Algorithm::Energy => {
                let energy = dynamics.energy(state)?;
                (a[0], b[0], c[0]) = (energy.kinetic, energy.gravity, energy.elastic);
                Ok(())
            }
            Algorithm::Placement(frame) => {
                dynamics.placements(q, poses)?;
                write_pose(frame.pose(poses, dynamics.eta(q)), a);
                Ok(())
            }
            Algorithm::Jacobian(frame, axes) => frame.jacobian(dynamics, q, *axes, a),
        }
    }

    /// Hands over the first numbers of a result.
    pub(super) fn write<F: Real>(&self, result: usize, to: &mut [F]) {
        to.iter_mut().zip(&self.out[result]).for_each(|(to, from)| *to = F::from_f64(*from));
    }
}

/// The row of an array, or its only one. Nothing given leaves the zeros that are there.
pub(super) fn take<F: Real>(from: &[F], row: usize, to: &mut [f64]) {
    let start = if from.len() > to.len() { row * to.len() } else { 0 };
    to.iter_mut().zip(from.iter().skip(start)).for_each(|(to, from)| *to = (*from).into());
}
