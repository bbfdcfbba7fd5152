//! Sums as a person writes them: what shares sines and cosines in brackets before them.

use super::symbols;
use crate::explicit::{ExplicitModel, Monomial, Sum, rational};

/// A term, its sign apart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) negative: bool,
    pub(super) text: String,
}

/// `a + b − c`.
pub(super) fn joined(pieces: &[Piece]) -> String {
    let mut out = String::new();
    for piece in pieces {
        out += match (out.is_empty(), piece.negative) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        out += &piece.text;
    }
    if out.is_empty() { "0".to_owned() } else { out }
}

/// A factor before brackets around several terms, or before one.
pub(super) fn bracketed(factor: &str, mut pieces: Vec<Piece>, behind: bool) -> Piece {
    let negative = pieces.iter().all(|p| p.negative) || pieces.first().is_some_and(|p| p.negative);
    if negative {
        pieces.iter_mut().for_each(|p| p.negative = !p.negative);
    }
    let text = match pieces.as_slice() {
        [one] if one.text == "1" => factor.to_owned(),
        [one] if behind => format!("{}{factor}", one.text),
        [one] => format!("{factor}{}", one.text),
        _ if behind => format!("({}){factor}", joined(&pieces)),
        _ => format!("{factor}({})", joined(&pieces)),
    };
    Piece { negative, text }
}

/// A coefficient and what it multiplies.
pub(super) fn multiple(c: f64, of: &str) -> Piece {
    let number = match rational(c.abs()) {
        Some((1, 1)) if !of.is_empty() => String::new(),
        Some((numerator, 1)) => numerator.to_string(),
        Some((numerator, denominator)) => format!("\\tfrac{{{numerator}}}{{{denominator}}}"),
        None => number(c.abs()),
    };
    Piece { negative: c < 0.0, text: format!("{number}{of}") }
}

/// Six digits.
pub(super) fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let exponent = x.abs().log10().floor() as i32;
    if (-3..6).contains(&exponent) {
        let text = format!("{x:.*}", usize::try_from(5 - exponent).unwrap_or(0));
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        return text.to_owned();
    }
    let mantissa = format!("{:.5}", x / 10.0_f64.powi(exponent));
    format!("{}\\cdot 10^{{{exponent}}}", mantissa.trim_end_matches('0').trim_end_matches('.'))
}

/// The variables of a monomial: constants and parameters before positions.
pub(super) fn variables(model: &ExplicitModel, m: &Monomial) -> String {
    let (n, layout) = (model.nv(), model.layout());
    let mut of: Vec<(usize, i8)> = m.powers(layout).iter().copied().enumerate().filter(|(_, p)| *p != 0).collect();
    let kept = model.options().kept.len();
    // Lumped constants, then kept parameters, then positions.
    let rank = |v: usize| match layout.variables[v] {
        input if input >= n + kept => 0,
        input if input >= n => 1,
        _ => 2,
    };
    of.sort_by_key(|(v, _)| (rank(*v), *v));
    let power = |p: i8| if p == 1 { String::new() } else { format!("^{{{p}}}") };
    of.into_iter().map(|(v, p)| format!("{}{}", symbols::variable(model, v), power(p))).collect()
}

/// The sines and cosines of a monomial.
pub(super) fn harmonics(model: &ExplicitModel, m: &Monomial) -> String {
    m.harmonics(model.layout()).map(|h| symbols::harmonic(model.layout(), &h)).collect()
}

/// In which order terms are read: few sines and cosines first, cosines before sines, low degrees first.
pub(super) fn order(model: &ExplicitModel, m: &Monomial) -> (usize, Vec<(usize, bool, Vec<i8>)>, usize, Vec<usize>) {
    let layout = model.layout();
    let all: Vec<_> =
        m.harmonics(layout).map(|h| (h.group, h.sine, h.multiples.iter().rev().map(|k| -k).collect())).collect();
    let of = m.powers(layout).iter().enumerate().filter(|(_, p)| **p != 0).map(|(v, _)| v).collect();
    (all.len(), all, m.degree(layout), of)
}

/// A sum.
pub(super) fn sum(model: &ExplicitModel, sum: &Sum) -> Vec<Piece> {
    let mut terms: Vec<&(Monomial, f64)> = sum.terms().iter().collect();
    terms.sort_by_cached_key(|(m, _)| order(model, m));
    let mut out = Vec::new();
    for same in terms.chunk_by(|a, b| harmonics(model, &a.0) == harmonics(model, &b.0)) {
        let circular = harmonics(model, &same[0].0);
        let pieces: Vec<Piece> = same.iter().map(|(m, c)| multiple(*c, &variables(model, m))).collect();
        if circular.is_empty() {
            out.extend(pieces);
        } else {
            out.push(bracketed(&circular, pieces, true));
        }
    }
    out
}
