//! Storage that the core's functions of links that bend borrow.

use gyroflex::Scalar;
use gyroflex::dynamics::{
    FlexibleBody, FlexibleMode, FlexibleScratch, FlexibleStation, flexible_matrix_len, flexible_shapes_len,
};
use gyroflex::model::FlexibleModel;
use gyroflex::spatial::Motion;

pub struct Scratch<T> {
    bodies: Vec<FlexibleBody<T>>,
    stations: Vec<FlexibleStation<T>>,
    modes: Vec<FlexibleMode<T>>,
    shapes: Vec<Motion<T>>,
    matrix: Vec<T>,
}

impl<T: Scalar> Scratch<T> {
    pub fn of(model: &FlexibleModel<f64>) -> Self {
        Self {
            bodies: vec![FlexibleBody::new(); model.rigid().bodies().len()],
            stations: vec![FlexibleStation::new(); model.stations().len()],
            modes: vec![FlexibleMode::new(); model.modes()],
            shapes: vec![Motion::zero(); flexible_shapes_len(model)],
            matrix: vec![T::zero(); flexible_matrix_len(model)],
        }
    }

    pub fn lend(&mut self) -> FlexibleScratch<'_, T> {
        let Self { bodies, stations, modes, shapes, matrix } = self;
        FlexibleScratch { bodies, stations, modes, shapes, matrix }
    }
}
