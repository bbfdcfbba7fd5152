//! The inertial coupling of links and motors.

use super::Options;
use super::mass_matrix::matrices;
use super::tracing::traced;
use crate::function::Function;
use crate::robot::Robot;

/// `S(q)`.
pub(super) fn coupling(robot: &Robot, options: &Options) -> Function {
    traced("coupling", "Inertial coupling of links and modes, by rows, with motors, by columns.", |t| {
        let q = t.positions(robot);
        let records = t.records(robot, options).regrouped();
        let [_, s] = matrices(&records, &q, robot.nv());
        t.matrix("s", &s, robot.nv(), "coupling, zero columns where no joint is elastic [kg m²]");
    })
}
