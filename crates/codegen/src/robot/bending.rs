//! The records of links that bend, in symbols.

use crate::sym::Sym;
use gyroflex::Scalar;
use gyroflex::model::{AssumedMode, FlexibleLink, FlexibleModel, ModePair, Model, Seat, Station, StationShape};
use gyroflex::spatial::Vec3;

/// What a [`FlexibleModel`] borrows beside its rigid part.
#[derive(Clone, Debug)]
pub(super) struct Bending {
    links: Vec<FlexibleLink<Sym>>,
    modes: Vec<AssumedMode<Sym>>,
    pub(super) pairs: Vec<ModePair<Sym>>,
    pub(super) stations: Vec<Station<Sym>>,
    shapes: Vec<StationShape<Sym>>,
    shortenings: Vec<Vec3<Sym>>,
    pub(super) seats: Vec<Seat>,
}

impl Bending {
    pub(super) fn of(model: &FlexibleModel<f64>) -> Self {
        Self {
            links: model.links().iter().map(FlexibleLink::cast).collect(),
            modes: model.mode_records().iter().map(AssumedMode::cast).collect(),
            pairs: model.pairs().iter().map(ModePair::cast).collect(),
            stations: model.stations().iter().map(Station::cast).collect(),
            shapes: model.shapes().iter().map(StationShape::cast).collect(),
            shortenings: model.shortenings().iter().map(|s| s.map(Sym::from_f64)).collect(),
            seats: model.seats().to_vec(),
        }
    }

    pub(super) fn view<'a>(&'a self, rigid: Model<'a, Sym>) -> FlexibleModel<'a, Sym> {
        let Self { links, modes, pairs, stations, shapes, shortenings, seats } = self;
        FlexibleModel::new(rigid, links, modes, pairs, stations, shapes, shortenings, seats)
    }
}
