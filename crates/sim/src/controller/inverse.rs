//! Feedforward by an inverse of the elastic robot.

use crate::coordinates::Coordinates;
use crate::error::Error;
use crate::inverse::{OutputInverse, with_least_damping};
use crate::load::yaml::Keys;
use crate::reference::References;
use crate::robot::Robot;
use crate::scenario::InverseOf;
use gyroflex::control::Motors;

/// Where the motors should be, and the torques that move them there.
#[derive(Clone, Debug)]
pub(super) struct Feedforward {
    along: OutputInverse,
    /// Time between ticks [s].
    step: f64,
}

impl Feedforward {
    /// # Errors
    /// A floating root, and references that are not smooth enough.
    pub(super) fn new(
        of: &InverseOf,
        rate: f64,
        robot: &Robot,
        joints: &Coordinates,
        references: &References,
        keys: &Keys,
    ) -> Result<Self, Error> {
        let known = with_least_damping(robot, of.damping);
        let fidelity = of.model.map_or(robot.fidelity, Into::into);
        let along = OutputInverse::new(&known, fidelity, of.output, (joints, references), keys)?;
        Ok(Self { along, step: 1.0 / rate })
    }

    /// Goes to time 0.
    pub(super) fn start(&mut self, references: &References) -> Result<(), Error> {
        self.along.start(references)
    }

    /// Finds the motion and the torques of time `t` [s], and moves the internal dynamics on to the next tick.
    pub(super) fn tick(&mut self, references: &References, t: f64) -> Result<(), Error> {
        self.along.at(references, t, self.step)?;
        self.along.advance(references, t, self.step)
    }

    /// What it found: the motors.
    pub(super) fn motors(&self) -> Motors<'_, f64> {
        Motors { theta: self.along.theta(), thetad: self.along.thetad() }
    }

    /// What it found: the motor torques.
    pub(super) fn tau(&self) -> &[f64] {
        self.along.tau()
    }

    /// The positions of the links: what it was asked for, or how they swing behind the motors.
    pub(super) fn q(&self) -> &[f64] {
        self.along.q()
    }

    /// Their velocities.
    pub(super) fn qd(&self) -> &[f64] {
        self.along.qd()
    }
}
