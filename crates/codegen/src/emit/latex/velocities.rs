//! Coriolis and centrifugal forces, grouped in whichever of two ways is shorter.

use super::symbols;
use super::terms::{Piece, bracketed, harmonics, joined, multiple, order, sum, variables};
use crate::explicit::{ExplicitModel, Monomial, Speed, VelocityTerm};
use std::collections::BTreeMap;

/// The forces of an equation.
pub(super) fn forces(model: &ExplicitModel, terms: &[VelocityTerm]) -> Vec<Piece> {
    let (by_term, by_product) = (by_term(model, terms), by_product(model, terms));
    if joined(&by_product).len() < joined(&by_term).len() { by_product } else { by_term }
}

/// `−p₂ s₂ (2 q̇₁ q̇₂ + q̇₂²)`.
fn by_term(model: &ExplicitModel, terms: &[VelocityTerm]) -> Vec<Piece> {
    let mut of: BTreeMap<&Monomial, Vec<Piece>> = BTreeMap::new();
    for term in terms {
        for (m, c) in term.factor.terms() {
            of.entry(m).or_default().push(multiple(*c, &product(model, term)));
        }
    }
    let mut all: Vec<(&Monomial, Vec<Piece>)> = of.into_iter().collect();
    all.sort_by_cached_key(|(m, _)| order(model, m));
    let mut out = Vec::new();
    for same in all.chunk_by(|a, b| harmonics(model, a.0) == harmonics(model, b.0)) {
        let circular = harmonics(model, same[0].0);
        // Constants that multiply the same products stand together.
        let mut groups: Vec<(Vec<Piece>, Vec<Piece>)> = Vec::new();
        for (m, products) in same {
            let own = Piece { negative: false, text: variables(model, m) };
            let turned: Vec<Piece> = products.iter().map(|p| Piece { negative: !p.negative, ..p.clone() }).collect();
            if let Some((constants, _)) = groups.iter_mut().find(|(_, p)| p == products) {
                constants.push(own);
            } else if let Some((constants, _)) = groups.iter_mut().find(|(_, p)| *p == turned) {
                constants.push(Piece { negative: true, ..own });
            } else {
                groups.push((vec![own], products.clone()));
            }
        }
        let pieces: Vec<Piece> = groups
            .into_iter()
            .map(|(constants, products)| {
                let constants = bracketed("", constants, false);
                let mut piece = bracketed(&constants.text, products, false);
                piece.negative ^= constants.negative;
                piece
            })
            .collect();
        if circular.is_empty() {
            out.extend(pieces);
        } else {
            let one = pieces.len() == 1;
            let mut piece = bracketed(&circular, pieces, false);
            if one {
                // p₂ s₂ (…) reads better than s₂ p₂ (…).
                piece.text = moved_behind(&circular, &piece.text);
            }
            out.push(piece);
        }
    }
    out
}

/// `s₂ p₂ (…)` as `p₂ s₂ (…)`.
fn moved_behind(circular: &str, text: &str) -> String {
    let rest = &text[circular.len()..];
    match rest.find(['(']).filter(|at| *at > 0) {
        Some(at) => format!("{}{circular}{}", &rest[..at], &rest[at..]),
        None => match rest.find("\\dot") {
            Some(at) => format!("{}{circular}{}", &rest[..at], &rest[at..]),
            None => text.to_owned(),
        },
    }
}

/// `(p₁ s₂ + …) q̇₁ q̇₂`.
fn by_product(model: &ExplicitModel, terms: &[VelocityTerm]) -> Vec<Piece> {
    terms.iter().map(|term| bracketed(&product(model, term), sum(model, &term.factor), true)).collect()
}

fn product(model: &ExplicitModel, term: &VelocityTerm) -> String {
    let first = symbols::coordinate(model, term.first, 1);
    if term.second == Speed::Link(term.first) {
        format!("{first}^2")
    } else {
        format!("{first}{}", symbols::speed(model, term.second))
    }
}
