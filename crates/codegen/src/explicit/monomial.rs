//! What a term of the normal form is, but for its coefficient.

use super::Layout;

/// A product of powers of variables and of one sine or cosine of integer multiples of angles for each group of angles.
///
/// The first multiple in a group that is not zero is positive, so that equal products look alike.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Monomial(Box<[i8]>);

/// A sine or cosine that a term has for a factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Harmonic<'a> {
    /// Whether it is a sine.
    pub sine: bool,
    /// The group of its angles.
    pub group: usize,
    /// Multiples of the group's angles.
    pub multiples: &'a [i8],
}

impl Monomial {
    /// One.
    pub(super) fn one(layout: &Layout) -> Self {
        Self(vec![0; layout.width()].into())
    }

    /// A variable.
    pub(super) fn variable(layout: &Layout, variable: usize) -> Self {
        let mut one = Self::one(layout);
        one.0[layout.first_power() + variable] = 1;
        one
    }

    /// A sine or cosine of multiples of the angles of one group, and the sign it takes to write it so; none if it is zero.
    pub(super) fn harmonic(layout: &Layout, group: usize, sine: bool, multiples: &[i8]) -> Option<(Self, f64)> {
        let mut one = Self::one(layout);
        let sign = one.set(layout, group, sine, multiples)?;
        Some((one, sign))
    }

    fn set(&mut self, layout: &Layout, group: usize, sine: bool, multiples: &[i8]) -> Option<f64> {
        let range = layout.groups[group].clone();
        let Some(first) = multiples.iter().find(|k| **k != 0) else { return (!sine).then_some(1.0) };
        let turned = *first < 0;
        for (to, k) in self.0[range].iter_mut().zip(multiples) {
            *to = if turned { -k } else { *k };
        }
        self.0[layout.angles.len() + group] = i8::from(sine);
        Some(if turned && sine { -1.0 } else { 1.0 })
    }

    /// Whether it is one.
    pub fn is_one(&self) -> bool {
        self.0.iter().all(|x| *x == 0)
    }

    /// The same among so many more variables.
    pub(super) fn extended(&self, more: usize) -> Self {
        Self(self.0.iter().copied().chain(core::iter::repeat_n(0, more)).collect())
    }

    /// Multiplies it by a variable.
    pub(super) fn raise(&mut self, layout: &Layout, variable: usize) {
        self.0[layout.first_power() + variable] += 1;
    }

    /// Powers of the variables.
    pub fn powers(&self, layout: &Layout) -> &[i8] {
        &self.0[layout.first_power()..]
    }

    /// The sine or cosine of a group's angles; none if there is none.
    pub fn of_group(&self, layout: &Layout, group: usize) -> Option<Harmonic<'_>> {
        let multiples = &self.0[layout.groups[group].clone()];
        let sine = self.0[layout.angles.len() + group] != 0;
        multiples.iter().any(|k| *k != 0).then_some(Harmonic { sine, group, multiples })
    }

    /// Its sines and cosines.
    pub fn harmonics<'a>(&'a self, layout: &'a Layout) -> impl Iterator<Item = Harmonic<'a>> {
        (0..layout.groups.len()).filter_map(|group| self.of_group(layout, group))
    }

    /// Its total degree in the modal coordinates.
    pub fn degree(&self, layout: &Layout) -> usize {
        self.powers(layout)[layout.modal.clone()].iter().map(|p| usize::try_from(*p).unwrap_or(0)).sum()
    }

    /// The products that a product of two is the sum of, each with a factor: products of sines and cosines of a group are sums of
    /// those of sums and differences of their angles.
    pub(super) fn times(&self, other: &Self, layout: &Layout, mut each: impl FnMut(Self, f64)) {
        let mut first = Self::one(layout);
        let powers = self.powers(layout).iter().zip(other.powers(layout));
        for (to, (a, b)) in first.0[layout.first_power()..].iter_mut().zip(powers) {
            *to = a + b;
        }
        let mut all = vec![(first, 1.0)];
        for group in 0..layout.groups.len() {
            match (self.of_group(layout, group), other.of_group(layout, group)) {
                (None, None) => {}
                (Some(h), None) | (None, Some(h)) => {
                    for (m, _) in &mut all {
                        m.set(layout, group, h.sine, h.multiples);
                    }
                }
                (Some(a), Some(b)) => all = both(layout, &all, a, b),
            }
        }
        all.into_iter().for_each(|(m, c)| each(m, c));
    }

    /// Its derivative by an input: a factor and what it multiplies.
    pub(crate) fn derivative(&self, layout: &Layout, input: super::Input) -> Option<(Self, f64)> {
        let mut out = self.clone();
        match input {
            super::Input::Variable(v) => {
                let power = &mut out.0[layout.first_power() + v];
                let factor = f64::from(*power);
                *power -= 1;
                (factor != 0.0).then_some((out, factor))
            }
            super::Input::Angle(angle) => {
                let (k, flag) = (self.0[angle], layout.angles.len() + layout.group_of(angle));
                let sine = self.0[flag] != 0;
                out.0[flag] = i8::from(!sine);
                // d sin = k cos, d cos = −k sin
                (k != 0).then_some((out, if sine { f64::from(k) } else { -f64::from(k) }))
            }
        }
    }

    /// Its reciprocal, if it has no sine or cosine.
    pub(super) fn inverse(&self, layout: &Layout) -> Option<Self> {
        let free = self.harmonics(layout).next().is_none();
        free.then(|| Self(self.0.iter().map(|power| -power).collect()))
    }

    /// The same with one variable's power taken out, and that power.
    pub(super) fn without_variable(&self, layout: &Layout, v: usize) -> (Self, i8) {
        let mut rest = self.clone();
        let power = core::mem::take(&mut rest.0[layout.first_power() + v]);
        (rest, power)
    }

    /// The same without a group's sine or cosine.
    pub(super) fn without_group(&self, layout: &Layout, group: usize) -> Self {
        let mut rest = self.clone();
        rest.0[layout.groups[group].clone()].fill(0);
        rest.0[layout.angles.len() + group] = 0;
        rest
    }
}

/// Each of `all` times the product of two harmonics of one group.
fn both(layout: &Layout, all: &[(Monomial, f64)], a: Harmonic, b: Harmonic) -> Vec<(Monomial, f64)> {
    let combined = |sign: i8| -> Vec<i8> { a.multiples.iter().zip(b.multiples).map(|(x, y)| x + sign * y).collect() };
    // cos a cos b = ½ (cos(a + b) + cos(a − b)), sin a sin b = ½ (cos(a − b) − cos(a + b)),
    // sin a cos b = ½ (sin(a + b) + sin(a − b)), cos a sin b = ½ (sin(a + b) − sin(a − b))
    let (sine, of_sum, of_difference) = match (a.sine, b.sine) {
        (false, false) => (false, 0.5, 0.5),
        (true, true) => (false, -0.5, 0.5),
        (true, false) => (true, 0.5, 0.5),
        (false, true) => (true, 0.5, -0.5),
    };
    let mut out = Vec::with_capacity(2 * all.len());
    for (multiples, factor) in [(combined(1), of_sum), (combined(-1), of_difference)] {
        for (m, c) in all {
            let mut m = m.clone();
            if let Some(sign) = m.set(layout, a.group, sine, &multiples) {
                out.push((m, c * factor * sign));
            }
        }
    }
    out
}
