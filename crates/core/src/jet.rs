//! Truncated Taylor series in time: a number together with its derivatives.

use crate::Scalar;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A function of time up to order `K − 1`: the coefficients `c_k = f⁽ᵏ⁾/k!` of its Taylor series about the present.
///
/// All arithmetic is that of power series (Griewank & Walther, *Evaluating Derivatives*, table 13.1 and 13.2), so that an
/// algorithm that runs on a jet of its inputs gives the jet of its results. A choice ([`Scalar::select_less`]) is made by the
/// present value.
///
/// ```
/// use gyroflex::{Jet, Scalar};
///
/// // sin(2 t + t²) about t = 0.
/// let t = Jet::<f64, 4>::time(0.0);
/// let (sin, _) = (t * Jet::from_f64(2.0) + t * t).sin_cos();
/// assert_eq!(sin.derivative(1), 2.0);
/// assert_eq!(sin.derivative(2), 2.0);
/// assert!((sin.derivative(3) + 8.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<T, const K: usize>(pub [T; K]);

impl<T: Scalar, const K: usize> Jet<T, K> {
    /// A number that does not change.
    #[inline(always)]
    pub fn constant(x: T) -> Self {
        Self::from_fn(|k| if k == 0 { x } else { T::zero() })
    }

    /// Time itself, now `t` [s].
    pub fn time(t: T) -> Self {
        Self::from_fn(|k| match k {
            0 => t,
            1 => T::one(),
            _ => T::zero(),
        })
    }

    /// The jet of a function with these derivatives: `derivatives[k]` is the `k`-th, those left out are zero.
    pub fn from_derivatives(derivatives: &[T]) -> Self {
        Self::from_fn(|k| derivatives.get(k).map_or(T::zero(), |d| *d * T::from_f64(inverse_factorial(k))))
    }

    /// The `k`-th derivative; zero beyond the order of the jet.
    pub fn derivative(&self, k: usize) -> T {
        self.0.get(k).map_or(T::zero(), |c| *c * T::from_f64(factorial(k)))
    }

    /// The present value.
    #[inline(always)]
    pub fn value(&self) -> T {
        self.0.first().map_or(T::zero(), |c| *c)
    }

    /// The jet of the derivative, of which the last coefficient is unknown and taken for zero.
    #[inline(always)]
    pub fn rate(&self) -> Self {
        Self::from_fn(|k| self.0.get(k + 1).map_or(T::zero(), |c| *c * T::from_f64((k + 1) as f64)))
    }

    /// Every coefficient times a number that does not change.
    #[inline(always)]
    pub fn scale(mut self, factor: T) -> Self {
        for c in &mut self.0 {
            *c = *c * factor;
        }
        self
    }

    /// Coefficients one by one.
    #[inline(always)]
    pub fn from_fn(f: impl Fn(usize) -> T) -> Self {
        let mut jet = Self([T::zero(); K]);
        for k in 0..K {
            jet.0[k] = f(k);
        }
        jet
    }

    /// Coefficient `k` of a product: `Σ a_i b_{k−i}`, `i` from `first` to `k − first`.
    #[inline(always)]
    pub(crate) fn convolved(&self, b: &Self, k: usize, first: usize) -> T {
        if K > UNROLLED {
            return self.convolved_in_a_loop(b, k, first);
        }
        let mut sum = T::zero();
        for i in first..(k + 1).saturating_sub(first) {
            sum = self.0[i].mul_add(b.0[k - i], sum);
        }
        sum
    }

    /// The same, as one piece of code for all `k`: of long series there would be too much.
    #[inline(never)]
    fn convolved_in_a_loop(&self, b: &Self, k: usize, first: usize) -> T {
        let mut sum = T::zero();
        let terms = (k + 1).saturating_sub(2 * first);
        for (x, y) in self.0.iter().skip(first).zip(b.0.iter().take(k + 1 - first.min(k)).rev()).take(terms) {
            sum = x.mul_add(*y, sum);
        }
        sum
    }

    /// Sine and cosine of an angle with this jet, `sin` and `cos` being those of its value.
    #[inline(always)]
    pub(crate) fn sin_cos_from(&self, sin: T, cos: T) -> (Self, Self) {
        // s' = c a',   c' = −s a':   k s_k = Σ i a_i c_{k−i}
        let (mut s, mut c) = (Self::constant(sin), Self::constant(cos));
        for k in 1..K {
            let (mut ds, mut dc) = (T::zero(), T::zero());
            for i in 1..=k {
                let a = self.0[i] * T::from_f64(i as f64);
                ds = a.mul_add(c.0[k - i], ds);
                dc = a.mul_add(s.0[k - i], dc);
            }
            let share = T::from_f64(reciprocal(k));
            (s.0[k], c.0[k]) = (ds * share, -(dc * share));
        }
        (s, c)
    }

    /// `f` with `f' = slope · self'`, the coefficients of `slope` being known as far as those of `f`.
    #[inline(always)]
    fn integrated(&self, value: T, slope: impl Fn(&Self, usize) -> T) -> Self {
        let mut f = Self::constant(value);
        let mut slopes = Self::constant(T::zero());
        for k in 1..K {
            slopes.0[k - 1] = slope(&f, k - 1);
            let mut sum = T::zero();
            for i in 1..=k {
                sum = (self.0[i] * T::from_f64(i as f64)).mul_add(slopes.0[k - i], sum);
            }
            f.0[k] = sum * T::from_f64(reciprocal(k));
        }
        f
    }
}

/// Coefficients up to which the loops of products are written out.
const UNROLLED: usize = 9;

/// `1/k!`, from a table: without a unit for doubles their arithmetic is slow.
#[inline(always)]
pub(crate) fn inverse_factorial(k: usize) -> f64 {
    INVERSE_FACTORIALS.get(k).map_or(0.0, |x| *x)
}

/// `k!`, likewise.
#[inline(always)]
pub(crate) fn factorial(k: usize) -> f64 {
    FACTORIALS.get(k).map_or(f64::INFINITY, |x| *x)
}

/// `1/k`, likewise.
#[inline(always)]
pub(crate) fn reciprocal(k: usize) -> f64 {
    RECIPROCALS.get(k).map_or(1.0 / k as f64, |x| *x)
}

/// Length of the tables: more than there are coefficients anywhere.
const TABLE: usize = 40;

const FACTORIALS: [f64; TABLE] = {
    let (mut table, mut k) = ([1.0; TABLE], 1);
    while k < TABLE {
        table[k] = table[k - 1] * k as f64;
        k += 1;
    }
    table
};

const INVERSE_FACTORIALS: [f64; TABLE] = {
    let (mut table, mut k) = ([1.0; TABLE], 0);
    while k < TABLE {
        table[k] = 1.0 / FACTORIALS[k];
        k += 1;
    }
    table
};

const RECIPROCALS: [f64; TABLE] = {
    let (mut table, mut k) = ([f64::INFINITY; TABLE], 1);
    while k < TABLE {
        table[k] = 1.0 / k as f64;
        k += 1;
    }
    table
};

impl<T: Scalar, const K: usize> Add for Jet<T, K> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self::from_fn(|k| self.0[k] + b.0[k])
    }
}

impl<T: Scalar, const K: usize> Sub for Jet<T, K> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self::from_fn(|k| self.0[k] - b.0[k])
    }
}

impl<T: Scalar, const K: usize> Neg for Jet<T, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::from_fn(|k| -self.0[k])
    }
}

impl<T: Scalar, const K: usize> Mul for Jet<T, K> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self::from_fn(|k| self.convolved(&b, k, 0))
    }
}

impl<T: Scalar, const K: usize> Div for Jet<T, K> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        // a = q b:   q_k = (a_k − Σ_{i≥1} b_i q_{k−i}) / b_0
        let share = T::one() / b.value();
        let mut q = self;
        for k in 0..K {
            let mut rest = self.0[k];
            for i in 1..=k {
                rest = (-b.0[i]).mul_add(q.0[k - i], rest);
            }
            q.0[k] = rest * share;
        }
        q
    }
}

impl<T: Scalar, const K: usize> AddAssign for Jet<T, K> {
    #[inline(always)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<T: Scalar, const K: usize> SubAssign for Jet<T, K> {
    #[inline(always)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

impl<T: Scalar, const K: usize> Scalar for Jet<T, K> {
    type Param = T::Param;

    #[inline(always)]
    fn from_param(x: T::Param) -> Self {
        Self::constant(T::from_param(x))
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self::constant(T::from_f64(x))
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.iter().all(|c| c.is_finite())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        // r² = a:   2 r_0 r_k = a_k − Σ_{0<i<k} r_i r_{k−i}
        let root = self.value().sqrt();
        let share = T::one() / (root + root);
        let mut r = Self::constant(root);
        for k in 1..K {
            r.0[k] = (self.0[k] - r.convolved(&r, k, 1)) * share;
        }
        r
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value().sin_cos();
        self.sin_cos_from(sin, cos)
    }

    fn atan2(self, x: Self) -> Self {
        // θ' = (x y' − y x') / (x² + y²)
        let rate = (x * self.rate() - self * x.rate()) / (x * x + self * self);
        let value = self.value().atan2(x.value());
        Self::from_fn(|k| match k {
            0 => value,
            _ => rate.0[k - 1] * T::from_f64(reciprocal(k)),
        })
    }

    fn tanh(self) -> Self {
        // t' = (1 − t²) a'
        self.integrated(self.value().tanh(), |t, k| {
            let one = if k == 0 { T::one() } else { T::zero() };
            one - t.convolved(t, k, 0)
        })
    }

    fn exp(self) -> Self {
        // e' = e a'
        self.integrated(self.value().exp(), |e, k| e.0[k])
    }

    #[inline(always)]
    fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self {
        Self::from_fn(|k| self.value().select_less(threshold.value(), less.0[k], otherwise.0[k]))
    }
}
