//! Contacts that close with an impact, and modes that agree with the forces.

use super::events::Broken;
use super::points::SLOW;
use super::{Contacts, Event, EventKind, Mode, THRESHOLD, chatter};
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
                    let (at, height) = (self.place(contact, dynamics, &state.q)?, self.height());
                    self.points[contact].close(at, height);
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
        self.points[contact].close(at, ground.height);
        self.closed.push(contact);
        self.closed.sort_unstable();
        // Points that slip may be caught by the impact.
        for i in self.closed.clone() {
            let at = self.place(i, dynamics, &state.q)?;
            self.points[i].close(at, ground.height);
        }
        let width = if ground.planar { 2 } else { 3 };
        let before = (state.qd.clone(), state.thetad.clone());
        let felt = self.closed.clone();
        let mut ways = vec![Way::Stick; felt.len()];
        // Each point may slip, and then leave; more changes would go in a circle.
        for _ in 0..=2 * felt.len() {
            (state.qd.clone_from(&before.0), state.thetad.clone_from(&before.1));
            self.impact(&felt, &ways, dynamics, state)?;
            match self.unlikely(&felt, &ways, width, ground.friction) {
                Some((k, way)) => ways[k] = way,
                None => break,
            }
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
            } else if let Way::Slip(direction) = way {
                self.points[i].slip(direction);
                let along = &self.velocities[row - width..row];
                self.points[i].heed(Vec3::new(along[0], if width == 2 { 0.0 } else { along[1] }, 0.0));
            }
        }
        self.refresh();
        Ok(())
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
    /// and what would still pull lets go.
    fn unlikely(&self, felt: &[usize], ways: &[Way], width: usize, friction: f64) -> Option<(usize, Way)> {
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
                _ if normal < 0.0 => return Some((k, Way::Leave)),
                _ => {}
            }
        }
        None
    }

    /// An impact of all that is held; velocities jump.
    pub(super) fn blow(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        release: bool,
    ) -> Result<Solved<f64>, Error> {
        let [mut qd, mut thetad, mut gears] = core::mem::take(&mut self.motion);
        let out = Impact { qd: &mut qd, thetad: &mut thetad, gears: &mut gears };
        let forces = Constrained { multipliers: &mut self.multipliers, wrenches: &mut self.wrenches };
        let regularisation = Regularisation::rank_revealing(THRESHOLD);
        let solved = dynamics.impact(state.view(), &self.constraints, release, regularisation, out, forces);
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
        for _ in 0..=8 * self.points.len() {
            let Some(broken) = self.broken(dynamics, state.view(), (tau, &mut *loads))? else {
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
