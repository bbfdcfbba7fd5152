//! What a robot does not have, and what to do then.

use super::{Options, Quantity};
use crate::robot::Robot;
use core::fmt;

/// A quantity that a robot does not have, or for which there is no algorithm.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unavailable {
    /// The quantity.
    pub quantity: Quantity,
    /// Why.
    pub reason: String,
    /// What to do.
    pub remedy: String,
}

/// Whether a robot has a quantity.
pub(super) fn check(robot: &Robot, quantity: Quantity, options: &Options) -> Result<(), Unavailable> {
    use Quantity::{Coriolis, Coupling, ElasticInverse, Jacobian, ReflectedInertia, Regressor, Stiffness};
    let no = |reason: String, remedy: &str| Err(Unavailable { quantity, reason, remedy: remedy.to_owned() });
    let (elastic, bending) = (robot.is_elastic(), robot.flexible.is_some());
    match quantity {
        Coupling | ReflectedInertia if !elastic => no(
            format!("no joint is elastic in the model `{}`: its rotors are in the mass matrix", robot.fidelity.name()),
            "generate `mass-matrix`, or another model",
        ),
        Stiffness if !elastic && !bending => no(
            format!("no joint is elastic in the model `{}`, and no link bends", robot.fidelity.name()),
            "leave it out, or generate another model",
        ),
        ElasticInverse if !elastic => no(
            format!("no joint is elastic in the model `{}`", robot.fidelity.name()),
            "generate `inverse`, or another model",
        ),
        ElasticInverse if bending => no(
            "a link bends, and from the motion of joints alone its modes do not follow at once".to_owned(),
            "generate `inverse`, which takes the motion of the modes, too",
        ),
        ElasticInverse => match options.kept.iter().find(|p| p.adds_damping()) {
            Some(p) => no(
                format!(
                    "whether `{}` is zero decides how many derivatives the inverse takes, and it is zero",
                    p.name()
                ),
                "give it a value in the robot's file, or do not keep it",
            ),
            None => Ok(()),
        },
        Coriolis if bending && robot.model.is_floating() => no(
            "a link bends and the root floats, for which there is no Coriolis matrix here".to_owned(),
            "generate `bias`, or fix the root",
        ),
        Regressor | Jacobian if bending => no(
            "a link bends, for which the core has no such algorithm".to_owned(),
            "leave it out; `inverse`, its derivatives and `placements` are there",
        ),
        Jacobian => match &options.point {
            Some(point) if point.body >= robot.model.bodies().len() => no(
                format!("the robot has {} bodies, and no body {}", robot.model.bodies().len(), point.body),
                "name one of its links",
            ),
            None if robot.model.bodies().is_empty() => no("the robot has no bodies".to_owned(), "leave it out"),
            _ => Ok(()),
        },
        _ => Ok(()),
    }
}

impl fmt::Display for Unavailable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no `{}`: {}; {}", self.quantity.name(), self.reason, self.remedy)
    }
}

impl core::error::Error for Unavailable {}
