//! Feedback of the whole state around the motion of an inverse, with the gain of a linear-quadratic regulator.

use super::inverse::Feedforward;
use crate::coordinates::Coordinates;
use crate::error::Error;
use crate::load::yaml::Keys;
use crate::lqr::{Deviations, Regulator};
use crate::reference::References;
use crate::robot::Robot;
use crate::scenario::{LqrDeviations, fault};
use gyroflex::control::StateFeedback;
use gyroflex::dynamics::State;

/// The controller.
#[derive(Clone, Debug)]
pub(super) struct Lqr {
    pub(super) feedforward: Feedforward,
    /// `K` by rows.
    gain: Vec<f64>,
    /// Velocity coordinates of the joints with an elastic transmission.
    elastic: Vec<usize>,
    desired: Vec<f64>,
    measured: Vec<f64>,
}

impl Lqr {
    /// The gain is that of the robot in equilibrium where its references are at `end` [s].
    ///
    /// # Errors
    /// A robot for which there is no regulator.
    pub(super) fn new(
        feedforward: Feedforward,
        deviations: &LqrDeviations,
        rate: f64,
        robot: &Robot,
        joints: &Coordinates,
        (references, end): (&References, f64),
        keys: &Keys,
    ) -> Result<Self, Error> {
        let q: Vec<f64> = (0..joints.len()).map(|i| references.point(i, end).q).collect();
        let deviations = Deviations {
            link_position: deviations.link_position,
            link_velocity: deviations.link_velocity,
            motor_position: deviations.motor_position,
            motor_velocity: deviations.motor_velocity,
            torque: deviations.torque,
        };
        let regulator = Regulator::new(robot, &q, rate, &deviations)
            .map_err(|e| fault(keys, "controller.deviations", e.problem, e.remedy))?;
        let model = robot.model(robot.fidelity)?;
        let elastic = model.view().bodies().iter().filter(|b| b.is_elastic()).map(|b| b.v_index()).collect();
        let states = regulator.gain.ncols();
        // By rows.
        let gain = regulator.gain.transpose().as_slice().to_vec();
        Ok(Self { feedforward, gain, elastic, desired: vec![0.0; states], measured: vec![0.0; states] })
    }

    /// Motor torques for the reference at time `t` [s] and the whole state.
    pub(super) fn tick(
        &mut self,
        references: &References,
        t: f64,
        state: State<f64>,
        tau: &mut [f64],
    ) -> Result<(), Error> {
        let Self { feedforward, gain, elastic, desired, measured } = self;
        feedforward.tick(references, t)?;
        let motors = feedforward.motors();
        collect(
            desired,
            elastic,
            State { q: feedforward.q(), qd: feedforward.qd(), theta: motors.theta, thetad: motors.thetad },
        );
        collect(measured, elastic, state);
        tau.copy_from_slice(feedforward.tau());
        Ok(StateFeedback { gain }.add(desired, measured, tau)?)
    }
}

/// `x = (q, θ, q̇, θ̇)`, motors of elastic joints only.
fn collect(x: &mut [f64], elastic: &[usize], state: State<f64>) {
    let of = |all: &'_ [f64]| elastic.iter().map(|k| all[*k]).collect::<Vec<_>>();
    let (theta, thetad) = (of(state.theta), of(state.thetad));
    let all = state.q.iter().chain(&theta).chain(state.qd).chain(&thetad);
    x.iter_mut().zip(all).for_each(|(x, value)| *x = *value);
}
