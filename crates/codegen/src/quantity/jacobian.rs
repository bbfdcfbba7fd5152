//! The geometric Jacobian of a point of a link.

use super::tracing::{traced, zeros};
use super::{Options, Point};
use crate::function::Function;
use crate::robot::Robot;
use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::dynamics::{Axes, Frame, placements};
use gyroflex::spatial::Transform;

/// `J(q)`, six rows.
pub(super) fn jacobian(robot: &Robot, options: &Options) -> Function {
    let bodies = robot.model.bodies().len();
    let Point { body, placement, axes } = options.point.unwrap_or(Point::origin(bodies.saturating_sub(1)));
    let link = robot.links.get(body).map_or("a link", String::as_str);
    let meaning =
        format!("Jacobian of a frame on `{link}`: angular velocity and velocity of its origin, per joint velocity.");
    traced("jacobian", &meaning, |t| {
        let q = t.positions(robot);
        let records = t.records(robot, options);
        let (model, mut poses) = (records.view(), vec![Transform::identity(); bodies]);
        let mut j = zeros(6 * robot.nv());
        let frame = Frame { body, placement: placement.map(Sym::from_f64) };
        placements(&model, &q, &mut poses)
            .and_then(|()| gyroflex::dynamics::jacobian(&model, &poses, frame, axes, &mut j))
            .expect("lengths are the model's");
        let axes = match axes {
            Axes::World => "of the world",
            Axes::Local => "of the frame",
        };
        t.matrix("j", &j, robot.nv(), &format!("angular rows first, axes {axes} [–, m or 1/m]"));
    })
}
