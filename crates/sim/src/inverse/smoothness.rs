//! What inverses of a robot ask of a motion, for people and programs.

use super::{orders, with_least_damping};
use crate::error::Error;
use crate::robot::Robot;
use gyroflex::dynamics::{JointOrders, VANISHING};
use gyroflex::model::Fidelity;
use serde::Serialize;

/// Couplings below this part of their natural size are reported if they alone ask for derivatives: axes nearly at right angles, as
/// rounded angles of files make them [–].
const SLIGHT: f64 = 1e-3;

/// How many derivatives of its position one joint must have.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct JointSmoothness {
    /// Name of the joint.
    pub joint: String,
    /// For the complete model.
    pub complete: u8,
    /// For the reduced model.
    pub reduced: u8,
}

/// The same for all joints.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SmoothnessTable {
    /// One entry per joint, a floating root first.
    pub joints: Vec<JointSmoothness>,
    /// What the complete model would need without couplings below a thousandth of their natural size, where that is less.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub without_slight_couplings: Option<u8>,
    /// What the complete model would need if no transmission were damped, and if all were.
    pub undamped: u8,
    /// See `undamped`.
    pub damped: u8,
}

/// What the inverse of a robot in one of its models asks of every joint, with `torque_derivatives` time derivatives of the torques; also where that
/// is more than an inverse can carry. One entry per joint, a floating root first.
///
/// # Errors
/// Names the joint that is not physical in this model.
pub fn joint_orders(robot: &Robot, fidelity: Fidelity, torque_derivatives: usize) -> Result<Vec<JointOrders>, Error> {
    robot.refuse_bending("the inverse of elastic joints", crate::zeros::ELASTIC_AND_BENDING)?;
    orders(&robot.model(fidelity)?, torque_derivatives, VANISHING)
}

impl SmoothnessTable {
    /// Finds it.
    ///
    /// # Errors
    /// Names the joint that is not physical in one of the models.
    pub fn of(robot: &Robot) -> Result<Self, Error> {
        let (complete, reduced) = (robot.model(Fidelity::Complete)?, robot.model(Fidelity::Reduced)?);
        let (exact, slight) = (orders(&complete, 0, VANISHING)?, orders(&complete, 0, SLIGHT)?);
        let highest = |of: &[JointOrders]| of.iter().map(|o| o.position).max().unwrap_or(0);
        let with = |damping: f64| -> Result<u8, Error> {
            let mut other = with_least_damping(robot, damping);
            if damping == 0.0 {
                super::without_damping(&mut other);
            }
            Ok(highest(&orders(&other.model(Fidelity::Complete)?, 0, VANISHING)?))
        };
        let reduced = orders(&reduced, 0, VANISHING)?;
        let joints = robot.joints.iter().zip(&exact).zip(&reduced);
        Ok(Self {
            joints: joints
                .map(|((joint, complete), reduced)| JointSmoothness {
                    joint: joint.name.clone(),
                    complete: complete.position,
                    reduced: reduced.position,
                })
                .collect(),
            without_slight_couplings: (highest(&slight) < highest(&exact)).then(|| highest(&slight)),
            undamped: with(0.0)?,
            damped: with(1.0)?,
        })
    }
}
