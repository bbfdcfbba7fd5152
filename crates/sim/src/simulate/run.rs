//! From instant to instant.

use super::clock::{Clock, Instant};
use super::summary::{Summary, Tally};
use super::{Simulation, StateVec};
use crate::controller::Tick;
use crate::error::{Error, Warning};
use crate::ode::Halt;
use crate::record::Recorder;
use crate::scenario::Integrator;
use std::ops::ControlFlow;
use std::time::Instant as WallClock;

/// Fixed steps after which a run between distant samples is looked at and its caller hears from it.
const STEPS_BETWEEN_CALLS: u64 = 1024;

/// How far a run came.
struct Progress {
    t: f64,
    steps: u64,
    interrupted: bool,
    tally: Tally,
    /// Impacts that were recorded.
    impacts: usize,
    /// Joints whose limits were already reported.
    beyond: Vec<bool>,
}

impl Simulation {
    /// Number of samples an uninterrupted run records, give or take the one at its end.
    pub fn expected_samples(&self) -> u64 {
        self.clock().samples()
    }

    /// Runs the scenario from its start. Now and then, and after every instant, `progress` is told the
    /// simulated time [s] and may stop the run.
    /// The recorder is completed in any case: at the end, on a stop, on a diverging run, on any error.
    ///
    /// # Errors
    /// A run that diverged, with joint and time, or a recorder that failed.
    pub fn run(
        &mut self,
        recorder: &mut dyn Recorder,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Summary, Error> {
        let started = WallClock::now();
        let result = self.instants(recorder, progress);
        let finished = recorder.finish();
        let done = result?;
        finished?;
        let wall_time = started.elapsed().as_secs_f64();
        let scenario = &self.file.scenario;
        Ok(Summary {
            robot: self.robot.name.clone(),
            model: self.robot.fidelity.name(),
            integrator: scenario.integrator.name(),
            duration: scenario.duration,
            end_time: done.t,
            interrupted: done.interrupted,
            samples: done.tally.samples,
            steps: done.steps,
            wall_time,
            real_time_factor: done.t / wall_time.max(f64::MIN_POSITIVE),
            fastest_mode: self.modes.fastest().cloned(),
            largest_step: self.modes.largest_step(&scenario.integrator),
            energy_drift: done.tally.energy_drift(),
            events: self.contacts.events().to_vec(),
            contacts: self.contacts.names().map(str::to_owned).collect(),
            constraint_drift: (!self.contacts.is_empty()).then(|| self.contacts.largest_drift()),
            joints: done.tally.joints(&self.joints, &self.control),
            warnings: self.warnings.iter().map(Warning::to_string).collect(),
        })
    }

    fn clock(&self) -> Clock {
        let scenario = &self.file.scenario;
        Clock::new(scenario.controller.rate(), scenario.log.rate, self.loads.edges(), scenario.duration)
    }

    fn instants(
        &mut self,
        recorder: &mut dyn Recorder,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Progress, Error> {
        self.state.clone_from(&self.initial);
        self.tau.fill(0.0);
        self.control.reset();
        self.control.start(&self.references)?;
        self.warnings.truncate(self.setup_warnings);
        self.loads.set_couple(None, 0);
        self.loads.set_time(0.0);
        if !self.contacts.is_empty() {
            // What there was to say, it said when it was set up.
            let (start, keys) = ((self.tau.as_slice(), &mut self.loads), &self.file.keys);
            self.contacts.start(&mut self.dynamics, &mut self.state, start, keys, &mut Vec::new())?;
        }
        let n = self.joints.len();
        let (tally, beyond) = (Tally::new(n), vec![false; n]);
        let mut done = Progress { t: 0.0, steps: 0, interrupted: false, tally, impacts: 0, beyond };
        for instant in self.clock() {
            if instant.t > done.t {
                self.loads.set_time(done.t);
                let start = done.t;
                let advanced = self.advance(start, instant.t - start, progress);
                self.tell_impacts(recorder, &mut done.impacts)?;
                let (steps, stopped) = advanced?;
                done.steps += steps;
                if let Some(t) = stopped {
                    (done.t, done.interrupted) = (t, true);
                    break;
                }
                self.check_state(instant.t)?;
            }
            done.t = instant.t;
            self.at(instant, recorder, &mut done)?;
            if progress(instant.t).is_break() && !instant.end {
                done.interrupted = true;
                break;
            }
        }
        Ok(done)
    }

    /// What is due at an instant: the controller first, so that the sample shows the torques from here on.
    fn at(&mut self, instant: Instant, recorder: &mut dyn Recorder, done: &mut Progress) -> Result<(), Error> {
        if !instant.control && !instant.log {
            return Ok(());
        }
        self.references.points(instant.t, &mut self.points);
        if let Some(walking) = self.control.walking() {
            walking.reference(instant.t, &mut self.points);
        }
        if instant.control {
            let known = self.nominal.as_mut().map_or(&mut self.dynamics, |n| &mut n.dynamics);
            let at = Tick { t: instant.t, references: &self.references, points: &self.points };
            self.control.tick(known, at, self.state.view(), &mut self.tau)?;
            self.walk(instant.t)?;
            self.agree(instant.t)?;
            self.tell_impacts(recorder, &mut done.impacts)?;
        }
        if !instant.log {
            return Ok(());
        }
        self.loads.set_time(instant.t);
        let (sampler, state) = (&mut self.sampler, self.state.view());
        let contacts = Some(&mut self.contacts).filter(|contacts| !contacts.is_empty());
        sampler.take(instant.t, &mut self.dynamics, state, &self.tau, &mut self.loads, contacts, &self.points)?;
        done.tally.add(&sampler.sample);
        recorder.record(&sampler.sample)?;
        self.watch_limits(instant.t, &mut done.beyond);
        Ok(())
    }

    /// Hands on the impacts that are new, of which `told` are not.
    fn tell_impacts(&self, recorder: &mut dyn Recorder, told: &mut usize) -> Result<(), Error> {
        for impact in self.contacts.impacts().get(*told..).unwrap_or_default() {
            recorder.impact(impact)?;
            *told += 1;
        }
        Ok(())
    }

    /// The same for a robot that something holds. A walk is told of feet that touch down when they do.
    fn advance_held(
        &mut self,
        t: f64,
        length: f64,
        step: f64,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(u64, Option<f64>), Error> {
        let (mut now, end, mut steps) = (t, t + length, 0);
        loop {
            let walks = self.control.walking().is_some();
            let (forces, pace) = ((self.tau.as_slice(), &mut self.loads), (step, walks));
            let (dynamics, state) = (&mut self.dynamics, &mut self.state);
            let advance = self.contacts.advance(dynamics, state, forces, now, end - now, pace, progress)?;
            steps += advance.steps;
            let Some(ended) = advance.ended else { return Ok((steps, None)) };
            if advance.stopped {
                return Ok((steps, Some(ended)));
            }
            now = ended;
            self.walk(now)?;
            self.agree(now)?;
        }
    }

    /// Contacts hear of new torques at once, so that no sample shows a force that they could not exert.
    fn agree(&mut self, t: f64) -> Result<(), Error> {
        if self.contacts.is_empty() {
            return Ok(());
        }
        let forces = (self.tau.as_slice(), &mut self.loads);
        self.contacts.agree(&mut self.dynamics, &mut self.state, forces, t)
    }

    /// What a walk does besides: it hears of feet that touched down, and asks for a couple of the ground.
    fn walk(&mut self, t: f64) -> Result<(), Error> {
        let (events, state) = (self.contacts.events(), self.state.view());
        if let Some(couple) = self.control.walk(t, events, state, &mut self.tau)? {
            self.loads.set_couple(Some(couple), self.robot.bodies.len());
        }
        Ok(())
    }

    /// Integrates over `length` seconds from time `t` under held motor torques. Returns the number of steps, and the time
    /// reached if `progress` stopped it on the way.
    fn advance(
        &mut self,
        t: f64,
        length: f64,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(u64, Option<f64>), Error> {
        let scheme = self.file.scenario.integrator;
        if !self.contacts.is_empty() {
            return self.advance_held(t, length, scheme.fixed_step().unwrap_or(length), progress);
        }
        if let Some(adaptive) = &mut self.adaptive {
            let (state, go_on) = (self.state.view_mut(), &mut |into: f64| progress(t + into));
            return match adaptive.advance(&mut self.dynamics, &mut self.loads, state, &self.tau, length, go_on) {
                Ok(steps) => Ok((steps, None)),
                Err(Halt::Stopped) => Ok((0, Some(t))),
                Err(Halt::Stuck { at, why }) => Err(self.diverged(self.fastest_joint(), t + at, why)),
            };
        }
        let step = scheme.fixed_step().unwrap_or(length);
        // As few equal steps as are not longer than asked for, up to rounding.
        let steps = (length / step * (1.0 - 1e-9)).ceil().max(1.0);
        let h = length / steps;
        for i in 0..steps as u64 {
            let now = t + i as f64 * h;
            if i % STEPS_BETWEEN_CALLS == STEPS_BETWEEN_CALLS - 1 {
                self.check_state(now)?;
                if progress(now).is_break() {
                    return Ok((i, Some(now)));
                }
            }
            self.turn_loads(h)?;
            let (state, ext) = (self.state.view_mut(), self.loads.external());
            match scheme {
                Integrator::SemiImplicitEuler { .. } => {
                    self.dynamics.semi_implicit_euler(state, &self.tau, ext, h)?;
                }
                _ => self.dynamics.rk4(state, &self.tau, ext, h)?,
            }
        }
        Ok((steps as u64, None))
    }

    /// Loads are held over a fixed step in the axes of their links; taking them half-way keeps the error at second order.
    fn turn_loads(&mut self, h: f64) -> Result<(), Error> {
        if self.loads.is_empty() {
            return Ok(());
        }
        let StateVec { q, qd, .. } = &self.state;
        for (half, v) in self.half_step.iter_mut().zip(qd) {
            *half = 0.5 * h * v;
        }
        self.dynamics.integrate(q, &self.half_step, &mut self.halfway)?;
        self.loads.update(&self.dynamics, &self.halfway)?;
        Ok(())
    }

    /// Limits of position and speed do not act on the motion; the user learns when one is passed for the first time.
    fn watch_limits(&mut self, t: f64, beyond: &mut [bool]) {
        for (i, joint) in self.joints.joints.iter().enumerate() {
            if beyond[i] {
                continue;
            }
            let (limits, q, qd) = (&self.robot.joints[joint.body], self.state.q[joint.q], self.state.qd[joint.v]);
            let outside = limits.limits.filter(|[low, high]| q < *low || q > *high);
            let too_fast = limits.max_velocity.filter(|max| qd.abs() > *max);
            let message = match (outside, too_fast) {
                (Some([low, high]), _) => format!("at t = {t} s its position {q:.6} leaves {low} to {high}"),
                (None, Some(max)) => format!("at t = {t} s its speed {:.6} exceeds {max}", qd.abs()),
                (None, None) => continue,
            };
            beyond[i] = true;
            self.warnings.push(Warning {
                file: self.robot.sources.first().map_or_else(String::new, |s| s.name.clone()),
                element: format!("joint `{}`", joint.name),
                message: format!("{message}; the simulation has no end stops and goes on"),
            });
        }
    }
}
