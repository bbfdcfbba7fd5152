//! A quantity per length of a beam, constant or straight between points.

use super::quadrature::composite;

/// A quantity over the length of a beam.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// The same all along.
    Constant(f64),
    /// Points `[x, value]`, `x` ascending from the beam's root to its tip; straight between them.
    Table(Vec<[f64; 2]>),
}

impl Profile {
    /// The value at `x`.
    pub fn at(&self, x: f64) -> f64 {
        let points = match self {
            Self::Constant(value) => return *value,
            Self::Table(points) => points,
        };
        let after = points.partition_point(|p| p[0] <= x).clamp(1, points.len().saturating_sub(1).max(1));
        match (points.get(after - 1), points.get(after)) {
            (Some([a, from]), Some([b, to])) => from + (to - from) * (x - a) / (b - a),
            (Some([_, value]), None) => *value,
            _ => 0.0,
        }
    }

    /// Multiplies it by a factor.
    pub fn scale(&mut self, factor: f64) {
        match self {
            Self::Constant(value) => *value *= factor,
            Self::Table(points) => points.iter_mut().for_each(|p| p[1] *= factor),
        }
    }

    /// Where its slope may jump.
    pub fn breaks(&self) -> impl Iterator<Item = f64> {
        let points: &[[f64; 2]] = match self {
            Self::Constant(_) => &[],
            Self::Table(points) => points,
        };
        points.iter().map(|p| p[0])
    }

    /// `∫ p dξ` and `∫ ξ p dξ` from `x` to the end of a beam of this length.
    pub fn beyond(&self, x: f64, length: f64) -> [f64; 2] {
        // Two points integrate ξ p exactly.
        let rule = composite(&pieces(x, length, self.breaks()), 2);
        rule.iter().fold([0.0; 2], |[sum, moment], [xi, w]| {
            let p = w * self.at(*xi);
            [sum + p, moment + xi * p]
        })
    }

    /// `∫ p dx` over a beam of this length.
    pub fn total(&self, length: f64) -> f64 {
        self.beyond(0.0, length)[0]
    }
}

/// The ends of a range and what of `breaks` lies between them, ascending.
pub(crate) fn pieces(from: f64, to: f64, breaks: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut all: Vec<f64> = breaks.filter(|x| *x > from && *x < to).chain([from, to]).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}
