//! A robot to generate code for, and its records in symbols.

mod bending;
mod kept;
mod parameter;
mod records;
mod regroup;

pub use parameter::{Parameter, UnknownParameter};
pub use records::Records;

use gyroflex::model::{Body, Fidelity, FlexibleModel, Model, RobotSpec};
use gyroflex::spatial::SpatialInertia;

/// A robot to generate code for: its description, the records of one of its models, and names.
#[derive(Clone, Copy, Debug)]
pub struct Robot<'a> {
    /// Its name.
    pub name: &'a str,
    /// Names of the joints, one per body.
    pub joints: &'a [String],
    /// Names of the links that they move, one per body.
    pub links: &'a [String],
    /// The description that the records were lowered from.
    pub spec: RobotSpec<'a>,
    /// Which of the four models the records hold.
    pub fidelity: Fidelity,
    /// The records.
    pub model: Model<'a, f64>,
    /// The records of its links that bend, if any does.
    pub flexible: Option<FlexibleModel<'a, f64>>,
    /// The load it carries: the body that carries it, and its inertia in that body's link frame. The description has it in the
    /// inertia of the body.
    pub payload: Option<(usize, SpatialInertia<f64>)>,
}

impl Robot<'_> {
    /// Length of `q`.
    pub fn nq(&self) -> usize {
        self.flexible.map_or(self.model.nq(), |model| model.nq())
    }

    /// Length of every other vector over joints and modes.
    pub fn nv(&self) -> usize {
        self.flexible.map_or(self.model.nv(), |model| model.nv())
    }

    /// Whether a joint has a motor coordinate of its own; if none has, functions take no `theta`.
    pub fn is_elastic(&self) -> bool {
        self.model.bodies().iter().any(Body::is_elastic)
    }

    /// Whether a body is a link that bends.
    pub(crate) fn bends(&self, body: usize) -> bool {
        self.flexible.is_some_and(|model| model.links().iter().any(|link| usize::from(link.body) == body))
    }
}
