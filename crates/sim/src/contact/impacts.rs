//! Contacts that close with an impact, and modes that agree with the forces.

use super::events::Broken;
use super::points::SLOW;
use super::{Contacts, Event, EventKind, Mode, SHARED, THRESHOLD, chatter, is_shared, may_share};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::loads::Loads;
use crate::record::{Impact, Struck};
use crate::scenario::Ground;
use crate::simulate::StateVec;
use gyroflex::dynamics::{self, Constrained, Forward, Regularisation, Solved};

/// Slower than this a point does not leave the ground after an impact [m/s].
const LEAVES: f64 = 1e-9;

impl Contacts {
    /// Does what a broken contact asks for.
    pub(super) fn change(
        &mut self,
        (contact, broken): (usize, Broken),
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        t: f64,
    ) -> Result<(), Error> {
        let event = |kind| Event { t, contact, kind, impulse: [0.0; 3] };
        match broken {
            Broken::Ground | Broken::Jam => return self.touch_down(contact, dynamics, state, t),
            Broken::Pull => {
                self.open(contact, dynamics, state)?;
                self.events.push(event(EventKind::LiftOff));
            }
            Broken::Friction(direction) => {
                self.points[contact].slip(direction);
                self.events.push(event(EventKind::Slip));
            }
            Broken::Reversed => {
                self.measure(dynamics, state.view())?;
                let velocity = self.along_ground(contact);
                let speed = velocity.norm();
                if self.points[contact].direction.cross(velocity).norm() > SLOW {
                    // It was turned round within a step, and never rested.
                    self.points[contact].slip(velocity.scale(1.0 / speed));
                } else {
                    let at = self.place(contact, dynamics, &state.q)?;
                    self.points[contact].close(at);
                    self.events.push(event(EventKind::Stick));
                    // What is left of its speed would have it seem to turn back.
                    self.refresh();
                    self.blow(dynamics, state, false)?;
                }
            }
        }
        self.refresh();
        Ok(())
    }

    fn open(&mut self, contact: usize, dynamics: &Dynamics, state: &StateVec) -> Result<(), Error> {
        let height = self.ground.map_or(0.0, |ground| ground.height);
        let gap = self.place(contact, dynamics, &state.q)?.z - height;
        self.points[contact].mode = Mode::Open;
        self.points[contact].armed = gap.min(0.0);
        self.closed.retain(|i| *i != contact);
        Ok(())
    }

    /// A point comes down: all closed contacts feel it.
    fn touch_down(
        &mut self,
        contact: usize,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        t: f64,
    ) -> Result<(), Error> {
        let Some(ground) = self.ground else { return Ok(()) };
        let at = self.place(contact, dynamics, &state.q)?;
        self.points[contact].close(at);
        let strikes = !self.closed.contains(&contact);
        if strikes {
            self.closed.push(contact);
            self.closed.sort_unstable();
        }
        // Points that slip may be caught by the impact.
        for i in self.closed.clone() {
            let at = self.place(i, dynamics, &state.q)?;
            self.points[i].close(at);
        }
        self.refresh();
        // Bodies that rock from foot to foot would do so infinitely many times before they rest: where the blow is so soft, no foot leaves by it.
        let soft = -self.rise(contact, dynamics, &state.q, &state.qd)? <= ground.resting_speed;
        self.measure(dynamics, state.view())?;
        let before: Vec<_> = self.closed.iter().map(|i| self.velocity(*i)).collect();
        let energy = dynamics.energy(state.view())?.kinetic;
        let impulses = self.collide(dynamics, state, &ground, soft)?;
        self.measure(dynamics, state.view())?;
        let struck = self.closed.iter().zip(&impulses).zip(before).map(|((i, impulse), before)| Struck {
            contact: *i,
            impulse: *impulse,
            before,
            after: self.velocity(*i),
        });
        let struck = struck.collect();
        self.impacts.push(Impact { t, struck, energy_lost: energy - dynamics.energy(state.view())?.kinetic });
        for (i, impulse) in self.closed.clone().into_iter().zip(impulses) {
            let (off, along) = (self.off_ground(i), self.along_ground(i));
            let leaves = off > LEAVES && !soft;
            let kind = match (strikes && i == contact, leaves) {
                (true, false) => EventKind::TouchDown,
                (true, true) => EventKind::Bounce,
                (false, true) => EventKind::LiftOff,
                (false, false) => EventKind::Felt,
            };
            self.events.push(Event { t, contact: i, kind, impulse });
            if leaves {
                self.points[i].mode = Mode::Open;
            } else if along.norm() > SLOW {
                self.points[i].slip(along.scale(1.0 / along.norm()));
                self.points[i].heed(along);
            }
        }
        for i in self.closed.clone() {
            if self.points[i].mode == Mode::Open {
                self.open(i, dynamics, state)?;
            }
        }
        self.refresh();
        Ok(())
    }

    /// Velocity of a closed contact in world axes when it was measured last [m/s].
    fn velocity(&self, contact: usize) -> [f64; 3] {
        let along = self.along_ground(contact);
        [along.x, along.y, self.off_ground(contact)]
    }

    /// Velocities after an impact of all closed contacts, and their impulses in world axes [N s].
    fn collide(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        ground: &Ground,
        soft: bool,
    ) -> Result<Vec<[f64; 3]>, Error> {
        let before = state.clone();
        let energy = dynamics.energy(state.view())?.kinetic;
        let width = if ground.planar { 2 } else { 3 };
        let in_space = |p: &[f64]| if width == 2 { [p[0], 0.0, p[1]] } else { [p[0], p[1], p[2]] };
        // Most impacts are those of feet that hold, which is solved as exactly as motion is.
        self.rebound(dynamics, state, ground)?;
        let solved = self.blow(dynamics, state, false)?;
        let rows = &self.multipliers[self.permanent_rows()..];
        let holds = |p: [f64; 3]| p[2] >= 0.0 && p[0].hypot(p[1]) <= ground.friction * p[2] * (1.0 + 1e-9);
        let grown = |after: f64| after > energy * (1.0 + 1e-12);
        if solved.dependent == 0.0 && rows.chunks(width).all(|p| holds(in_space(p))) {
            let impulses = rows.chunks(width).map(in_space).collect();
            if !grown(dynamics.energy(state.view())?.kinetic) {
                return Ok(impulses);
            }
        }
        state.clone_from(&before);
        let responses = self.responses(dynamics, state, ground)?;
        let mut p = responses.impulses(ground, ground.restitution, soft);
        responses.give(&p, state);
        if ground.restitution > 0.0 && grown(dynamics.energy(state.view())?.kinetic) {
            // Newton's law may give energy where several points strike with friction.
            state.clone_from(&before);
            p = responses.impulses(ground, 0.0, soft);
            responses.give(&p, state);
        }
        Ok(p.chunks(width).map(in_space).collect())
    }

    /// Restitution of what approaches faster than `resting_speed`.
    fn rebound(&mut self, dynamics: &mut Dynamics, state: &StateVec, ground: &Ground) -> Result<(), Error> {
        self.measure(dynamics, state.view())?;
        let (permanent, mut row) = (self.permanent.len(), self.permanent_rows());
        for k in 0..self.closed.len() {
            row += self.constraints[permanent + k].rows();
            let approach = -self.velocities[row - 1];
            if let Some(contact) = &mut self.constraints[permanent + k].contact {
                contact.restitution = if approach > ground.resting_speed { ground.restitution } else { 0.0 };
            }
        }
        Ok(())
    }

    /// An impact of all that is held; velocities jump.
    pub(super) fn blow(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        release: bool,
    ) -> Result<Solved<f64>, Error> {
        let [mut qd, mut thetad, mut gears] = core::mem::take(&mut self.motion);
        let mut solve = |regularisation| {
            let out = dynamics::Impact { qd: &mut qd, thetad: &mut thetad, gears: &mut gears };
            let forces = Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrenches };
            dynamics.impact(state.view(), &self.constraints, release, regularisation, out, forces)
        };
        let rank_revealing = Regularisation::rank_revealing(THRESHOLD);
        let mut solved = solve(rank_revealing);
        if !self.closed.is_empty()
            && solved.as_ref().is_ok_and(may_share)
            && !solve(SHARED).as_ref().is_ok_and(is_shared)
        {
            solved = solve(rank_revealing);
        }
        if solved.is_ok() {
            state.qd.copy_from_slice(&qd);
            state.thetad.copy_from_slice(&thetad);
        }
        self.motion = [qd, thetad, gears];
        solved
    }

    /// Changes modes until they agree with the forces, and says how the constraints do.
    pub(super) fn settle(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        (tau, loads): (&[f64], &mut Loads),
        t: f64,
    ) -> Result<Solved<f64>, Error> {
        // Each contact may close, slip, stick and open; more means that they push each other around.
        let mut calls = self.points.len();
        for _ in 0..=8 * self.points.len() {
            let Some(broken) = self.broken(dynamics, state.view(), (tau, &mut *loads))? else {
                if calls > 0 && self.close_pressed(dynamics, state, (tau, &mut *loads), t)? {
                    calls -= 1;
                    continue;
                }
                let [mut qdd, mut thetadd, mut tau_j] = core::mem::take(&mut self.motion);
                let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
                let solved = self.forward(dynamics, state.view(), tau, loads, out);
                self.motion = [qdd, thetadd, tau_j];
                return solved;
            };
            self.change(broken, dynamics, state, t)?;
        }
        let name = self.points.first().map_or("", |p| p.name.as_str()).to_owned();
        Err(chatter(t, &name))
    }
}
