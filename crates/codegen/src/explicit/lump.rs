//! Coefficients as symbols: equal ones, and small multiples of one another, share one.

use super::sum::Collected;
use super::{Coordinate, ExplicitModel, Input, Layout, Monomial, Sum};

/// A lumped constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lump {
    /// Its value, positive, in SI units.
    pub(crate) value: f64,
    /// Its unit.
    pub(crate) unit: Unit,
}

/// Powers of kilogram, metre and second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Unit(pub(crate) [i32; 3]);

impl Unit {
    fn times(self, other: Self, power: i32) -> Self {
        Self(core::array::from_fn(|k| self.0[k] + power * other.0[k]))
    }

    fn is_number(self) -> bool {
        self.0 == [0; 3]
    }

    /// Of a kept parameter, radians left out.
    fn of_parameter(unit: &str) -> Self {
        Self(match unit {
            "m/s²" => [0, 1, -2],
            "kg" => [1, 0, 0],
            "kg m²" => [1, 2, 0],
            "N m/rad" => [1, 2, -2],
            "N/m" => [1, 0, -2],
            "N m s/rad" => [1, 2, -1],
            "N s/m" => [1, 0, -1],
            "rad/m" => [0, -1, 0],
            _ => [0; 3],
        })
    }
}

/// Numerators and denominators of the multiples that share a constant.
const SMALL: i32 = 4;
/// Relative difference of what counts as equal.
const EQUAL: f64 = 1e-9;

impl ExplicitModel {
    /// The same model with lumped constants in place of numbers: further variables after those that are there, whose coefficients are
    /// small rational numbers.
    pub(crate) fn lumped(&self) -> (Self, Vec<Lump>) {
        let n = self.nv();
        let mut found: Vec<Lump> = Vec::new();
        let size = |i: usize| i32::from(matches!(self.coordinates[i], Coordinate::Angle(_)));
        let unit_of = |i: usize, j: usize| Unit([1, size(i) + size(j), 0]);
        // From the tip to the base: entries there are the shorter ones, and have the constants that others have multiples of.
        for i in (0..n).rev() {
            for j in (i..n).rev() {
                self.find(self.mass(i, j), unit_of(i, j), &mut found);
            }
            for j in (0..n).rev() {
                self.find(self.coupling(i, j), unit_of(i, j), &mut found);
            }
        }
        let energy = Unit([1, 2, -2]);
        self.find(&self.potential, energy, &mut found);

        // Numbered in the order of reading.
        let mut order = Vec::new();
        let mut in_lumps = |sum: &Sum, unit: Unit, layout: &Layout| {
            let mut out = Collected::default();
            for (m, c) in sum.terms() {
                let (mut extended, mut multiple) =
                    (m.extended(layout.variables.len() - self.layout.variables.len()), *c);
                if let Some((k, ratio)) = self.known(m, *c, unit, &found) {
                    let place = order.iter().position(|o| *o == k).unwrap_or_else(|| {
                        order.push(k);
                        order.len() - 1
                    });
                    extended.raise(layout, self.layout.variables.len() + place);
                    multiple = ratio;
                }
                out.add(extended, multiple);
            }
            out.sum()
        };
        let mut out = self.clone();
        for k in 0..found.len() {
            out.layout.inputs.push(Input::Variable(self.layout.variables.len() + k));
            out.layout.variables.push(self.layout.inputs.len() + k);
        }
        let layout = out.layout.clone();
        for i in 0..n {
            for j in i..n {
                out.mass[self.upper(i, j)] = in_lumps(self.mass(i, j), unit_of(i, j), &layout);
            }
        }
        for at in 0..n * n {
            out.coupling[at] = in_lumps(&self.coupling[at], unit_of(at / n, at % n), &layout);
        }
        out.potential = in_lumps(&self.potential, energy, &layout);
        (out, order.into_iter().map(|k| found[k]).collect())
    }

    /// Adds the constants of a sum to those that are known.
    fn find(&self, sum: &Sum, unit: Unit, found: &mut Vec<Lump>) {
        for (m, c) in sum.terms() {
            let own = self.unit_in(m, unit);
            let number = own.is_number() && rational(*c).is_some();
            if !number && self.known(m, *c, unit, found).is_none() {
                found.push(Lump { value: c.abs(), unit: own });
            }
        }
    }

    /// The unit of a term's coefficient.
    fn unit_in(&self, m: &Monomial, unit: Unit) -> Unit {
        let n = self.nv();
        let powers = m.powers(&self.layout).iter().zip(&self.layout.variables);
        powers.fold(unit, |unit, (power, input)| {
            let of = match input.checked_sub(n) {
                None => Unit([0, 1, 0]),
                Some(k) => Unit::of_parameter(self.options.kept[k].unit()),
            };
            unit.times(of, -i32::from(*power))
        })
    }

    /// The constant of which a coefficient is a small multiple, and the multiple; none of a small number.
    fn known(&self, m: &Monomial, c: f64, unit: Unit, found: &[Lump]) -> Option<(usize, f64)> {
        let unit = self.unit_in(m, unit);
        if unit.is_number() && rational(c).is_some() {
            return None;
        }
        found.iter().enumerate().filter(|(_, lump)| lump.unit == unit).find_map(|(k, lump)| {
            let (numerator, denominator) = rational(c / lump.value)?;
            Some((k, f64::from(numerator) / f64::from(denominator)))
        })
    }
}

/// A number as a fraction of small numbers, if it is one.
pub(crate) fn rational(x: f64) -> Option<(i32, i32)> {
    (1..=SMALL).find_map(|denominator| {
        let numerator = x * f64::from(denominator);
        let whole = numerator.round();
        let near = (numerator - whole).abs() <= EQUAL * whole.abs() && (1.0..=f64::from(SMALL)).contains(&whole.abs());
        near.then_some((whole as i32, denominator))
    })
}
