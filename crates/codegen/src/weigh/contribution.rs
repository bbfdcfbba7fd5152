//! What one term does to the equations at one motion.

use super::{Motion, Place};
use crate::explicit::{ExplicitModel, Monomial, Sum};

/// A term with its derivatives by all coordinates that it depends on.
pub(super) struct Term {
    place: Place,
    own: Option<(Monomial, f64)>,
    slopes: Vec<(usize, Monomial, f64)>,
}

impl Term {
    /// Term number `number` of a place.
    pub(super) fn of(model: &ExplicitModel, place: Place, number: usize) -> Self {
        let own = place.sum(model).map(|sum| sum.terms()[number].clone());
        let slopes = own.iter().flat_map(|(m, c)| {
            (0..model.nv()).filter_map(move |k| {
                let (slope, factor) = m.derivative(model.layout(), model.layout().inputs[k])?;
                Some((k, slope, c * factor))
            })
        });
        Self { place, slopes: slopes.collect(), own }
    }

    /// Adds `d/dt (∂T/∂q̇) − ∂T/∂q + ∂V/∂q` of the term to `forces`: of coordinates, then of motors.
    pub(super) fn add_to(&self, model: &ExplicitModel, at: &Motion, inputs: &[f64], forces: &mut [f64]) {
        let (n, layout) = (model.nv(), model.layout());
        let first = model.joints().len();
        let value = self.own.as_ref().map_or(0.0, |(m, c)| c * m.value(layout, inputs));
        let slopes = || self.slopes.iter().map(|(k, m, c)| (*k, c * m.value(layout, inputs)));
        let rate = || slopes().map(|(k, slope)| slope * at.qd[k]).sum::<f64>();
        match self.place {
            Place::Mass(i, j) => {
                let rate = rate();
                forces[i] += value * at.qdd[j] + rate * at.qd[j];
                if i != j {
                    forces[j] += value * at.qdd[i] + rate * at.qd[i];
                }
                let products = at.qd[i] * at.qd[j] * if i == j { 0.5 } else { 1.0 };
                slopes().for_each(|(k, slope)| forces[k] -= slope * products);
            }
            Place::Coupling(i, j) => {
                let rate = rate();
                forces[i] += value * at.thetadd[j] + rate * at.thetad[j];
                forces[n + j] += value * at.qdd[i] + rate * at.qd[i];
                slopes().for_each(|(k, slope)| forces[k] -= slope * at.qd[i] * at.thetad[j]);
            }
            Place::Potential => slopes().for_each(|(k, slope)| forces[k] += slope),
            Place::Damping(i) => {
                let torque = value * (at.thetad[i] - at.qd[i]);
                forces[i] -= torque;
                forces[n + i] += torque;
            }
            Place::Cubic(i) => {
                let torque = value * (at.theta[i] - at.q[i]).powi(3);
                forces[i] -= torque;
                forces[n + i] += torque;
            }
            Place::ModalStiffness(j, k) => {
                let stiffness = model.modal_stiffness(j, k);
                forces[first + j] += stiffness * at.q[first + k];
                if j != k {
                    forces[first + k] += stiffness * at.q[first + j];
                }
            }
            Place::ModalDamping(j, k) => {
                let damping = model.modal_damping(j, k);
                forces[first + j] += damping * at.qd[first + k];
                if j != k {
                    forces[first + k] += damping * at.qd[first + j];
                }
            }
        }
    }
}

impl Place {
    /// All places of a model that have terms, and how many.
    pub(super) fn all(model: &ExplicitModel) -> Vec<(Self, usize)> {
        let (n, modes) = (model.nv(), model.modes());
        let pairs = |n: usize| (0..n).flat_map(move |i| (i..n).map(move |j| (i, j)));
        let mut all: Vec<Self> = pairs(n).map(|(i, j)| Self::Mass(i, j)).collect();
        all.extend((0..n * n).map(|at| Self::Coupling(at / n, at % n)));
        all.push(Self::Potential);
        for i in (0..model.joints().len()).filter(|i| model.transmission(*i).is_some()) {
            all.extend([Self::Cubic(i), Self::Damping(i)]);
        }
        let mut counted: Vec<(Self, usize)> =
            all.into_iter().map(|place| (place, place.sum(model).map_or(0, |sum| sum.terms().len()))).collect();
        for (j, k) in pairs(modes) {
            counted.push((Self::ModalStiffness(j, k), usize::from(model.modal_stiffness(j, k) != 0.0)));
            counted.push((Self::ModalDamping(j, k), usize::from(model.modal_damping(j, k) != 0.0)));
        }
        counted.retain(|(_, terms)| *terms > 0);
        counted
    }

    /// The sum at a place; none for numbers of the modes.
    fn sum(self, model: &ExplicitModel) -> Option<&Sum> {
        match self {
            Self::Mass(i, j) => Some(model.mass(i, j)),
            Self::Coupling(i, j) => Some(model.coupling(i, j)),
            Self::Potential => Some(model.potential()),
            Self::Damping(i) => model.transmission(i).map(|t| &t.damping),
            Self::Cubic(i) => model.transmission(i).map(|t| &t.cubic),
            Self::ModalStiffness(..) | Self::ModalDamping(..) => None,
        }
    }

    /// Whether it is part of the inertia matrix.
    pub(super) fn is_inertia(self) -> bool {
        matches!(self, Self::Mass(..) | Self::Coupling(..))
    }
}
