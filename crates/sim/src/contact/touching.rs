//! Points that rest on the ground without being held by it.

use super::events::Broken;
use super::{Contacts, Event, EventKind, Mode, THRESHOLD};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::loads::Loads;
use crate::simulate::StateVec;
use gyroflex::dynamics::{Constrained, ConstraintMotion, Forward, Regularisation, State};
use gyroflex::integrate::integrate;
use gyroflex::spatial::{Force, Vec3};

/// A point as near to where it may close, and as slow, touches the ground [m, m/s].
const NEAR: f64 = 1e-9;
const SLOW: f64 = 1e-7;
/// Span over which velocities are compared [s].
const SPAN: f64 = 1e-6;
/// A point that is pressed on the ground accelerates into it faster than rounding lets it seem [m/s²].
const PRESSED: f64 = 1e-6;
/// A point that slips as slowly as that is at rest, and may be held [m/s].
const REST: f64 = 2e-6;
/// Acceleration along the ground that is left to a point that is held: that part of the largest one.
const CREEP: f64 = 1e-5;

impl Contacts {
    /// Velocity of a point off the ground [m/s].
    pub(super) fn rise(&mut self, contact: usize, dynamics: &Dynamics, q: &[f64], qd: &[f64]) -> Result<f64, Error> {
        dynamics.placements(q, &mut self.poses)?;
        dynamics.velocities(q, qd, &mut self.rates)?;
        let point = &self.points[contact];
        let rate = self.rates[point.body];
        Ok((self.poses[point.body].rotation() * (rate.lin + rate.ang.cross(point.point))).z)
    }

    /// Closes an open point that touches the ground at rest and would accelerate into it: it is pressed on, without an impact. Returns whether there
    /// was one.
    pub(super) fn close_pressed(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        (tau, loads): (&[f64], &mut Loads),
        t: f64,
    ) -> Result<bool, Error> {
        let Some(ground) = self.ground else { return Ok(false) };
        let mut touching = None;
        for i in 0..self.points.len() {
            if self.points[i].mode != Mode::Open {
                continue;
            }
            let gap = self.place(i, dynamics, &state.q)?.z - ground.height;
            if gap < self.points[i].armed + NEAR && self.rise(i, dynamics, &state.q, &state.qd)?.abs() < SLOW {
                touching = Some(i);
                break;
            }
        }
        // Most robots stand on all that touches the ground, or have their other feet in the air.
        let Some(first) = touching else { return Ok(false) };
        let [mut qdd, mut thetadd, mut tau_j] = core::mem::take(&mut self.motion);
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        let solved = self.forward(dynamics, state.view(), tau, loads, out);
        let later = later(dynamics, state.view(), &qdd);
        self.motion = [qdd, thetadd, tau_j];
        solved?;
        let later = later?;
        for i in first..self.points.len() {
            if self.points[i].mode != Mode::Open {
                continue;
            }
            let at = self.place(i, dynamics, &state.q)?;
            let now = self.rise(i, dynamics, &state.q, &state.qd)?;
            let change = self.rise(i, dynamics, &later.q, &later.qd)? - now;
            let touches = at.z - ground.height < self.points[i].armed + NEAR && now.abs() < SLOW;
            if touches && change < -PRESSED * SPAN {
                self.points[i].close(at);
                self.closed.push(i);
                self.closed.sort_unstable();
                // What let go at this instant has not done so after all.
                let left = |e: &Event| e.t == t && e.contact == i && e.kind == EventKind::LiftOff;
                let jams = self.events.iter().rposition(left);
                match jams {
                    Some(k) => drop(self.events.remove(k)),
                    None => self.events.push(Event { t, contact: i, kind: EventKind::TouchDown, impulse: [0.0; 3] }),
                }
                self.refresh();
                if jams.is_some() {
                    // It can neither slip nor let go (Painlevé): it is stopped.
                    self.blow(dynamics, state, false)?;
                }
                return Ok(true);
            }
        }
        Ok(false)
    }
}

/// Positions and velocities a moment later, under accelerations.
fn later(dynamics: &Dynamics, state: State<f64>, qdd: &[f64]) -> Result<StateVec, Error> {
    let mut later = StateVec::zeros(state.q.len(), state.qd.len());
    let way: Vec<f64> = state.qd.iter().map(|v| SPAN * v).collect();
    later.qd.iter_mut().zip(state.qd).zip(qdd).for_each(|((to, v), a)| *to = v + SPAN * a);
    integrate(&dynamics.model(), state.q, &way, &mut later.q)?;
    Ok(later)
}

impl Contacts {
    /// Which of the closed contacts is not as forces of all of them can be, and what it does instead: for contacts that depend on each other,
    /// where each of many shares of the load is possible if it is possible for all. Points that slide keep to their direction.
    pub(super) fn verdict(
        &mut self,
        dynamics: &mut Dynamics,
        state: State<f64>,
        (tau, loads): (&[f64], &mut Loads),
    ) -> Result<Option<(usize, Broken)>, Error> {
        let Some(ground) = self.ground else { return Ok(None) };
        loads.update(dynamics, state.q)?;
        let feet = self.constraints[self.permanent.len()..].to_vec();
        let nv = dynamics.nv();
        let [mut qdd, mut thetadd, mut tau_j] = [(); 3].map(|()| vec![0.0; nv]);
        let mut multipliers = vec![0.0; self.permanent_rows()];
        let mut wrenches = vec![Force::zero(); self.permanent.len()];
        dynamics.constrained_forward(
            state,
            tau,
            loads.external(),
            &self.permanent,
            Regularisation::rank_revealing(THRESHOLD),
            Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
            Constrained { multipliers: &mut multipliers, wrenches: &mut wrenches },
        )?;
        let (now, next) = (self.at(state), later(dynamics, state, &qdd)?);
        let mut responses = self.responses(dynamics, &now, &ground)?;
        let velocities = responses.before.clone();
        let out = ConstraintMotion { error: &mut [], velocity: &mut responses.before, jacobian: &mut [] };
        dynamics.constraint_motion(&next.q, &next.qd, &feet, out)?;
        responses.before.iter_mut().zip(&velocities).for_each(|(a, v)| *a = (*a - v) / SPAN);
        let largest = responses.before.iter().fold(1.0_f64, |m, a| m.max(a.abs()));

        let width = if ground.planar { 2 } else { 3 };
        let along = |row: &[f64]| Vec3::new(row[0], if width == 2 { 0.0 } else { row[1] }, 0.0);
        let sliding: Vec<Option<Vec3<f64>>> = (self.closed.iter().zip(velocities.chunks(width)))
            .map(|(i, v)| {
                let (point, velocity) = (&self.points[*i], along(v));
                let slides = point.mode == Mode::Slip && velocity.norm() > REST;
                slides.then(|| point.ratio(velocity, ground.friction))
            })
            .collect();
        let (forces, left) = responses.forces(ground.friction, &sliding);
        let small = CREEP * largest;
        for (((i, p), a), sliding) in self.closed.iter().zip(forces.chunks(width)).zip(left.chunks(width)).zip(&sliding)
        {
            let (mode, direction) = (self.points[*i].mode, along(a));
            if p[width - 1] <= 0.0 && a[width - 1] > small {
                return Ok(Some((*i, Broken::Pull)));
            }
            if sliding.is_some() {
                continue;
            }
            match (mode, direction.norm() > small) {
                (Mode::Stick, true) => {
                    return Ok(Some((*i, Broken::Friction(direction.scale(1.0 / direction.norm())))));
                }
                (Mode::Slip, false) => return Ok(Some((*i, Broken::Reversed))),
                _ => {}
            }
        }
        Ok(None)
    }

    fn at(&self, state: State<f64>) -> StateVec {
        let State { q, qd, theta, thetad } = state;
        StateVec { q: q.to_vec(), qd: qd.to_vec(), theta: theta.to_vec(), thetad: thetad.to_vec() }
    }
}
