//! Scratch of the algorithms of links that bend.

use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::dynamics::{
    FlexibleBody, FlexibleMode, FlexibleScratch, FlexibleStation, flexible_matrix_len, flexible_shapes_len,
};
use gyroflex::model::FlexibleModel;
use gyroflex::spatial::Motion;

/// What [`FlexibleScratch`] borrows.
pub(crate) struct Storage<T> {
    bodies: Vec<FlexibleBody<T>>,
    stations: Vec<FlexibleStation<T>>,
    modes: Vec<FlexibleMode<T>>,
    shapes: Vec<Motion<T>>,
    matrix: Vec<T>,
}

impl<T: Scalar> Storage<T> {
    pub(crate) fn of(model: &FlexibleModel<Sym>) -> Self {
        Self {
            bodies: vec![FlexibleBody::new(); model.rigid().bodies().len()],
            stations: vec![FlexibleStation::new(); model.stations().len()],
            modes: vec![FlexibleMode::new(); model.modes()],
            shapes: vec![Motion::zero(); flexible_shapes_len(model)],
            matrix: vec![T::zero(); flexible_matrix_len(model)],
        }
    }

    pub(crate) fn lend(&mut self) -> FlexibleScratch<'_, T> {
        FlexibleScratch {
            bodies: &mut self.bodies,
            stations: &mut self.stations,
            modes: &mut self.modes,
            shapes: &mut self.shapes,
            matrix: &mut self.matrix,
        }
    }
}
