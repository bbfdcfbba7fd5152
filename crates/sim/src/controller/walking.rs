//! The walk of a planar biped as a controller of a scenario.

use crate::contact::{Event, EventKind};
use crate::error::Error;
use crate::gait::{PlanarGait, Side};
use crate::load::nearest::nearest;
use crate::load::yaml::Keys;
use crate::reference::Point;
use crate::robot::Robot;
use crate::scenario::{Walk, fault};
use crate::simulate::StateVec;
use crate::walk::{Beliefs, WalkSettings, Walker};
use gyroflex::dynamics::State;
use gyroflex::model::{SpringSpec, TransmissionSpec};
use gyroflex::spatial::Vec3;

/// A walking controller and what it has heard of.
#[derive(Clone, Debug)]
pub struct Walking {
    walker: Walker,
    /// Time of the gait at time 0 [s].
    offset: f64,
    period: f64,
    /// Indices of the left and the right foot among the contact points.
    feet: [usize; 2],
    /// Velocities with an elastic transmission, and their damping by the motor [N m s/rad].
    elastic: Vec<usize>,
    damping: f64,
    heard: usize,
}

impl Walking {
    pub(super) fn new(spec: &Walk, robot: &Robot, keys: &Keys) -> Result<Self, Error> {
        let mut feet = [0; 2];
        for (at, name) in feet.iter_mut().zip(&spec.feet) {
            *at = robot.contacts.iter().position(|c| c.name == *name).ok_or_else(|| {
                let near = nearest(name, robot.contacts.iter().map(|c| c.name.as_str())).unwrap_or("none");
                let problem = format!("the robot has no contact `{name}`");
                fault(keys, "controller.feet", problem, format!("the nearest one is `{near}`"))
            })?;
        }
        let gait = PlanarGait::of_file(spec.gait, keys, "controller.gait.")?;
        let beliefs = Beliefs { mass: spec.believes.mass, length: spec.believes.length };
        let settings = WalkSettings {
            beliefs,
            rotors: spec.believes.rotors,
            single: spec.single,
            double: spec.double,
            rear_share: spec.rear_share,
        };
        let walker = Walker::new(robot, feet.map(|i| robot.contacts[i].point), gait, settings)?;
        let is_elastic = |k: &usize| {
            let drive = robot.bodies[*k].drive.as_ref();
            robot.fidelity.is_elastic()
                && drive.is_some_and(|d| matches!(d.transmission, TransmissionSpec::Elastic { .. }))
        };
        Ok(Self {
            offset: 0.5 * gait.parameters().single_support(),
            walker,
            period: 1.0 / spec.rate,
            feet,
            elastic: (0..robot.bodies.len()).filter(is_elastic).collect(),
            damping: spec.damping,
            heard: 0,
        })
    }

    /// Goes to time 0: the middle of the first step.
    pub(super) fn reset(&mut self) {
        self.walker.start(self.offset);
        self.heard = 0;
    }

    /// The state in which the gait is at time 0, transmissions deflected by what the law asks for there.
    ///
    /// # Errors
    /// A gait that the robot cannot take.
    pub fn place(&mut self, robot: &Robot, state: &mut StateVec) -> Result<(), Error> {
        let Some(joints) = self.walker.gait().joints(&self.walker.gait().at(self.offset)) else { return Ok(()) };
        let order = self.walker.coordinates();
        for (at, point) in order.into_iter().zip(joints) {
            (state.q[at], state.qd[at]) = (point.q, point.qd);
            (state.theta[at], state.thetad[at]) = (point.q, point.qd);
        }
        self.reset();
        let mut tau = vec![0.0; state.qd.len()];
        self.torques(0.0, state.view(), &mut tau)?;
        self.reset();
        for k in &self.elastic {
            if let Some(TransmissionSpec::Elastic { spring, .. }) = robot.bodies[*k].drive.map(|d| d.transmission) {
                state.theta[*k] += tau[*k] / stiffness(&spring, &robot.spring_tables);
            }
        }
        Ok(())
    }

    /// Takes in what happened since the last tick.
    pub(super) fn hear(&mut self, events: &[Event]) {
        for event in events.get(self.heard..).unwrap_or_default() {
            if event.kind == EventKind::TouchDown {
                let side = if event.contact == self.feet[0] { Side::Left } else { Side::Right };
                self.walker.touched_down(side, event.t + self.offset);
            }
        }
        self.heard = events.len();
    }

    /// Torques of the joints; returns the body on which the ground exerts a couple, and that couple in world axes [N m].
    pub(super) fn tick(&mut self, t: f64, state: State<f64>, tau: &mut [f64]) -> Result<(usize, Vec3<f64>), Error> {
        self.walker.go_on(t + self.offset);
        self.torques(t, state, tau)
    }

    fn torques(&mut self, t: f64, state: State<f64>, tau: &mut [f64]) -> Result<(usize, Vec3<f64>), Error> {
        let command = self.walker.tick(t + self.offset, state.q, state.qd, self.period)?;
        tau.copy_from_slice(&command.tau);
        for k in &self.elastic {
            tau[*k] -= self.damping * (state.thetad[*k] - state.qd[*k]);
        }
        Ok((command.body, Vec3::new(0.0, command.ankle, 0.0)))
    }

    /// What the joints are to do at a time, in the order of the robot's coordinates.
    pub fn reference(&self, t: f64, points: &mut [Point]) {
        let gait = self.walker.gait();
        let Some(joints) = gait.joints(&gait.at(t + self.offset)) else { return };
        for (at, point) in self.walker.coordinates().into_iter().zip(joints) {
            points[at] = point;
        }
    }
}

/// Stiffness of a spring at small deflections [N m/rad].
fn stiffness(spring: &SpringSpec, tables: &[[f64; 2]]) -> f64 {
    match *spring {
        SpringSpec::Polynomial { stiffness, .. } => stiffness,
        SpringSpec::Table { first, .. } => {
            let ([x0, y0], [x1, y1]) = (tables[first], tables[first + 1]);
            (y1 - y0) / (x1 - x0)
        }
    }
}
