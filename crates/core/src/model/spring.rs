//! The spring of a transmission.

use super::piece::Piece;
use crate::Scalar;

/// `k(δ)`: a polynomial, or a table of knots in the model.
#[derive(Clone, Copy, Debug)]
pub struct Spring<T> {
    /// `K` [N m/rad]; for a table its slope at rest.
    pub stiffness: T,
    /// `K₃` [N m/rad³].
    pub cubic: T,
    /// Whether the torque is `K δ` and nothing else; decided once, so that straight springs are inverted by a division.
    pub straight: bool,
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
        let mut point = SpringPoint { torque: F::zero(), slope: F::zero(), energy: F::zero() };
        for (i, knot) in self.table(knots).iter().enumerate() {
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

    /// The pieces of a table; none of a polynomial.
    #[inline(always)]
    fn table<'k>(&self, knots: &'k [Knot<T>]) -> &'k [Knot<T>] {
        let first = usize::from(self.first_knot);
        knots.get(first..first + usize::from(self.knots)).unwrap_or(&[])
    }

    /// The polynomial `k` that the torque is around `deflection`.
    #[inline(always)]
    pub(crate) fn piece_at<F: Scalar<Param = T>>(&self, deflection: F, knots: &[Knot<T>]) -> Piece<F> {
        let mut piece = self.whole();
        for (i, knot) in self.table(knots).iter().enumerate() {
            let here = knot.piece();
            piece = if i == 0 { here } else { Piece::select_less(deflection, here.start, piece, here) };
        }
        piece
    }

    /// The deflection at which the torque is `torque` [rad], and the polynomial there: `k⁻¹`. Not a number if the search does not
    /// come near it, which takes a torque of hundreds of times what bends the spring out of its straight part.
    #[inline(always)]
    pub(crate) fn deflection<F: Scalar<Param = T>>(&self, torque: F, knots: &[Knot<T>]) -> (F, Piece<F>) {
        let whole = self.whole();
        if self.straight {
            return (torque / whole.c[1], whole);
        }
        if self.knots == 0 {
            // At least as stiff as its straight part.
            let reach = torque / whole.c[1];
            let zero = F::zero();
            let (low, high) = (reach.select_less(zero, reach, zero), reach.select_less(zero, zero, reach));
            return (whole.solve(torque, low, high), whole);
        }
        // The piece whose torques reach from below to above: a table increases. Left of the first and right of the last it is straight.
        let table = self.table(knots);
        let (mut piece, mut low, mut high) = (whole, F::zero(), F::zero());
        for (i, knot) in table.iter().enumerate() {
            let here = knot.piece::<F>();
            let straight = (torque - here.c[0]) / here.c[1];
            let width = table.get(i + 1).map_or(straight, |next| F::from_param(next.start) - here.start);
            let (left, right) = if i == 0 { (straight, width) } else { (F::zero(), width) };
            if i == 0 {
                (piece, low, high) = (here, left, right);
            } else {
                let first = here.c[0];
                low = torque.select_less(first, low, left);
                high = torque.select_less(first, high, right);
                piece = Piece::select_less(torque, first, piece, here);
            }
        }
        (piece.start + piece.solve(torque, low, high), piece)
    }

    /// A polynomial spring as one piece.
    #[inline(always)]
    fn whole<F: Scalar<Param = T>>(&self) -> Piece<F> {
        let (k, k3) = (F::from_param(self.stiffness), F::from_param(self.cubic));
        Piece { start: F::zero(), c: [F::zero(), k, F::zero(), k3] }
    }

    pub(crate) fn map<U>(self, mut f: impl FnMut(T) -> U) -> Spring<U> {
        Spring {
            stiffness: f(self.stiffness),
            cubic: f(self.cubic),
            straight: self.straight,
            first_knot: self.first_knot,
            knots: self.knots,
        }
    }
}

impl<T: Scalar> Knot<T> {
    #[inline(always)]
    fn piece<F: Scalar<Param = T>>(&self) -> Piece<F> {
        let [c0, c1, c2, c3] = self.c;
        let p = F::from_param;
        Piece { start: p(self.start), c: [p(c0), p(c1), p(c2), p(c3)] }
    }

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
    let whole = Spring { stiffness: 0.0, cubic: 0.0, straight: false, first_knot: 0, knots: (n + 1) as u16 };
    let at_rest = whole.energy(0.0, knots);
    for knot in &mut knots[..n + 1] {
        knot.energy -= at_rest;
    }
    Some(n + 1)
}
