//! The records of a robot: numbers, or symbols where a parameter is kept.

use super::bending::Bending;
use super::regroup::regroup;
use super::{Parameter, Robot};
use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::model::{Body, FlexibleModel, Friction, Knot, Model};
use gyroflex::spatial::Vec3;

/// The records of a robot in symbols, as the algorithms take them. Made inside a trace.
#[derive(Clone, Debug)]
pub struct Records {
    pub(super) bodies: Vec<Body<Sym>>,
    pub(super) knots: Vec<Knot<Sym>>,
    pub(super) gravity: Vec3<Sym>,
    pub(super) bending: Option<Bending>,
}

impl Records {
    /// The records of a model, every number a constant.
    pub fn of(model: &Model<f64>) -> Self {
        Self {
            bodies: model.bodies().iter().map(Body::cast).collect(),
            knots: model.knots().iter().map(Knot::cast).collect(),
            gravity: model.gravity().map(Sym::from_f64),
            bending: None,
        }
    }

    /// The records of a robot and its links that bend, with `kept` parameters as symbols.
    pub fn keeping(robot: &Robot, kept: &[(Parameter, Sym)]) -> Self {
        let mut records = Self { bending: robot.flexible.map(|model| Bending::of(&model)), ..Self::of(&robot.model) };
        kept.iter().for_each(|(parameter, value)| records.enter(robot, parameter, *value));
        records.finish(kept);
        records
    }

    /// The same motion from fewer numbers; see `regroup.rs`. Energies, regressors and forces between links need the records
    /// as they are, and so do links that bend, whose frames move with no joint.
    pub fn regrouped(mut self) -> Self {
        if self.bending.is_none() {
            regroup(&mut self.bodies);
        }
        self
    }

    /// The same robot without friction, without errors of its gears, and with links that bend freely: what is left of inverse
    /// dynamics is inertia, velocity and gravity.
    pub(crate) fn frictionless(mut self) -> Self {
        for body in &mut self.bodies {
            body.friction = Friction::none();
            if let Some(drive) = &mut body.drive {
                drive.rotor.friction = Friction::none();
                if let Some(elastic) = &mut drive.elastic {
                    elastic.error = None;
                }
            }
        }
        for pair in self.bending.iter_mut().flat_map(|bending| &mut bending.pairs) {
            (pair.stiffness, pair.damping) = (Sym::zero(), Sym::zero());
        }
        self
    }

    /// The view that the algorithms take.
    pub fn view(&self) -> Model<'_, Sym> {
        Model::new(&self.bodies, &self.knots, self.gravity)
    }

    /// The view that the algorithms of links that bend take, if any bends.
    pub fn flexible(&self) -> Option<FlexibleModel<'_, Sym>> {
        Some(self.bending.as_ref()?.view(self.view()))
    }
}
