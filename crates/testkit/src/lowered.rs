//! Records of a robot in storage of the tests.

use gyroflex::Scalar;
use gyroflex::model::{Body, Fidelity, Knot, Model, ModelError, RobotSpec};
use gyroflex::spatial::Vec3;

/// Owns what a [`Model`] borrows.
#[derive(Clone, Debug)]
pub struct Lowered<T> {
    bodies: Vec<Body<T>>,
    knots: Vec<Knot<T>>,
    gravity: Vec3<T>,
}

impl<T: Scalar> Lowered<T> {
    /// Lowers the description and rounds every number to the scalar.
    ///
    /// # Errors
    /// Whatever the core finds wrong with the description.
    pub fn new(spec: &RobotSpec<'_>, fidelity: Fidelity) -> Result<Self, ModelError> {
        let mut bodies = vec![Body::empty(); spec.bodies.len()];
        let mut knots = vec![Knot::EMPTY; spec.knots_needed()];
        spec.lower(fidelity, &mut bodies, &mut knots)?;
        Ok(Self {
            bodies: bodies.iter().map(Body::cast).collect(),
            knots: knots.iter().map(Knot::cast).collect(),
            gravity: spec.gravity.map(T::from_f64),
        })
    }

    /// The view the algorithms take.
    pub fn view(&self) -> Model<'_, T> {
        Model::new(&self.bodies, &self.knots, self.gravity)
    }
}
