//! A robot's records in symbols.

mod regroup;

use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::model::{Body, Fidelity, FlexibleModel, Knot, Model, RobotSpec};
use gyroflex::spatial::{SpatialInertia, Vec3};

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
    /// The load it carries: the body that carries it, and its inertia in that body's link frame.
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
}

/// The records of a robot: numbers, or symbols where a parameter is kept.
#[derive(Clone, Debug)]
pub struct Records {
    bodies: Vec<Body<Sym>>,
    knots: Vec<Knot<Sym>>,
    gravity: Vec3<Sym>,
}

impl Records {
    /// The records of a model, every number a constant. Made inside a trace.
    pub fn of(model: &Model<f64>) -> Self {
        Self {
            bodies: model.bodies().iter().map(Body::cast).collect(),
            knots: model.knots().iter().map(Knot::cast).collect(),
            gravity: model.gravity().map(Sym::from_f64),
        }
    }

    /// The same motion from fewer numbers; see [`regroup`](regroup::regroup). Energies, regressors and forces between links need
    /// the records as they are.
    pub fn regrouped(mut self) -> Self {
        regroup::regroup(&mut self.bodies);
        self
    }

    /// The view that the algorithms take.
    pub fn view(&self) -> Model<'_, Sym> {
        Model::new(&self.bodies, &self.knots, self.gravity)
    }
}
