//! Sums of terms: the normal form.

use super::{Input, Layout, Monomial};
use rustc_hash::FxHashMap;

/// Part of the largest coefficient of a sum below which others are rounding while sums are made [–].
const ROUNDING: f64 = 1e-15;

/// A sum of terms, a coefficient each. Equal expressions are equal sums, but for rounding.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sum {
    /// In the order of the monomials.
    terms: Vec<(Monomial, f64)>,
}

/// A sum that is being made.
#[derive(Default)]
pub(super) struct Collected(FxHashMap<Monomial, f64>);

impl Collected {
    pub(super) fn add(&mut self, monomial: Monomial, coefficient: f64) {
        *self.0.entry(monomial).or_insert(0.0) += coefficient;
    }

    pub(super) fn add_scaled(&mut self, sum: &Sum, factor: f64) {
        sum.terms.iter().for_each(|(m, c)| self.add(m.clone(), factor * c));
    }

    /// The sum without what is rounding.
    pub(super) fn sum(self) -> Sum {
        let mut sum = Sum { terms: self.0.into_iter().collect() };
        sum.prune(ROUNDING);
        sum.terms.sort_unstable_by(|a, b| a.0.cmp(&b.0));
        sum
    }
}

impl Sum {
    /// Nothing.
    pub fn zero() -> Self {
        Self::default()
    }

    /// A number.
    pub(super) fn constant(layout: &Layout, x: f64) -> Self {
        Self::term(Monomial::one(layout), x)
    }

    /// One term.
    pub(super) fn term(monomial: Monomial, coefficient: f64) -> Self {
        let terms = if coefficient == 0.0 { Vec::new() } else { vec![(monomial, coefficient)] };
        Self { terms }
    }

    /// The terms in order.
    pub fn terms(&self) -> &[(Monomial, f64)] {
        &self.terms
    }

    /// Whether there are none.
    pub fn is_zero(&self) -> bool {
        self.terms.is_empty()
    }

    /// Largest magnitude of a coefficient.
    pub fn largest(&self) -> f64 {
        self.terms.iter().fold(0.0, |largest: f64, (_, c)| largest.max(c.abs()))
    }

    /// Drops coefficients below a part of the largest.
    pub(super) fn prune(&mut self, part: f64) {
        self.prune_below(part * self.largest());
    }

    /// Drops coefficients of no more than this magnitude.
    pub(super) fn prune_below(&mut self, least: f64) {
        self.terms.retain(|(_, c)| c.abs() > least);
    }

    /// Keeps the terms of which `keep` says so, by their place.
    pub(crate) fn retain(&mut self, mut keep: impl FnMut(usize) -> bool) {
        let mut place = 0;
        self.terms.retain(|_| {
            place += 1;
            keep(place - 1)
        });
    }

    pub(super) fn plus_scaled(&self, factor: f64, other: &Self) -> Self {
        let mut out = Collected::default();
        out.add_scaled(self, 1.0);
        out.add_scaled(other, factor);
        out.sum()
    }

    pub(super) fn scaled(&self, factor: f64) -> Self {
        let mut out = self.clone();
        out.terms.iter_mut().for_each(|(_, c)| *c *= factor);
        out
    }

    /// The product, up to a total degree in the modal coordinates.
    pub(super) fn times(&self, other: &Self, layout: &Layout, degree: usize) -> Self {
        let mut out = Collected::default();
        for (m, c) in &self.terms {
            for (n, d) in &other.terms {
                if m.degree(layout) + n.degree(layout) <= degree {
                    m.times(n, layout, |product, factor| out.add(product, c * d * factor));
                }
            }
        }
        out.sum()
    }

    /// Its derivative by an input.
    pub fn derivative(&self, layout: &Layout, input: Input) -> Self {
        let mut out = Collected::default();
        for (m, c) in &self.terms {
            if let Some((m, factor)) = m.derivative(layout, input) {
                out.add(m, c * factor);
            }
        }
        out.sum()
    }

    /// Its value; `inputs` are positions and kept parameters.
    pub fn value(&self, layout: &Layout, inputs: &[f64]) -> f64 {
        self.terms.iter().map(|(m, c)| c * m.value(layout, inputs)).sum()
    }
}

impl Monomial {
    /// Its value; `inputs` are positions and kept parameters.
    pub fn value(&self, layout: &Layout, inputs: &[f64]) -> f64 {
        let powers = self.powers(layout).iter().zip(&layout.variables);
        let of_powers: f64 = powers.map(|(power, input)| inputs[*input].powi((*power).into())).product();
        let of_angles: f64 = self.harmonics(layout).map(|harmonic| harmonic.value(layout, inputs)).product();
        of_powers * of_angles
    }
}

impl super::Harmonic<'_> {
    /// Its value; `inputs` are positions and kept parameters.
    pub fn value(&self, layout: &Layout, inputs: &[f64]) -> f64 {
        let angles = &layout.angles[layout.groups[self.group].clone()];
        let angle: f64 = angles.iter().zip(self.multiples).map(|(q, k)| f64::from(*k) * inputs[*q]).sum();
        if self.sine { angle.sin() } else { angle.cos() }
    }
}
