//! The spring of a transmission.

use crate::Scalar;

/// `k(δ)`: a polynomial, or a table of knots in the model.
#[derive(Clone, Copy, Debug)]
pub struct Spring<T> {
    /// `K` [N m/rad]; for a table its slope at rest.
    pub stiffness: T,
    /// `K₃` [N m/rad³].
    pub cubic: T,
    /// Index of the table's first piece among the model's knots.
    pub first_knot: u16,
    /// Number of pieces; zero for a polynomial.
    pub knots: u16,
}

/// One piece of a spring table: right of `start`, with `x = δ − start`, the torque is `c₀ + c₁ x + c₂ x² + c₃ x³`.
/// The first piece of a table also holds left of its start, where it is straight.
#[derive(Clone, Copy, Debug)]
pub struct Knot<T> {
    /// `start` [rad].
    pub start: T,
    /// `c₀ … c₃`.
    pub c: [T; 4],
    /// Energy at `start`, so that it is zero at `δ = 0` [J].
    pub energy: T,
}

/// Torque [N m], tangent stiffness [N m/rad] and stored energy [J] of a spring at one deflection.
#[derive(Clone, Copy, Debug)]
struct SpringPoint<T> {
    torque: T,
    slope: T,
    energy: T,
}

impl<T: Scalar> Spring<T> {
    /// `k(δ)` [N m], `knots` being the model's.
    #[inline(always)]
    pub fn torque<F: Scalar<Param = T>>(&self, deflection: F, knots: &[Knot<T>]) -> F {
        if self.knots == 0 {
            let (k, k3) = (F::from_param(self.stiffness), F::from_param(self.cubic));
            return deflection * k3.mul_add(deflection * deflection, k);
        }
        self.in_table(deflection, knots).torque
    }

    /// `k'(δ)` [N m/rad].
    #[inline(always)]
    pub fn slope<F: Scalar<Param = T>>(&self, deflection: F, knots: &[Knot<T>]) -> F {
        if self.knots == 0 {
            let (k, k3) = (F::from_param(self.stiffness), F::from_param(self.cubic));
            return k + F::from_f64(3.0) * k3 * deflection * deflection;
        }
        self.in_table(deflection, knots).slope
    }

    /// `∫₀^δ k` [J].
    pub fn energy<F: Scalar<Param = T>>(&self, deflection: F, knots: &[Knot<T>]) -> F {
        if self.knots == 0 {
            let (k, k3, d2) = (F::from_param(self.stiffness), F::from_param(self.cubic), deflection * deflection);
            return d2 * (F::from_f64(0.5) * k + F::from_f64(0.25) * k3 * d2);
        }
        self.in_table(deflection, knots).energy
    }

    /// Walks all pieces and keeps the last one that starts left of `deflection`: the same work for every deflection.
    #[inline(never)]
    fn in_table<F: Scalar<Param = T>>(&self, deflection: F, knots: &[Knot<T>]) -> SpringPoint<F> {
        let first = self.first_knot as usize;
        let table = knots.get(first..first + self.knots as usize).unwrap_or(&[]);
        let mut point = SpringPoint { torque: F::zero(), slope: F::zero(), energy: F::zero() };
        for (i, knot) in table.iter().enumerate() {
            let here = knot.at(deflection);
            let before = if i == 0 { here } else { point };
            let start = F::from_param(knot.start);
            let pick = |old, new| deflection.select_less(start, old, new);
            point = SpringPoint {
                torque: pick(before.torque, here.torque),
                slope: pick(before.slope, here.slope),
                energy: pick(before.energy, here.energy),
            };
        }
        point
    }

    pub(crate) fn map<U>(self, mut f: impl FnMut(T) -> U) -> Spring<U> {
        Spring { stiffness: f(self.stiffness), cubic: f(self.cubic), first_knot: self.first_knot, knots: self.knots }
    }
}

impl<T: Scalar> Knot<T> {
    #[inline(always)]
    fn at<F: Scalar<Param = T>>(&self, deflection: F) -> SpringPoint<F> {
        let x = deflection - F::from_param(self.start);
        let [c0, c1, c2, c3] = self.c.map(F::from_param);
        let f = F::from_f64;
        SpringPoint {
            torque: c0 + x * (c1 + x * (c2 + x * c3)),
            slope: c1 + x * (f(2.0) * c2 + x * f(3.0) * c3),
            energy: F::from_param(self.energy)
                + x * (c0 + x * (f(0.5) * c1 + x * (f(1.0 / 3.0) * c2 + x * f(0.25) * c3))),
        }
    }
}

impl Knot<f64> {
    /// A placeholder to fill storage with before lowering.
    pub const EMPTY: Self = Self { start: 0.0, c: [0.0; 4], energy: 0.0 };

    /// The same piece in another scalar.
    pub fn cast<U: Scalar>(&self) -> Knot<U> {
        Knot { start: U::from_f64(self.start), c: self.c.map(U::from_f64), energy: U::from_f64(self.energy) }
    }
}

/// Writes the monotone cubic (harmonic-mean slopes, Fritsch & Butland 1984) through the points of `table` as knots, straight beyond both ends,
/// and returns how many; `None` if there is not room for them. A table from `[0, 0]` is continued oddly.
pub(crate) fn lower_table(table: &[[f64; 2]], knots: &mut [Knot<f64>]) -> Option<usize> {
    let odd = table[0] == [0.0, 0.0];
    let mirrored = if odd { table.len() - 1 } else { 0 };
    let n = table.len() + mirrored;
    // Point i of the whole curve, mirrored part first.
    let point = |i: usize| {
        if i < mirrored {
            let [x, y] = table[mirrored - i];
            [-x, -y]
        } else {
            table[i - mirrored]
        }
    };
    let secant = |i: usize| (point(i + 1)[1] - point(i)[1]) / (point(i + 1)[0] - point(i)[0]);
    // The harmonic mean of neighbouring secants keeps a strictly increasing table strictly increasing.
    let slope = |i: usize| match i {
        0 => secant(0),
        _ if i == n - 1 => secant(n - 2),
        _ => 2.0 * secant(i - 1) * secant(i) / (secant(i - 1) + secant(i)),
    };
    if knots.len() < n + 1 {
        return None;
    }
    let [x0, y0] = point(0);
    knots[0] = Knot { start: x0, c: [y0, slope(0), 0.0, 0.0], energy: 0.0 };
    for i in 0..n {
        let [x, y] = point(i);
        let mut c = [y, slope(i), 0.0, 0.0];
        if i + 1 < n {
            let (h, s) = (point(i + 1)[0] - x, secant(i));
            c[2] = (3.0 * s - 2.0 * slope(i) - slope(i + 1)) / h;
            c[3] = (slope(i) + slope(i + 1) - 2.0 * s) / (h * h);
        }
        let energy = if i == 0 { 0.0 } else { knots[i].at(x).energy };
        knots[i + 1] = Knot { start: x, c, energy };
    }
    // Energy is counted from the unloaded spring.
    let whole = Spring { stiffness: 0.0, cubic: 0.0, first_knot: 0, knots: (n + 1) as u16 };
    let at_rest = whole.energy(0.0, knots);
    for knot in &mut knots[..n + 1] {
        knot.energy -= at_rest;
    }
    Some(n + 1)
}
