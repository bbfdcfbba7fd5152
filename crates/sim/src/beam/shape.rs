//! A mode of a beam: what moves, in which shape, and what resists.

use super::bending::Bending;
use super::boundary::{Boundary, TipBody};
use super::profile::Profile;
use super::quadrature::composite;
use super::rod::Rod;
use super::table::Table;
use gyroflex::spatial::Vec3;
use std::f64::consts::PI;

/// What a mode does to a beam along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Deflection {
    /// Displacement along y, turning about z. Resisted by the `EI` of a bending moment about z.
    BendingY,
    /// Displacement along z, turning about −y. Resisted by the `EI` of a bending moment about y.
    BendingZ,
    /// Turning about x, resisted by `GJ`.
    Torsion,
    /// Displacement along x, resisted by `EA`.
    Extension,
}

impl Deflection {
    /// All of them, in the order of a link's modes.
    pub const ALL: [Self; 4] = [Self::BendingY, Self::BendingZ, Self::Torsion, Self::Extension];

    /// The name used in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::BendingY => "bending_y",
            Self::BendingZ => "bending_z",
            Self::Torsion => "torsion",
            Self::Extension => "extension",
        }
    }

    /// Whether it bends the beam.
    pub const fn bends(self) -> bool {
        matches!(self, Self::BendingY | Self::BendingZ)
    }

    /// Order of the derivative of the shape that strains the beam: curvature, or the slope of a rod.
    pub const fn strain_order(self) -> usize {
        if self.bends() { 2 } else { 1 }
    }

    /// The direction of the displacement that a shape describes; none in torsion.
    pub fn direction(self) -> Vec3<f64> {
        match self {
            Self::BendingY => Vec3::new(0.0, 1.0, 0.0),
            Self::BendingZ => Vec3::new(0.0, 0.0, 1.0),
            Self::Torsion => Vec3::zero(),
            Self::Extension => Vec3::new(1.0, 0.0, 0.0),
        }
    }

    /// The rotation of a cross-section where the shape has this value and this slope.
    pub fn rotation(self, value: f64, slope: f64) -> Vec3<f64> {
        match self {
            Self::BendingY => Vec3::new(0.0, 0.0, slope),
            Self::BendingZ => Vec3::new(0.0, -slope, 0.0),
            Self::Torsion => Vec3::new(value, 0.0, 0.0),
            Self::Extension => Vec3::zero(),
        }
    }
}

/// A function over the length of a beam.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// An eigenfunction in bending, times a factor.
    Bending(Bending, f64),
    /// An eigenfunction in torsion or extension, times a factor.
    Rod(Rod, f64),
    /// Points.
    Table(Table),
}

impl Shape {
    /// The derivative of order `k` by `x`, up to the second [1/mᵏ].
    pub fn derivative(&self, x: f64, k: usize) -> f64 {
        match self {
            Self::Bending(function, factor) => factor * function.derivative(x, k),
            Self::Rod(function, factor) => factor * function.derivative(x, k),
            Self::Table(table) => table.derivative(x, k),
        }
    }

    /// Where it is not smooth.
    pub fn breaks(&self) -> impl Iterator<Item = f64> {
        let points = match self {
            Self::Table(table) => table.points(),
            _ => &[],
        };
        points.iter().map(|p| p[0])
    }

    /// The eigenvalue `λ`, by which it waves; zero for a table.
    pub fn eigenvalue(&self) -> f64 {
        match self {
            Self::Bending(function, _) => function.eigenvalue,
            Self::Rod(function, _) => function.eigenvalue,
            Self::Table(_) => 0.0,
        }
    }
}

/// What resists a mode.
#[derive(Clone, Debug, PartialEq)]
pub enum Resistance {
    /// `EI`, `GJ` [N m²] or `EA` [N] over the length.
    Stiffness(Profile),
    /// The frequency of the mode [Hz], in place of the integral over the stiffness.
    Frequency(f64),
}

/// A mode of a beam.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamMode {
    /// What it does.
    pub deflection: Deflection,
    /// Its shape: a displacement per unit of the modal coordinate [–], in torsion an angle per unit of it [–].
    pub shape: Shape,
    /// What resists it.
    pub resistance: Resistance,
    /// Damping ratio at its own frequency [–].
    pub damping_ratio: f64,
    /// Modal mass of what its frequency counts beside the beam: a body at the tip, or lumped masses [kg; kg m² in torsion].
    pub lumped: f64,
}

/// The inertia over the length of a beam: of the displacement, and of the turning about its axis.
#[derive(Clone, Copy, Debug)]
pub struct Inertia<'a> {
    /// Length [m].
    pub length: f64,
    /// Mass per length [kg/m].
    pub mass: &'a Profile,
    /// Polar moment of inertia per length, `ρ I_p` [kg m].
    pub polar: &'a Profile,
}

impl Inertia<'_> {
    /// What moves along or turns, per length.
    fn of(&self, deflection: Deflection) -> &Profile {
        if deflection == Deflection::Torsion { self.polar } else { self.mass }
    }

    /// The first `count` eigenfunctions of the uniform beam with the same mass, times factors that make the modal mass, of the beam
    /// and of the body at its tip, that of the beam; in torsion its polar inertia. With each comes the part of the body at the tip.
    ///
    /// `None` for a rod that the boundary says nothing of.
    pub fn eigenmodes(&self, deflection: Deflection, boundary: Boundary, count: usize) -> Option<Vec<(Shape, f64)>> {
        let (length, inertia) = (self.length, self.of(deflection));
        let (total, tip) = (inertia.total(length), boundary.tip());
        let shapes: Vec<Shape> = if deflection.bends() {
            let functions = Bending::first(boundary, length, total / length, count);
            functions.into_iter().map(|f| Shape::Bending(f, 1.0)).collect()
        } else {
            let body = if deflection == Deflection::Torsion { tip.inertia } else { tip.mass };
            let functions = Rod::first(boundary, length, body / total, count)?;
            functions.into_iter().map(|f| Shape::Rod(f, 1.0)).collect()
        };
        let normalised = |shape: Shape| {
            let (own, at_tip) = (self.modal_mass(deflection, &shape), tip_mass(deflection, tip, &shape, length));
            let factor = (total / (own + at_tip)).sqrt();
            let shape = match shape {
                Shape::Bending(function, _) => Shape::Bending(function, factor),
                Shape::Rod(function, _) => Shape::Rod(function, factor),
                Shape::Table(table) => Shape::Table(table),
            };
            (shape, at_tip * factor * factor)
        };
        Some(shapes.into_iter().map(normalised).collect())
    }

    /// `∫ φ² dm` of a shape [kg], in torsion `∫ φ² ρI_p dx` [kg m²].
    pub fn modal_mass(&self, deflection: Deflection, shape: &Shape) -> f64 {
        let inertia = self.of(deflection);
        let breaks = super::profile::pieces(0.0, self.length, inertia.breaks().chain(shape.breaks()));
        let rule = composite(&breaks, points_for(shape.eigenvalue()));
        rule.iter().map(|[x, w]| w * inertia.at(*x) * shape.derivative(*x, 0).powi(2)).sum()
    }
}

/// Quadrature points for products of two shapes that wave like this eigenvalue.
pub(crate) fn points_for(eigenvalue: f64) -> usize {
    // Gauss's rule needs half a point per radian of the product, and some more until it converges, which it then does at once.
    16 + eigenvalue.ceil() as usize
}

/// Modal mass of the body at the tip.
fn tip_mass(deflection: Deflection, tip: TipBody, shape: &Shape, length: f64) -> f64 {
    let (value, slope) = (shape.derivative(length, 0), shape.derivative(length, 1));
    match deflection {
        Deflection::Torsion => tip.inertia * value * value,
        Deflection::Extension => tip.mass * value * value,
        _ => tip.mass * value * value + 2.0 * tip.first_moment * value * slope + tip.inertia * slope * slope,
    }
}

/// The natural frequency [Hz] of a mode of this stiffness and mass.
pub fn frequency(stiffness: f64, mass: f64) -> f64 {
    (stiffness / mass).sqrt() / (2.0 * PI)
}
