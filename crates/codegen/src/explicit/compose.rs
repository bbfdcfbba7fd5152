//! From sums of terms back to expressions, with what several terms share taken out of them.

use super::{ExplicitModel, Harmonic, Layout, Monomial, Sum};
use crate::sym::Sym;
use gyroflex::Scalar;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

type Terms = Vec<(Monomial, f64)>;
/// Whether it is a sine, and multiples of angles.
type Circular = (bool, Vec<i8>);

/// Writes sums as expressions of positions and kept parameters. Made inside a trace.
pub(super) struct Composer<'a> {
    layout: &'a Layout,
    inputs: Vec<Sym>,
    /// Sine and cosine of multiples of a group's angles.
    harmonics: FxHashMap<(usize, Vec<i8>), (Sym, Sym)>,
}

impl<'a> Composer<'a> {
    /// At positions and kept parameters.
    pub(super) fn new(model: &'a ExplicitModel, q: &[Sym], parameters: &[Sym]) -> Self {
        Self { layout: &model.layout, inputs: [q, parameters].concat(), harmonics: FxHashMap::default() }
    }

    /// The expression of a sum.
    pub(super) fn compose(&mut self, sum: &Sum) -> Sym {
        self.nested(sum.terms().to_vec(), 0)
    }

    /// Terms with the factors of one group or variable after the other taken out.
    fn nested(&mut self, terms: Terms, factor: usize) -> Sym {
        let (layout, groups) = (self.layout, self.layout.groups.len());
        if factor == groups + layout.variables.len() {
            return Sym::from_f64(terms.iter().map(|(_, c)| c).sum());
        }
        if let Some(v) = factor.checked_sub(groups) {
            let mut parts: BTreeMap<i8, Terms> = BTreeMap::new();
            for (m, c) in terms {
                let (rest, power) = m.without_variable(layout, v);
                parts.entry(power).or_default().push((rest, c));
            }
            let x = self.inputs[layout.variables[v]];
            return self.added(parts.into_iter().map(|(power, part)| (power_of(x, power), part)), factor);
        }
        let mut parts: BTreeMap<Option<Circular>, Terms> = BTreeMap::new();
        for (m, c) in terms {
            let key = m.of_group(layout, factor).map(|h| (h.sine, h.multiples.to_vec()));
            parts.entry(key).or_default().push((m.without_group(layout, factor), c));
        }
        let parts: Vec<(Sym, Terms)> = parts
            .into_iter()
            .map(|(key, part)| match key {
                None => (Sym::one(), part),
                Some((sine, multiples)) => {
                    (self.harmonic(&Harmonic { sine, group: factor, multiples: &multiples }), part)
                }
            })
            .collect();
        self.added(parts.into_iter(), factor)
    }

    fn added(&mut self, parts: impl Iterator<Item = (Sym, Terms)>, factor: usize) -> Sym {
        let mut sum = Sym::zero();
        for (x, part) in parts {
            sum += self.nested(part, factor + 1) * x;
        }
        sum
    }

    /// A sine or cosine: of whole multiples by those of the angle itself.
    fn harmonic(&mut self, harmonic: &Harmonic) -> Sym {
        let (sin, cos) = self.sin_cos(harmonic.group, harmonic.multiples);
        if harmonic.sine { sin } else { cos }
    }

    fn sin_cos(&mut self, group: usize, multiples: &[i8]) -> (Sym, Sym) {
        let key = (group, multiples.to_vec());
        if let Some(known) = self.harmonics.get(&key) {
            return *known;
        }
        let whole = multiples.iter().fold(0, |g, k| greatest_divisor(g, k.unsigned_abs())).cast_signed();
        let new = if whole > 1 {
            let (low, high) = (whole / 2, whole - whole / 2);
            let of = |times: i8| -> Vec<i8> { multiples.iter().map(|k| k / whole * times).collect() };
            let ((s, c), (t, d)) = (self.sin_cos(group, &of(low)), self.sin_cos(group, &of(high)));
            let two = Sym::from_f64(2.0);
            if low == high { (two * s * c, Sym::one() - two * s * s) } else { (s * d + c * t, c * d - s * t) }
        } else {
            let angles = &self.layout.angles[self.layout.groups[group].clone()];
            let mut angle = Sym::zero();
            for (q, k) in angles.iter().zip(multiples) {
                angle += Sym::from_f64((*k).into()) * self.inputs[*q];
            }
            angle.sin_cos()
        };
        self.harmonics.insert(key, new);
        new
    }
}

fn greatest_divisor(a: u8, b: u8) -> u8 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}

fn power_of(x: Sym, power: i8) -> Sym {
    let product = (0..power.unsigned_abs()).fold(Sym::one(), |product, _| product * x);
    if power < 0 { Sym::one() / product } else { product }
}
