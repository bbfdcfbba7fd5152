//! Runge-Kutta steps of a robot that is held, cut where its contacts change.

use super::events::Broken;
use super::{Contacts, Mode, chatter};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::loads::Loads;
use crate::simulate::StateVec;
use gyroflex::dynamics::{Forward, State};
use gyroflex::integrate::position_rate;
use std::ops::ControlFlow;

/// Halvings of a step until its part is next to nothing.
const BISECTIONS: usize = 48;
/// More changes within a step than a robot has reason for.
const CHANGES: usize = 64;

/// Storage of one step: position, velocity, motor position, motor velocity.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    start: StateVec,
    at: StateVec,
    /// Rates of the stages.
    rates: [StateVec; 4],
}

impl Stages {
    pub(super) fn new(nq: usize, nv: usize) -> Self {
        let zeros = StateVec::zeros(nq, nv);
        Self { start: zeros.clone(), at: zeros.clone(), rates: [(); 4].map(|()| zeros.clone()) }
    }
}

/// Nodes of the classical scheme, and weights of its rates.
const NODES: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
const WEIGHTS: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

fn parts(x: &mut StateVec) -> [&mut Vec<f64>; 4] {
    [&mut x.q, &mut x.qd, &mut x.theta, &mut x.thetad]
}

fn add(to: &mut StateVec, rates: &StateVec, h: f64) {
    let from = [&rates.q, &rates.qd, &rates.theta, &rates.thetad];
    for (to, from) in parts(to).into_iter().zip(from) {
        for (to, from) in to.iter_mut().zip(from) {
            *to += h * from;
        }
    }
}

fn copy(to: &mut StateVec, from: &StateVec) {
    let from = [&from.q, &from.qd, &from.theta, &from.thetad];
    for (to, from) in parts(to).into_iter().zip(from) {
        to.copy_from_slice(from);
    }
}

/// How far an integration came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advance {
    /// Number of steps.
    pub steps: u64,
    /// When it ended, if before its time [s].
    pub ended: Option<f64>,
    /// Whether that was asked for from outside.
    pub stopped: bool,
}

impl Contacts {
    /// Integrates over `length` seconds from time `t` in steps of at most `step`, motor torques held, or up to the instant at which a contact comes down if
    /// `to_touch_down`: a controller may want to know. Now and then `progress` is told the time and may stop.
    ///
    /// # Errors
    /// A slice that does not fit the model, and contacts that change without end.
    #[expect(clippy::too_many_arguments, reason = "a run has so many parts")]
    pub fn advance(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        (tau, loads): (&[f64], &mut Loads),
        t: f64,
        length: f64,
        (step, to_touch_down): (f64, bool),
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Advance, Error> {
        let steps = (length / step * (1.0 - 1e-9)).ceil().max(1.0);
        let h = length / steps;
        for i in 0..steps as u64 {
            let now = t + i as f64 * h;
            if i % 1024 == 1023 && progress(now).is_break() {
                return Ok(Advance { steps: i, ended: Some(now), stopped: true });
            }
            let done = self.step(dynamics, state, (tau, &mut *loads), now, h, to_touch_down)?;
            if done < h {
                return Ok(Advance { steps: i + 1, ended: Some(now + done), stopped: false });
            }
        }
        Ok(Advance { steps: steps as u64, ended: None, stopped: false })
    }

    /// One step, in parts if contacts change. Returns how much of it was done.
    fn step(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        (tau, loads): (&[f64], &mut Loads),
        t: f64,
        h: f64,
        to_touch_down: bool,
    ) -> Result<f64, Error> {
        let mut done = 0.0;
        for _ in 0..CHANGES {
            let left = h - done;
            copy(&mut self.stages.start, state);
            self.try_step(dynamics, (tau, &mut *loads), left)?;
            if self.broken_now(dynamics, (tau, &mut *loads))?.is_none() {
                copy(state, &self.stages.at);
                self.note_drift(dynamics, state)?;
                return Ok(h);
            }
            // The least part of the step after which something is broken.
            let (mut whole, mut broken) = (0.0, left);
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (whole + broken);
                self.try_step(dynamics, (tau, &mut *loads), middle)?;
                if self.broken_now(dynamics, (tau, &mut *loads))?.is_some() {
                    broken = middle;
                } else {
                    whole = middle;
                }
            }
            self.try_step(dynamics, (tau, &mut *loads), broken)?;
            let found = self.broken_now(dynamics, (tau, &mut *loads))?;
            copy(state, &self.stages.at);
            done += broken;
            if let Some(found) = found {
                self.change(found, dynamics, state, t + done)?;
                if to_touch_down && found.1 == Broken::Ground {
                    return Ok(done);
                }
            }
            self.settle(dynamics, state, (tau, &mut *loads), t + done)?;
            if done >= h {
                return Ok(h);
            }
        }
        let name = self.events.last().map_or("", |e| self.points[e.contact].name.as_str()).to_owned();
        Err(chatter(t + done, &name))
    }

    fn broken_now(
        &mut self,
        dynamics: &mut Dynamics,
        (tau, loads): (&[f64], &mut Loads),
    ) -> Result<Option<(usize, Broken)>, Error> {
        let at = core::mem::replace(&mut self.stages.at, StateVec::zeros(0, 0));
        let broken = self.broken(dynamics, at.view(), (tau, loads));
        self.stages.at = at;
        broken
    }

    /// The classical Runge-Kutta scheme from `stages.start` over `h`, into `stages.at`.
    fn try_step(&mut self, dynamics: &mut Dynamics, (tau, loads): (&[f64], &mut Loads), h: f64) -> Result<(), Error> {
        let mut stages = core::mem::replace(&mut self.stages, Stages::new(0, 0));
        let done = (0..4).try_for_each(|k| {
            copy(&mut stages.at, &stages.start);
            if k > 0 {
                let (before, _) = stages.rates.split_at(k);
                add(&mut stages.at, &before[k - 1], NODES[k] * h);
            }
            let StateVec { q, qd, theta, thetad } = &stages.at;
            let state = State { q, qd, theta, thetad };
            let rates = &mut stages.rates[k];
            position_rate(&dynamics.model(), q, qd, &mut rates.q)?;
            rates.theta.copy_from_slice(thetad);
            let mut tau_j = core::mem::take(&mut self.motion[2]);
            let out = Forward { qdd: &mut rates.qd, thetadd: &mut rates.thetad, tau_j: &mut tau_j };
            let solved = self.forward(dynamics, state, tau, loads, out);
            self.motion[2] = tau_j;
            solved.map(drop)
        });
        copy(&mut stages.at, &stages.start);
        for (rates, weight) in stages.rates.iter().zip(WEIGHTS) {
            add(&mut stages.at, rates, weight * h);
        }
        if dynamics.model().is_floating() {
            let norm = stages.at.q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
            stages.at.q[3..7].iter_mut().for_each(|x| *x /= norm);
        }
        self.stages = stages;
        done
    }

    fn note_drift(&mut self, dynamics: &mut Dynamics, state: &StateVec) -> Result<(), Error> {
        self.measure(dynamics, state.view())?;
        if let Some(ground) = self.ground {
            // What has come up closes again on the ground, not just below it where it opened.
            dynamics.placements(&state.q, &mut self.poses)?;
            for point in &mut self.points {
                let gap = point.place(&self.poses).z - ground.height;
                point.armed = point.armed.max(gap.min(0.0));
            }
        }
        for k in 0..self.closed.len() {
            let i = self.closed[k];
            if self.points[i].mode == Mode::Slip {
                let velocity = self.along_ground(i);
                self.points[i].heed(velocity);
            }
        }
        // What slips is not held along the ground.
        let (mut row, slipping) = (0, |c: &gyroflex::dynamics::Constraint<f64>, d: usize| {
            c.contact.is_some_and(|c| c.slip.is_some() && d != c.normal)
        });
        for constraint in &self.constraints {
            for d in (0..6).filter(|d| holds(constraint, *d)) {
                if !slipping(constraint, d) {
                    self.largest_drift = self.largest_drift.max(self.errors[row].abs());
                }
                row += 1;
            }
        }
        Ok(())
    }
}

fn holds(constraint: &gyroflex::dynamics::Constraint<f64>, direction: usize) -> bool {
    match &constraint.hold {
        gyroflex::dynamics::Hold::Frame { directions, .. } => directions.contains(direction),
        gyroflex::dynamics::Hold::Joints { .. } => direction == 0,
    }
}
