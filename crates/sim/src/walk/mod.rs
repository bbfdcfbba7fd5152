//! A planar biped that walks: on one foot, an impact, on both feet, and again from the other foot (Mu & Wu 2004).
//!
//! The controller sees a chain from the foot it stands on, with parameters that may be wrong; what walks is the robot of the scenario, with
//! feet that only the ground's contacts hold. Phases change by what happens: a foot that touches down begins the time on both feet, which
//! lasts as long as the gait says.

mod chain;
mod law;

pub use chain::Beliefs;
pub use law::Sliding;

use crate::error::Error;
use crate::gait::{Phase, Planar, PlanarGait, Side};
use crate::reference::Point;
use crate::robot::Robot;
use chain::{Chain, Five, Parts, other};
use gyroflex::control::Outputs;
use gyroflex::spatial::Vec3;
use law::{Followed, Law, fell};
use nalgebra::Vector2;

/// What a walking controller is made of.
#[derive(Clone, Copy, Debug)]
pub struct WalkSettings {
    /// Factors on the robot's parameters.
    pub beliefs: Beliefs,
    /// Whether the controller knows of the inertias of the rotors.
    pub rotors: bool,
    /// The law on one foot.
    pub single: Sliding,
    /// The law on two feet.
    pub double: Sliding,
    /// Part of the ground's force that the law on two feet would leave to the rear foot, at the beginning and at the end of that time.
    pub rear_share: [f64; 2],
}

/// A walking controller.
#[derive(Clone, Debug)]
pub struct Walker {
    gait: PlanarGait,
    parts: Parts,
    /// From the left and from the right foot.
    chains: [Chain; 2],
    single: Law,
    double: Law,
    rear_share: [f64; 2],
    mass: f64,
    gravity: f64,
    step: i64,
    phase: Phase,
    errors: [f64; 3],
}

/// What a tick asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Command {
    /// Torques of the joints, in the order of the robot's velocities [N m].
    pub tau: Vec<f64>,
    /// The body on which the ground exerts a couple: the shank of the leg that stands, or that is in front.
    pub body: usize,
    /// That couple, about +y [N m].
    pub ankle: f64,
}

impl Walker {
    /// A controller for a robot with the joints of [`PlanarGait::COORDINATES`] and the foot points `feet`, left and right, in the frames of the
    /// shanks.
    ///
    /// # Errors
    /// A robot that is no planar biped.
    pub fn new(robot: &Robot, feet: [Vec3<f64>; 2], gait: PlanarGait, settings: WalkSettings) -> Result<Self, Error> {
        let parts = Parts::of(robot, feet)?;
        let chain = |side| Chain::new(robot, &parts, side, settings.beliefs, settings.rotors);
        Ok(Self {
            chains: [chain(Side::Left)?, chain(Side::Right)?],
            gait,
            parts,
            single: Law::new(settings.single),
            double: Law::new(settings.double),
            rear_share: settings.rear_share,
            mass: settings.beliefs.mass * robot.bodies.iter().map(|b| b.inertia.mass).sum::<f64>(),
            gravity: -robot.gravity.z,
            step: 0,
            phase: Phase::Single,
            errors: [0.0; 3],
        })
    }

    /// Begins anew, at time `t` of the gait [s].
    pub fn start(&mut self, t: f64) {
        (self.step, self.phase) = self.gait.phase(t);
        self.single.reset();
        self.double.reset();
    }

    /// Step and phase.
    pub fn phase(&self) -> (i64, Phase) {
        (self.step, self.phase)
    }

    /// Indices of [`PlanarGait::COORDINATES`] among the robot's.
    pub fn coordinates(&self) -> [usize; 7] {
        self.parts.v
    }

    /// The gait.
    pub fn gait(&self) -> &PlanarGait {
        &self.gait
    }

    /// Errors of hip and trunk at the last tick [m, m, rad].
    pub fn errors(&self) -> [f64; 3] {
        self.errors
    }

    /// The leg that stands, or that is in front: the one whose ankle exerts a torque.
    pub fn support(&self) -> Side {
        let stance = PlanarGait::stance(self.step);
        match self.phase {
            Phase::Single => stance,
            Phase::Double => other(stance),
        }
    }

    /// A foot has touched down at time `t` [s]. Only that of the leg that swings, on its way down, begins the time on both feet.
    pub fn touched_down(&mut self, side: Side, t: f64) {
        let begun = self.step as f64 * self.gait.parameters().step_time();
        let late = t - begun > 0.5 * self.gait.parameters().single_support();
        if self.phase == Phase::Single && side == other(PlanarGait::stance(self.step)) && late {
            self.phase = Phase::Double;
            self.double.reset();
        }
    }

    /// Ends the time on both feet when it is over. Returns the leg that is to lift off then.
    pub fn go_on(&mut self, t: f64) -> Option<Side> {
        let end = (self.step + 1) as f64 * self.gait.parameters().step_time();
        if self.phase != Phase::Double || t < end - 1e-9 {
            return None;
        }
        let rear = PlanarGait::stance(self.step);
        (self.step, self.phase) = (self.step + 1, Phase::Single);
        self.single.reset();
        Some(rear)
    }

    /// Torques at time `t` [s] for the measured coordinates and velocities of the robot; `step` is the time to the next tick [s].
    ///
    /// # Errors
    /// A robot that has fallen: legs too short for what they are to do, or a singular pose.
    pub fn tick(&mut self, t: f64, q: &[f64], qd: &[f64], step: f64) -> Result<Command, Error> {
        let pick = |all: &[f64]| self.parts.v.map(|at| all[at]);
        let (q7, qd7) = (pick(q), pick(qd));
        let side = self.support();
        let chain = &mut self.chains[usize::from(side == Side::Right)];
        let (s, rates) = (chain.angles(q7), chain.angles(qd7));
        let mut posture = self.gait.during(self.step, self.phase, t);
        let aims = [posture.hip.x, posture.hip.z, posture.trunk];
        self.errors = [0, 1, 2].map(|k| q7[k] - aims[k].q);
        let tau = match self.phase {
            Phase::Single => {
                // The foot that stands is where it came to stand, not where it was to.
                let stands = Planar::on_ground(foot_ahead(&self.parts, side, q7, &self.gait));
                match side {
                    Side::Left => posture.left = stands,
                    Side::Right => posture.right = stands,
                }
                let joints = self.gait.joints(&posture).ok_or_else(|| fell("a leg is too short for the gait"))?;
                let of = |what: fn(&Point) -> f64| chain_angles(chain, &joints, what);
                let (desired, desired_rates) = (of(|p| p.q), of(|p| p.qd));
                let acceleration = of(|p| p.qdd);
                let follow = Followed {
                    desired: Outputs { p: desired.as_slice(), pd: desired_rates.as_slice() },
                    acceleration: acceleration.as_slice(),
                    measured: Outputs { p: s.as_slice(), pd: rates.as_slice() },
                };
                self.single.on_one_foot(chain, (&s, &rates), &follow, step)?
            }
            Phase::Double => {
                let follow = Followed {
                    desired: Outputs { p: &aims.map(|p| p.q), pd: &aims.map(|p| p.qd) },
                    acceleration: &aims.map(|p| p.qdd),
                    measured: Outputs { p: &q7[..3], pd: &qd7[..3] },
                };
                // The ground carries the robot as if all of it moved with the hip.
                let [first, last] = self.rear_share;
                let left = (self.step + 1) as f64 * self.gait.parameters().step_time() - t;
                let share = last + (first - last) * (left / self.gait.parameters().double_support).clamp(0.0, 1.0);
                let force = Vector2::new(posture.hip.x.qdd, self.gravity + posture.hip.z.qdd) * self.mass;
                self.double.on_two_feet(chain, (&s, &rates), &follow, force * share, step)?
            }
        };
        let mut out = vec![0.0; qd.len()];
        for (at, torque) in self.parts.v.iter().zip(chain.torques(&tau)) {
            out[*at] = torque;
        }
        Ok(Command { tau: out, body: self.parts.shank(side), ankle: tau[0] })
    }
}

fn chain_angles(chain: &Chain, joints: &[Point; 7], what: fn(&Point) -> f64) -> Five {
    chain.angles(core::array::from_fn(|k| what(&joints[k])))
}

/// Where a foot is, ahead in the world [m]: by the leg's geometry, which is known.
fn foot_ahead(parts: &Parts, side: Side, q: [f64; 7], gait: &PlanarGait) -> f64 {
    let [hip, knee] = Parts::leg(side).map(|at| q[at]);
    let (thigh, foot) = (gait.parameters().leg.thigh, parts.foot(side));
    let (turn, bent) = (q[2] + hip, q[2] + hip + knee);
    q[0] - thigh * turn.sin() + foot.x * bent.cos() + foot.z * bent.sin()
}
