//! Storage that the core's functions of links that bend borrow.

use gyroflex::dynamics::{
    FlexibleBody, FlexibleMode, FlexibleScratch, FlexibleStation, flexible_matrix_len, flexible_shapes_len,
};
use gyroflex::model::FlexibleModel;
use gyroflex::spatial::Motion;

pub struct Scratch {
    bodies: Vec<FlexibleBody<f64>>,
    stations: Vec<FlexibleStation<f64>>,
    modes: Vec<FlexibleMode<f64>>,
    shapes: Vec<Motion<f64>>,
    matrix: Vec<f64>,
}

impl Scratch {
    pub fn of(model: &FlexibleModel<f64>) -> Self {
        Self {
            bodies: vec![FlexibleBody::new(); model.rigid().bodies().len()],
            stations: vec![FlexibleStation::new(); model.stations().len()],
            modes: vec![FlexibleMode::new(); model.modes()],
            shapes: vec![Motion::zero(); flexible_shapes_len(model)],
            matrix: vec![0.0; flexible_matrix_len(model)],
        }
    }

    pub fn lend(&mut self) -> FlexibleScratch<'_, f64> {
        let Self { bodies, stations, modes, shapes, matrix } = self;
        FlexibleScratch { bodies, stations, modes, shapes, matrix }
    }
}
