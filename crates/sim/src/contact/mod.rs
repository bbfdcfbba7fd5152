//! A robot that the ground or its own loops hold: contacts that open, close, stick and slip, found where they do so in time.
//!
//! Between events what is held does not change, and classical Runge-Kutta steps solve constrained dynamics. When a step ends where a contact
//! has passed the ground, would pull, or would be held by more than friction can, the instant at which that began is found by bisection,
//! so that it does not depend on the step.

mod events;
mod impacts;
mod impulses;
mod points;
mod report;
mod start;
mod stepper;
mod touching;

pub use events::{Event, EventKind};
pub use points::Mode;
pub(crate) use points::STABILISATION;
pub use stepper::Advance;

use crate::dynamics::Dynamics;
use crate::error::{Error, ErrorKind};
use crate::load::yaml::Keys;
use crate::loads::Loads;
use crate::record::Impact;
use crate::robot::Robot;
use crate::scenario::{Ground, fault};
use crate::simulate::StateVec;
use gyroflex::dynamics::{Constrained, Constraint, ConstraintMotion, Forward, Regularisation, Solved, State};
use gyroflex::spatial::{Force, Motion, Transform, Vec3};
use points::Point;
use stepper::Stages;

/// Directions that less than this part of their own compliance tells from others are dependent.
pub(crate) const THRESHOLD: f64 = 1e-9;
/// Part of their own compliance by which contacts that share a load give way, and what tells their directions from others then. The ground gives
/// way by next to nothing: it accelerates by that part of what it holds back.
pub(crate) const SHARED: Regularisation<f64> = Regularisation { threshold: 1e-13, damping: 1e-8 };
/// What redundant contacts may miss each other by to share a load [m/s² or m/s]: to hold both of two velocities would take endless forces.
const AT_ODDS: f64 = 1e-9;

/// Everything that holds a robot beside its joints.
#[derive(Clone, Debug)]
pub struct Contacts {
    ground: Option<Ground>,
    names: Vec<String>,
    points: Vec<Point>,
    /// Always in force.
    permanent: Vec<Constraint<f64>>,
    /// In force now: the permanent ones, then the closed contacts in the order of `closed`.
    constraints: Vec<Constraint<f64>>,
    closed: Vec<usize>,
    /// Whether redundant contacts share their load, as far as is known.
    shares: bool,
    multipliers: Vec<f64>,
    wrenches: Vec<Force<f64>>,
    velocities: Vec<f64>,
    errors: Vec<f64>,
    poses: Vec<Transform<f64>>,
    rates: Vec<Motion<f64>>,
    /// Accelerations, reused.
    motion: [Vec<f64>; 3],
    stages: Stages,
    events: Vec<Event>,
    impacts: Vec<Impact>,
    largest_drift: f64,
}

impl Contacts {
    /// What holds `robot`: its constraints, and contacts with the ground if the scenario has one. `keys` are the places of the scenario's keys.
    ///
    /// # Errors
    /// A ground without contact points, and constraints that the robot's first state does not keep.
    pub fn new(robot: &Robot, ground: Option<Ground>, dynamics: &Dynamics, keys: &Keys) -> Result<Self, Error> {
        if ground.is_some() && robot.contacts.is_empty() {
            let remedy = "name points under `contacts` in the robot's YAML, or take `ground` out";
            return Err(fault(keys, "ground", "the robot has no points that could touch it", remedy));
        }
        let permanent: Vec<_> = robot
            .held
            .iter()
            .map(|part| Constraint { hold: part.hold, stabilisation: part.stabilisation, contact: None })
            .collect();
        let used = if ground.is_some() { robot.contacts.as_slice() } else { &[] };
        let (nq, nv, bodies) = (dynamics.nq(), dynamics.nv(), robot.bodies.len());
        Ok(Self {
            names: robot.held.iter().map(|p| p.name.clone()).collect(),
            points: used.iter().map(Point::new).collect(),
            constraints: permanent.clone(),
            permanent,
            ground,
            closed: Vec::new(),
            shares: true,
            multipliers: Vec::new(),
            wrenches: Vec::new(),
            velocities: Vec::new(),
            errors: Vec::new(),
            poses: vec![Transform::identity(); bodies],
            rates: vec![Motion::zero(); bodies],
            motion: [(); 3].map(|()| vec![0.0; nv]),
            stages: Stages::new(nq, nv),
            events: Vec::new(),
            impacts: Vec::new(),
            largest_drift: 0.0,
        })
    }

    /// Whether there is anything to hold the robot.
    pub fn is_empty(&self) -> bool {
        self.permanent.is_empty() && self.ground.is_none()
    }

    /// Names of the contact points.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.points.iter().map(|p| p.name.as_str())
    }

    /// Mode of a contact point.
    pub fn mode(&self, contact: usize) -> Mode {
        self.points[contact].mode
    }

    /// What happened so far, in order.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The impacts so far, in order.
    pub fn impacts(&self) -> &[Impact] {
        &self.impacts
    }

    /// The largest error of position of what is held so far [m or rad].
    pub fn largest_drift(&self) -> f64 {
        self.largest_drift
    }

    /// Brings modes to agree with the forces of new torques.
    ///
    /// # Errors
    /// Contacts that change without end.
    pub fn agree(
        &mut self,
        dynamics: &mut Dynamics,
        state: &mut StateVec,
        forces: (&[f64], &mut Loads),
        t: f64,
    ) -> Result<(), Error> {
        self.settle(dynamics, state, forces, t).map(drop)
    }

    /// Row of a closed contact in what was measured last, and number of its rows.
    fn rows_of(&self, contact: usize) -> (usize, usize) {
        let width = if self.ground.is_some_and(|ground| ground.planar) { 2 } else { 3 };
        let before = self.closed.iter().take_while(|i| **i != contact).count();
        (self.permanent_rows() + before * width, width)
    }

    /// Velocity of a closed contact along the ground when it was measured last [m/s].
    fn along_ground(&self, contact: usize) -> Vec3<f64> {
        let (row, width) = self.rows_of(contact);
        Vec3::new(self.velocities[row], if width == 2 { 0.0 } else { self.velocities[row + 1] }, 0.0)
    }

    /// Its velocity off the ground [m/s].
    fn off_ground(&self, contact: usize) -> f64 {
        let (row, width) = self.rows_of(contact);
        self.velocities[row + width - 1]
    }

    /// The constraints in force, from the modes of the contacts.
    fn refresh(&mut self) {
        self.constraints.truncate(self.permanent.len());
        self.shares = !self.closed.is_empty();
        if let Some(ground) = self.ground {
            for i in &self.closed {
                self.constraints.push(self.points[*i].constraint(&ground));
            }
        }
        let rows = gyroflex::dynamics::constraint_rows(&self.constraints);
        for rows_of in [&mut self.multipliers, &mut self.velocities, &mut self.errors] {
            rows_of.resize(rows, 0.0);
        }
        self.wrenches.resize(self.constraints.len(), Force::zero());
    }

    /// Errors and velocities of all that is held.
    fn measure(&mut self, dynamics: &mut Dynamics, state: State<f64>) -> Result<(), Error> {
        let out = ConstraintMotion { error: &mut self.errors, velocity: &mut self.velocities, jacobian: &mut [] };
        dynamics.constraint_motion(state.q, state.qd, &self.constraints, out)
    }

    /// Directions of friction at a state.
    fn aim_friction(&mut self, dynamics: &mut Dynamics, state: State<f64>) -> Result<(), Error> {
        let Some(ground) = self.ground else { return Ok(()) };
        if ground.planar || self.points.iter().all(|p| p.mode != Mode::Slip) {
            return Ok(());
        }
        self.measure(dynamics, state)?;
        let mut row = self.permanent_rows();
        for (k, i) in self.closed.iter().enumerate() {
            let velocity = Vec3::new(self.velocities[row], self.velocities[row + 1], 0.0);
            let point = &self.points[*i];
            if point.mode == Mode::Slip {
                let contact = &mut self.constraints[self.permanent.len() + k].contact;
                if let Some(contact) = contact {
                    contact.slip = Some(point.ratio(velocity, ground.friction));
                }
            }
            row += 3;
        }
        Ok(())
    }

    fn permanent_rows(&self) -> usize {
        gyroflex::dynamics::constraint_rows(&self.permanent)
    }

    /// Accelerations of the robot as it is held, and the forces on it; contact forces are then those of [`Contacts::force`]. Contacts that hold more
    /// than they need to share the load evenly.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn forward(
        &mut self,
        dynamics: &mut Dynamics,
        state: State<f64>,
        tau: &[f64],
        loads: &mut Loads,
        out: Forward<f64>,
    ) -> Result<Solved<f64>, Error> {
        self.aim_friction(dynamics, state)?;
        loads.update(dynamics, state.q)?;
        let (rates, multipliers, wrenches) = (out, &mut self.multipliers, &mut self.wrenches);
        let mut solve = |regularisation| {
            let out = Forward { qdd: &mut *rates.qdd, thetadd: &mut *rates.thetadd, tau_j: &mut *rates.tau_j };
            let forces = Constrained { multipliers: &mut *multipliers, wrenches: &mut *wrenches };
            dynamics.constrained_forward(state, tau, loads.external(), &self.constraints, regularisation, out, forces)
        };
        let solved = solve(Regularisation::rank_revealing(THRESHOLD))?;
        if self.shares && may_share(&solved) {
            self.shares = is_shared(&solve(SHARED)?);
            if !self.shares {
                solve(Regularisation::rank_revealing(THRESHOLD))?;
            }
        }
        Ok(solved)
    }

    /// Force of the ground on a contact point at the last call of [`Contacts::forward`], in world axes [N].
    pub fn force(&self, contact: usize) -> Vec3<f64> {
        match self.closed.iter().position(|i| *i == contact) {
            Some(k) => self.wrenches[self.permanent.len() + k].lin,
            None => Vec3::zero(),
        }
    }
}

/// Whether there is a load that may be shared.
pub(crate) fn may_share(solved: &Solved<f64>) -> bool {
    solved.dependent > 0.0 && solved.contradiction < AT_ODDS
}

/// Whether it has been. Where points slip there may be no even share: a share that helps one of them may hinder another.
pub(crate) fn is_shared(solved: &Solved<f64>) -> bool {
    solved.dependent == 0.0 && solved.independence > 0.1 * SHARED.damping
}

/// A run whose contacts change without end.
fn chatter(t: f64, name: &str) -> Error {
    Error {
        kind: ErrorKind::Diverged,
        file: String::new(),
        element: format!("contact `{name}`"),
        problem: format!("at t = {t} s it opens and closes without end"),
        remedy: "raise `ground.resting_speed`, lower `ground.restitution`, or drive the robot less violently"
            .to_owned(),
    }
}
