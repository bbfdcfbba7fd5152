//! The reflected inertia of elastic rotors.

use super::Options;
use super::tracing::{traced, zeros};
use crate::function::Function;
use crate::robot::Robot;

/// The diagonal of `B`.
pub(super) fn reflected_inertia(robot: &Robot, options: &Options) -> Function {
    traced("reflected_inertia", "Reflected inertia of the rotors behind elastic transmissions.", |t| {
        let records = t.records(robot, options);
        let (model, mut b) = (records.view(), zeros(robot.nv()));
        gyroflex::dynamics::reflected_inertia(&model, &mut b[..model.nv()]).expect("lengths are the model's");
        t.vector("b", &b, "N² J, zero where no joint is elastic [kg m² or kg]");
    })
}
