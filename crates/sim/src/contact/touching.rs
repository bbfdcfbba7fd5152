//! Points that rest on the ground without being held by it.

use super::{Contacts, Event, EventKind, Mode};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::loads::Loads;
use crate::simulate::StateVec;
use gyroflex::dynamics::Forward;
use gyroflex::integrate::integrate;

/// A point as near to where it may close, and as slow, touches the ground [m, m/s].
const NEAR: f64 = 1e-9;
const SLOW: f64 = 1e-7;
/// Span over which velocities are compared [s].
const SPAN: f64 = 1e-6;
/// A point that is pressed on the ground accelerates into it faster than rounding lets it seem [m/s²].
const PRESSED: f64 = 1e-6;

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
        let mut later = state.clone();
        let way: Vec<f64> = state.qd.iter().map(|v| SPAN * v).collect();
        later.qd.iter_mut().zip(&qdd).for_each(|(v, a)| *v += SPAN * a);
        self.motion = [qdd, thetadd, tau_j];
        solved?;
        integrate(&dynamics.model(), &state.q, &way, &mut later.q)?;
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
                if std::env::var("DBG").is_ok() { eprintln!("pressed t {t:.12} {i} {change}"); }
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
