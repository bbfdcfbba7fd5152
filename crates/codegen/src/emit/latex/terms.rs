//! Sums as a person writes them: what shares sines and cosines in brackets before them.

use super::symbols;
use crate::explicit::{ExplicitModel, Monomial, Sum, rational};

/// A term: its sign, a positive coefficient, and what it multiplies.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) negative: bool,
    pub(super) coefficient: f64,
    pub(super) text: String,
}

impl Piece {
    /// A coefficient and what it multiplies.
    pub(super) fn of(c: f64, text: String) -> Self {
        Self { negative: c < 0.0, coefficient: c.abs(), text }
    }

    /// Without its sign.
    fn magnitude(&self) -> String {
        let coefficient = match rational(self.coefficient) {
            Some((1, 1)) if !self.text.is_empty() => String::new(),
            Some((numerator, 1)) => numerator.to_string(),
            Some((numerator, denominator)) => format!("\\tfrac{{{numerator}}}{{{denominator}}}"),
            None => number(self.coefficient),
        };
        coefficient + &self.text
    }
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
        out += &piece.magnitude();
    }
    if out.is_empty() { "0".to_owned() } else { out }
}

/// Several terms with a factor before them, or behind: in brackets, if they are several, from which their common sign and coefficient
/// are taken out.
pub(super) fn bracketed(before: &str, mut pieces: Vec<Piece>, behind: &str) -> Piece {
    let negative = pieces.first().is_some_and(|p| p.negative);
    let coefficient = pieces.first().map_or(1.0, |p| p.coefficient);
    let common = pieces.iter().all(|p| p.coefficient == coefficient);
    for piece in &mut pieces {
        piece.negative ^= negative;
        if common {
            piece.coefficient = 1.0;
        }
    }
    let coefficient = if common { coefficient } else { 1.0 };
    let text = match pieces.as_slice() {
        [one] => format!("{before}{}{behind}", one.text),
        _ => format!("{before}({}){behind}", joined(&pieces)),
    };
    Piece { negative, coefficient, text }
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

/// In which order terms are read.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Order {
    /// Few sines and cosines first, of few angles.
    harmonics: Vec<(usize, i32)>,
    /// Those of the first angles, and cosines before sines.
    multiples: Vec<(Vec<i8>, bool)>,
    /// Low degrees in the modal coordinates.
    degree: usize,
    variables: Vec<usize>,
}

pub(super) fn order(model: &ExplicitModel, m: &Monomial) -> Order {
    let layout = model.layout();
    let size = |k: &[i8]| k.iter().map(|k| i32::from(*k).abs()).sum();
    Order {
        harmonics: m.harmonics(layout).map(|h| (h.group, size(h.multiples))).collect(),
        multiples: m.harmonics(layout).map(|h| (h.multiples.iter().map(|k| -k).collect(), h.sine)).collect(),
        degree: m.degree(layout),
        variables: m.powers(layout).iter().enumerate().filter(|(_, p)| **p != 0).map(|(v, _)| v).collect(),
    }
}

/// A sum.
pub(super) fn sum(model: &ExplicitModel, sum: &Sum) -> Vec<Piece> {
    let mut terms: Vec<&(Monomial, f64)> = sum.terms().iter().collect();
    terms.sort_by_cached_key(|(m, _)| order(model, m));
    let mut out = Vec::new();
    for same in terms.chunk_by(|a, b| harmonics(model, &a.0) == harmonics(model, &b.0)) {
        let circular = harmonics(model, &same[0].0);
        let pieces: Vec<Piece> = same.iter().map(|(m, c)| Piece::of(*c, variables(model, m))).collect();
        if circular.is_empty() {
            out.extend(pieces);
        } else {
            out.push(bracketed("", pieces, &circular));
        }
    }
    out
}
