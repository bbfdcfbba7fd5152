//! What happens to contacts, and whether it has happened by some instant.

use super::{Contacts, Mode};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::loads::Loads;
use gyroflex::dynamics::{Forward, State};
use gyroflex::spatial::Vec3;
use serde::Serialize;

/// What happened to a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EventKind {
    /// It came down on the ground and was caught.
    TouchDown,
    /// It came down on the ground and was thrown back.
    Bounce,
    /// It was on the ground already, and an impact elsewhere was felt there.
    Felt,
    /// It left the ground.
    LiftOff,
    /// It began to slip.
    Slip,
    /// It came to rest.
    Stick,
}

/// Something that happened to a contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Event {
    /// When [s].
    pub t: f64,
    /// Index of the contact.
    pub contact: usize,
    /// What.
    pub kind: EventKind,
    /// Impulse of the ground on it, in world axes [N s]; zero but for touch-down, bounce and what is felt.
    pub impulse: [f64; 3],
}

/// How far below the ground a point is to have come down [m]: rounding is not contact.
const BELOW: f64 = 1e-12;
/// By how much friction may be exceeded before a point slips: rounding is not slip.
const EXCESS: f64 = 1e-9;

/// How fast a point sinks into the ground that is not held there [m/s]: errors of integration are not that large.
const SINKS: f64 = 1e-6;

/// What a contact can no longer do as it did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Broken {
    /// An open contact is below the ground.
    Ground,
    /// A closed one would have to pull.
    Pull,
    /// A sticking one would need more friction than there is; the direction in which it will slip.
    Friction(Vec3<f64>),
    /// A slipping one has turned back.
    Reversed,
    /// A slipping one is drawn into the ground by its own friction, which no force prevents (Painlevé).
    Jam,
}

impl Contacts {
    /// The first contact, in order of what must be done first, that can no longer be as it is at a state; forces are then known.
    pub(super) fn broken(
        &mut self,
        dynamics: &mut Dynamics,
        state: State<f64>,
        (tau, loads): (&[f64], &mut Loads),
    ) -> Result<Option<(usize, Broken)>, Error> {
        let Some(ground) = self.ground else { return Ok(None) };
        dynamics.placements(state.q, &mut self.poses)?;
        for (i, point) in self.points.iter().enumerate() {
            let gap = point.place(&self.poses).z - ground.height;
            if point.mode == Mode::Open && gap < point.armed - BELOW {
                return Ok(Some((i, Broken::Ground)));
            }
        }
        if self.closed.is_empty() {
            return Ok(None);
        }
        let [mut qdd, mut thetadd, mut tau_j] = core::mem::take(&mut self.motion);
        let out = Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j };
        let solved = self.forward(dynamics, state, tau, &mut *loads, out);
        self.motion = [qdd, thetadd, tau_j];
        let redundant = solved?.dependent > 0.0;
        self.measure(dynamics, state)?;
        let mut worst: Option<(usize, Broken, f64)> = None;
        let (mut row, width) = (self.permanent_rows(), if ground.planar { 2 } else { 3 });
        for i in &self.closed {
            let force = &self.multipliers[row..row + width];
            let velocity = &self.velocities[row..row + width];
            row += width;
            let along = |v: &[f64]| if width == 2 { Vec3::new(v[0], 0.0, 0.0) } else { Vec3::new(v[0], v[1], 0.0) };
            let (normal, friction) = (force[width - 1], along(force));
            let found = match self.points[*i].mode {
                _ if normal < -EXCESS => Some((Broken::Pull, -normal)),
                Mode::Stick => {
                    let excess = friction.norm() - ground.friction * normal.max(0.0);
                    let direction = friction.scale(-1.0 / friction.norm().max(f64::MIN_POSITIVE));
                    (excess > EXCESS * (1.0 + friction.norm())).then_some((Broken::Friction(direction), excess))
                }
                Mode::Slip if normal < EXCESS && velocity[width - 1] < -SINKS => Some((Broken::Jam, f64::MAX)),
                Mode::Slip => self.points[*i].turned(along(velocity)).then_some((Broken::Reversed, f64::MIN_POSITIVE)),
                Mode::Open => None,
            };
            // What would pull goes first, then what exceeds its friction most.
            let rank = |b: &Broken| match b {
                Broken::Pull => 2,
                Broken::Friction(_) => 1,
                _ => 0,
            };
            if let Some((broken, size)) = found {
                let first = worst.as_ref().is_none_or(|(_, w, s)| (rank(&broken), size) > (rank(w), *s));
                if first {
                    worst = Some((*i, broken, size));
                }
            }
        }
        match worst {
            // How the load is shared was a choice: another one may do.
            Some((_, Broken::Pull | Broken::Friction(_), _)) if redundant => {
                self.verdict(dynamics, state, (tau, loads))
            }
            worst => Ok(worst.map(|(i, broken, _)| (i, broken))),
        }
    }
}
