//! An inverse along references, of whichever output is prescribed.

use super::motor_output::DERIVATIVES;
use super::{BendingInverse, InverseModel, MotorOutput, ReferenceInverse};
use crate::coordinates::Coordinates;
use crate::error::Error;
use crate::load::yaml::Keys;
use crate::reference::References;
use crate::robot::Robot;
use crate::zeros::InverseOutput;
use gyroflex::model::Fidelity;

/// The inverse for the links' or for the motors' motion.
#[derive(Clone, Debug)]
pub enum OutputInverse {
    /// The links follow the references.
    Link(Box<ReferenceInverse>),
    /// The motors do.
    Motor(Box<MotorOutput>),
    /// The joints do, behind rigid gears, and the links bend.
    Bending(Box<BendingInverse>),
}

impl OutputInverse {
    /// The inverse of a robot on a fixed base, in one of its models.
    ///
    /// # Errors
    /// A robot that is not physical in this model, a floating root, references that are not smooth enough.
    pub fn new(
        robot: &Robot,
        fidelity: Fidelity,
        output: InverseOutput,
        (joints, references): (&Coordinates, &References),
        keys: &Keys,
    ) -> Result<Self, Error> {
        if !robot.flexible.is_empty() {
            return Ok(Self::Bending(Box::new(BendingInverse::new(robot, fidelity, joints, references, keys)?)));
        }
        Ok(match output {
            InverseOutput::Link => {
                let inverse = InverseModel::new(robot, fidelity, 0)?;
                Self::Link(Box::new(ReferenceInverse::new(inverse, joints, references, keys)?))
            }
            InverseOutput::Motor => {
                Self::Motor(Box::new(MotorOutput::new(robot.model(fidelity)?, joints, references, keys)?))
            }
        })
    }

    /// Derivatives of the position of the joint of a body that the torques depend on.
    pub fn needed(&self, body: usize) -> u8 {
        match self {
            Self::Link(along) => along.inverse().smoothness().joints[body].position,
            Self::Motor(_) | Self::Bending(_) => DERIVATIVES,
        }
    }

    /// Goes to time 0.
    ///
    /// # Errors
    /// As [`OutputInverse::at`].
    pub fn start(&mut self, references: &References) -> Result<(), Error> {
        match self {
            Self::Link(along) => along.start(references),
            Self::Motor(along) => along.start(references),
            Self::Bending(along) => along.start(references),
        }
    }

    /// Motors and torques at time `t` [s]; `step` is the time to the next instant.
    ///
    /// # Errors
    /// Names the joint whose transmission cannot be inverted or whose torque is not finite.
    pub fn at(&mut self, references: &References, t: f64, step: f64) -> Result<(), Error> {
        match self {
            Self::Link(along) => along.at(references, t, step),
            Self::Motor(along) => along.at(references, t),
            Self::Bending(along) => along.at(references, t),
        }
    }

    /// The motion of the links at time `t`, where it is given.
    pub(super) fn look(&mut self, references: &References, t: f64) {
        if let Self::Link(along) = self {
            along.look(references, t);
        }
    }

    /// Motors and torques at the time `t` of the last look.
    pub(super) fn invert(&mut self, references: &References, t: f64, step: f64) -> Result<(), Error> {
        match self {
            Self::Link(along) => along.invert(step),
            Self::Motor(along) => along.at(references, t),
            Self::Bending(along) => along.at(references, t),
        }
    }

    /// Moves the internal dynamics on from time `t` by `step` [s], those of the last instant; what was found there stays.
    ///
    /// # Errors
    /// As [`MotorOutput::advance`].
    pub fn advance(&mut self, references: &References, t: f64, step: f64) -> Result<(), Error> {
        match self {
            Self::Link(along) => {
                along.advance();
                Ok(())
            }
            Self::Motor(along) => along.advance(references, t, step),
            Self::Bending(along) => along.advance(references, t, step),
        }
    }

    /// Positions of the links at the last instant: `nq` entries.
    pub fn q(&self) -> &[f64] {
        match self {
            Self::Link(along) => along.q(),
            Self::Motor(along) => along.q(),
            Self::Bending(along) => along.q(),
        }
    }

    /// Their velocities: `nv` entries.
    pub fn qd(&self) -> &[f64] {
        match self {
            Self::Link(along) => along.derivative(1),
            Self::Motor(along) => along.qd(),
            Self::Bending(along) => along.qd(),
        }
    }

    /// Reflected motor positions there: `nv` entries.
    pub fn theta(&self) -> &[f64] {
        match self {
            Self::Link(along) => along.inverse().theta(0),
            Self::Motor(along) => along.theta(),
            Self::Bending(along) => along.q(),
        }
    }

    /// Their velocities: `nv` entries.
    pub fn thetad(&self) -> &[f64] {
        match self {
            Self::Link(along) => along.inverse().theta(1),
            Self::Motor(along) => along.thetad(),
            Self::Bending(along) => along.qd(),
        }
    }

    /// Motor torques there, reflected: `nv` entries [N m or N].
    pub fn tau(&self) -> &[f64] {
        match self {
            Self::Link(along) => along.inverse().tau(0),
            Self::Motor(along) => along.tau(),
            Self::Bending(along) => along.tau(),
        }
    }
}
