//! What may be chosen about a quantity.

use crate::robot::Parameter;
use gyroflex::dynamics::Axes;
use gyroflex::spatial::Transform;

/// Choices; those that a quantity knows nothing of change nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// Parameters that stay symbols: entries of a last argument, `parameters`, in this order.
    pub kept: Vec<Parameter>,
    /// Whose Jacobian; `None` is the origin of the last link, in the axes of the world.
    pub point: Option<Point>,
    /// How many time derivatives of the torques the elastic inverse gives besides the torques.
    pub torque_derivatives: usize,
}

/// A frame fixed to a link, and the axes in which its motion is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Index of the link's body.
    pub body: usize,
    /// Pose of the frame in the link frame.
    pub placement: Transform<f64>,
    /// Axes of the rows.
    pub axes: Axes,
}

impl Point {
    /// The origin of a link's frame, in the axes of the world.
    pub fn origin(body: usize) -> Self {
        Self { body, placement: Transform::identity(), axes: Axes::World }
    }
}
