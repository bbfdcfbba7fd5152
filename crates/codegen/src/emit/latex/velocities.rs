//! Coriolis and centrifugal forces, grouped in whichever of two ways is shorter.

use super::symbols;
use super::terms::{Piece, bracketed, harmonics, joined, order, sum, variables};
use crate::explicit::{ExplicitModel, Monomial, VelocityTerm};
use std::collections::BTreeMap;

/// The forces of an equation.
pub(super) fn forces(model: &ExplicitModel, terms: &[VelocityTerm]) -> Vec<Piece> {
    let (by_term, by_product) = (by_term(model, terms), by_product(model, terms));
    if joined(&by_product).len() < joined(&by_term).len() { by_product } else { by_term }
}

/// `−p₂ s₂ (2 q̇₁ q̇₂ + q̇₂²)`.
fn by_term(model: &ExplicitModel, terms: &[VelocityTerm]) -> Vec<Piece> {
    let mut of: BTreeMap<&Monomial, Vec<Product>> = BTreeMap::new();
    for term in terms {
        for (m, c) in term.factor.terms() {
            of.entry(m).or_default().push(Product { factor: *c, ..product(model, term) });
        }
    }
    let mut all: Vec<(&Monomial, Vec<Product>)> = of.into_iter().collect();
    all.sort_by_cached_key(|(m, _)| order(model, m));
    let mut out = Vec::new();
    for same in all.chunk_by(|a, b| harmonics(model, a.0) == harmonics(model, b.0)) {
        let circular = harmonics(model, same[0].0);
        // Constants that multiply the same products stand together.
        let mut groups: Vec<(Vec<Piece>, &[Product])> = Vec::new();
        for (m, products) in same {
            let is = |factor: f64, other: &[Product]| {
                let same = |(a, b): (&Product, &Product)| a.is_like(b) && a.factor == factor * b.factor;
                products.len() == other.len() && products.iter().zip(other).all(same)
            };
            let found = groups.iter_mut().find_map(|(constants, other)| {
                [1.0, -1.0, 2.0, -2.0, 0.5, -0.5].into_iter().find(|f| is(*f, other)).map(|f| (constants, f))
            });
            match found {
                Some((constants, factor)) => constants.push(Piece::of(factor, variables(model, m))),
                None => groups.push((vec![Piece::of(1.0, variables(model, m))], products)),
            }
        }
        let several = groups.len() > 1 && !circular.is_empty();
        let within = if several { "" } else { circular.as_str() };
        let mut pieces = Vec::new();
        for (constants, products) in groups {
            let constants = bracketed("", constants, within);
            let mut piece = bracketed(&constants.text, polynomial(products), "");
            piece.negative ^= constants.negative;
            piece.coefficient *= constants.coefficient;
            pieces.push(piece);
        }
        if several {
            out.push(bracketed(&circular, pieces, ""));
        } else {
            out.extend(pieces);
        }
    }
    out
}

/// `(p₁ s₂ + …) q̇₁ q̇₂`.
fn by_product(model: &ExplicitModel, terms: &[VelocityTerm]) -> Vec<Piece> {
    terms.iter().map(|term| bracketed("", sum(model, &term.factor), &product(model, term).text())).collect()
}

/// Two velocities and a number.
#[derive(Clone, Debug, PartialEq)]
struct Product {
    factor: f64,
    first: String,
    second: String,
}

impl Product {
    fn is_like(&self, other: &Self) -> bool {
        (&self.first, &self.second) == (&other.first, &other.second)
    }

    fn text(&self) -> String {
        let Self { first, second, .. } = self;
        if first == second { format!("{first}^2") } else { format!("{first}{second}") }
    }

    /// What is left without one of the two.
    fn without(&self, velocity: &str) -> Option<&str> {
        match velocity {
            v if v == self.first => Some(&self.second),
            v if v == self.second => Some(&self.first),
            _ => None,
        }
    }
}

/// A sum of products, with a velocity that all of them have before it.
fn polynomial(products: &[Product]) -> Vec<Piece> {
    let plain = || products.iter().map(|p| Piece::of(p.factor, p.text())).collect();
    let [one, _, ..] = products else { return plain() };
    for shared in [&one.first, &one.second] {
        let rest: Option<Vec<Piece>> =
            products.iter().map(|p| Some(Piece::of(p.factor, p.without(shared)?.to_owned()))).collect();
        if let Some(rest) = rest {
            return vec![bracketed(shared, rest, "")];
        }
    }
    plain()
}

fn product(model: &ExplicitModel, term: &VelocityTerm) -> Product {
    Product {
        factor: 1.0,
        first: symbols::coordinate(model, term.first, 1),
        second: symbols::speed(model, term.second),
    }
}
