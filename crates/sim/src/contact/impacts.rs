//! Contacts that close with an impact, and modes that agree with the forces.

use super::events::Broken;
use super::points::SLOW;
use super::{Contacts, Event, EventKind, Mode, SHARED, THRESHOLD, chatter, is_shared, may_share};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::loads::Loads;
use crate::simulate::StateVec;
use gyroflex::dynamics::{Constrained, Forward, Impact, Regularisation, Solved};
use gyroflex::spatial::Vec3;

/// Slower than this a point does not leave the ground after an impact [m/s].
const LEAVES: f64 = 1e-9;

/// How a contact goes through an impact.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// Held.
    Stick,
    /// Slipping in a direction.
    Slip(Vec3<f64>),
    /// Held off the ground without friction.
    Cling,
    /// It lets go.
    Leave,
}

impl Contacts {
    /// Does what a broken contact asks for.
    pub(super) fn change(
        &mut self,
        (contact, broken): (usize, Broken),
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        t: f64,
    ) -> Result<(), Error> {
        if std::env::var("DBG").is_ok() { eprintln!("change t {t:.12} {contact} {broken:?} {:?}", self.points.iter().map(|p| (p.mode, p.armed)).collect::<Vec<_>>()); }
        let event = |kind| Event { t, contact, kind, impulse: [0.0; 3] };
        match broken {
            Broken::Ground => return self.touch_down(contact, dynamics, state, t),
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
                }
            }
        }
        self.refresh();
        Ok(())
    }

    fn height(&self) -> f64 {
        self.ground.map_or(0.0, |ground| ground.height)
    }

    fn open(&mut self, contact: usize, dynamics: &Dynamics, state: &StateVec) -> Result<(), Error> {
        let gap = self.place(contact, dynamics, &state.q)?.z - self.height();
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
        self.closed.push(contact);
        self.closed.sort_unstable();
        // Points that slip may be caught by the impact.
        for i in self.closed.clone() {
            let at = self.place(i, dynamics, &state.q)?;
            self.points[i].close(at);
        }
        let width = if ground.planar { 2 } else { 3 };
        // Bodies that rock from foot to foot would do so infinitely many times before they rest.
        let soft = -self.rise(contact, dynamics, &state.q, &state.qd)? < ground.resting_speed;
        let before = state.clone();
        let felt = self.closed.clone();
        let energy = dynamics.energy(state.view())?.kinetic;
        let mut ways = vec![Way::Stick; felt.len()];
        let mut done = self.find_ways((&felt, &mut ways), (soft, ground.friction), dynamics, (&before, state))?;
        if !done || dynamics.energy(state.view())?.kinetic > energy * (1.0 + 1e-12) {
            // Friction of rigid bodies may have no solution, or one that gives energy; without it there is one.
            ways.fill(Way::Cling);
            done = self.find_ways((&felt, &mut ways), (soft, 0.0), dynamics, (&before, state))?;
        }
        if !done {
            ways.fill(Way::Stick);
            state.clone_from(&before);
            self.impact(&felt, &ways, dynamics, state)?;
        }
        self.measure(dynamics, state.view())?;
        let mut row = self.permanent_rows();
        for (i, way) in felt.into_iter().zip(ways) {
            if way == Way::Leave {
                self.events.push(Event { t, contact: i, kind: EventKind::LiftOff, impulse: [0.0; 3] });
                self.open(i, dynamics, state)?;
                continue;
            }
            let p = &self.multipliers[row..row + width];
            let impulse = if width == 2 { [p[0], 0.0, p[1]] } else { [p[0], p[1], p[2]] };
            let leaves = self.velocities[row + width - 1] > LEAVES;
            row += width;
            let kind = match (i == contact, leaves) {
                (true, false) => EventKind::TouchDown,
                (true, true) => EventKind::Bounce,
                (false, true) => EventKind::LiftOff,
                (false, false) => EventKind::Felt,
            };
            self.events.push(Event { t, contact: i, kind, impulse });
            if leaves {
                self.open(i, dynamics, state)?;
                continue;
            }
            let along = &self.velocities[row - width..row];
            let along = Vec3::new(along[0], if width == 2 { 0.0 } else { along[1] }, 0.0);
            match way {
                Way::Slip(direction) => self.points[i].slip(direction),
                Way::Cling if along.norm() > SLOW => self.points[i].slip(along.scale(1.0 / along.norm())),
                Way::Cling => self.points[i].mode = Mode::Stick,
                Way::Stick | Way::Leave => {}
            }
            self.points[i].heed(along);
        }
        self.refresh();
        Ok(())
    }

    /// Looks for ways through the impact that agree with their impulses, from those given. Returns whether there were any.
    fn find_ways(
        &mut self,
        (felt, ways): (&[usize], &mut [Way]),
        (soft, friction): (bool, f64),
        dynamics: &mut Dynamics,
        (before, state): (&StateVec, &mut StateVec),
    ) -> Result<bool, Error> {
        let width = if self.ground.is_some_and(|ground| ground.planar) { 2 } else { 3 };
        // Each point may slip, leave, and be called back once or twice; more changes would go in a circle.
        for _ in 0..=4 * felt.len() {
            state.clone_from(before);
            self.impact(felt, ways, dynamics, state)?;
            let change = match self.unlikely(felt, ways, width, friction, soft) {
                None => self.called_back(felt, ways, dynamics, state, friction)?,
                change => change,
            };
            if std::env::var("DBG").is_ok() { eprintln!("  ways {ways:?} change {change:?} p {:?} ", self.multipliers); }
            let Some((k, way)) = change else { return Ok(true) };
            ways[k] = way;
        }
        Ok(false)
    }

    /// The impact with every closed contact on its way; `self.closed` is then without those that leave.
    fn impact(
        &mut self,
        felt: &[usize],
        ways: &[Way],
        dynamics: &mut Dynamics,
        state: &mut StateVec,
    ) -> Result<(), Error> {
        let Some(ground) = self.ground else { return Ok(()) };
        self.closed.clear();
        for (i, way) in felt.iter().zip(ways) {
            match way {
                Way::Leave => continue,
                Way::Stick => self.points[*i].mode = Mode::Stick,
                Way::Slip(direction) => self.points[*i].slip(*direction),
                Way::Cling => self.points[*i].slip(Vec3::zero()),
            }
            self.closed.push(*i);
        }
        self.refresh();
        self.measure(dynamics, state.view())?;
        let (permanent, mut row) = (self.permanent.len(), self.permanent_rows());
        for k in 0..self.closed.len() {
            row += self.constraints[permanent + k].rows();
            let approach = -self.velocities[row - 1];
            if let Some(contact) = &mut self.constraints[permanent + k].contact {
                contact.restitution = if approach > ground.resting_speed { ground.restitution } else { 0.0 };
            }
        }
        self.blow(dynamics, state, false).map(drop)
    }

    /// A contact whose impulse is not one of its way, and the way that it should go instead: friction that is asked for too much of lets it slip,
    /// and what would still pull lets go, or is pulled after all where the impact is so soft that it is not to fly for it.
    fn unlikely(
        &self,
        felt: &[usize],
        ways: &[Way],
        width: usize,
        friction: f64,
        soft: bool,
    ) -> Option<(usize, Way)> {
        let mut row = self.permanent_rows();
        for (k, way) in ways.iter().enumerate().take(felt.len()) {
            if *way == Way::Leave {
                continue;
            }
            let p = &self.multipliers[row..row + width];
            row += width;
            let along = if width == 2 { Vec3::new(p[0], 0.0, 0.0) } else { Vec3::new(p[0], p[1], 0.0) };
            let (normal, size) = (p[width - 1], along.norm());
            match way {
                Way::Stick if size > friction * normal.max(0.0) * (1.0 + 1e-9) => {
                    return Some((k, Way::Slip(along.scale(-1.0 / size))));
                }
                Way::Cling if soft => {}
                _ if normal < 0.0 => return Some((k, if soft { Way::Cling } else { Way::Leave })),
                _ => {}
            }
        }
        None
    }

    /// A point that let go, but comes down nevertheless: it is to be held after all.
    fn called_back(
        &mut self,
        felt: &[usize],
        ways: &[Way],
        dynamics: &Dynamics,
        state: &StateVec,
        friction: f64,
    ) -> Result<Option<(usize, Way)>, Error> {
        for (k, contact) in felt.iter().enumerate().filter(|(k, _)| ways[*k] == Way::Leave) {
            if self.rise(*contact, dynamics, &state.q, &state.qd)? < -LEAVES {
                return Ok(Some((k, if friction > 0.0 { Way::Stick } else { Way::Cling })));
            }
        }
        Ok(None)
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
            let out = Impact { qd: &mut qd, thetad: &mut thetad, gears: &mut gears };
            let forces = Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrenches };
            dynamics.impact(state.view(), &self.constraints, release, regularisation, out, forces)
        };
        let rank_revealing = Regularisation::rank_revealing(THRESHOLD);
        let mut solved = solve(rank_revealing);
        if !self.closed.is_empty() && solved.as_ref().is_ok_and(may_share) && !solve(SHARED).as_ref().is_ok_and(is_shared) {
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
