//! Splines of higher degree through points in time.

use gyroflex::control::reference::{Piecewise, Reference};

/// How a spline begins and ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// At rest: all derivatives that are continuous vanish, so that it holds before and after as smoothly as it moves. Knots of its
    /// own divide the first and the last interval evenly.
    Rest,
    /// With the derivatives of the polynomial of its degree through the points nearest to the end; outside it holds, after a jump.
    Nearest,
}

/// A piecewise polynomial of odd degree `p` through points, `p − 1` times continuously differentiable; constant outside.
///
/// It is computed in B-splines (de Boor, *A Practical Guide to Splines*), whose matrix is banded and totally positive: elimination needs
/// no pivoting.
#[derive(Clone, Debug)]
pub struct SmoothSpline {
    /// Where pieces begin, and the end [s].
    breaks: Vec<f64>,
    /// Taylor coefficients about the beginning of each piece.
    taylor: Vec<f64>,
    degree: usize,
}

impl SmoothSpline {
    /// The largest degree: beyond, rounding of the points shows in the derivatives.
    pub const MAX_DEGREE: usize = 15;

    /// The spline of `degree` through `values` at strictly increasing `times`; `None` if the degree is not odd and from 3 to
    /// [`SmoothSpline::MAX_DEGREE`], there are fewer than two points, times do not increase, or a number is not finite.
    pub fn new(times: &[f64], values: &[f64], degree: usize, ends: Ends) -> Option<Self> {
        let (n, p) = (times.len(), degree);
        let finite = times.iter().chain(values).all(|x| x.is_finite());
        let usable = n >= 2 && values.len() == n && finite && times.windows(2).all(|w| w[0] < w[1]);
        if !usable || p.is_multiple_of(2) || !(3..=Self::MAX_DEGREE).contains(&p) {
            return None;
        }
        let (breaks, first, last) = match ends {
            Ends::Rest => {
                let still = |q: f64| (0..p).map(|k| if k == 0 { q } else { 0.0 }).collect();
                (divided(times, (p - 1) / 2), still(values[0]), still(values[n - 1]))
            }
            Ends::Nearest => {
                let (near, count) = (n.min(p + 1), p.div_ceil(2));
                let first = newton(&times[..near], &values[..near], times[0], count);
                let last = newton(&times[n - near..], &values[n - near..], times[n - 1], count);
                (times.to_vec(), first, last)
            }
        };
        let pieces = breaks.len() - 1;
        let mut knots = vec![breaks[0]; p];
        knots.extend_from_slice(&breaks);
        knots.extend(std::iter::repeat_n(breaks[pieces], p));

        // Coefficients at the ends follow from derivatives there, those between from the points.
        let mirrored: Vec<f64> = knots.iter().rev().map(|x| -x).collect();
        let turned: Vec<f64> = last.iter().enumerate().map(|(k, d)| if k % 2 == 0 { *d } else { -d }).collect();
        let mut c = vec![0.0; pieces + p];
        let (head, tail) = (from_derivatives(&first, &knots, p), from_derivatives(&turned, &mirrored, p));
        c[..head.len()].copy_from_slice(&head);
        c.iter_mut().rev().zip(&tail).for_each(|(c, x)| *c = *x);
        interpolate(&times[1..n - 1], &values[1..n - 1], &knots, p, head.len(), &mut c);

        let taylor = (0..pieces).flat_map(|i| taylor(&c[i..=i + p], &knots, p, p + i)).collect();
        Some(Self { breaks, taylor, degree })
    }

    /// First and last time [s].
    pub fn span(&self) -> (f64, f64) {
        (self.breaks[0], self.breaks[self.breaks.len() - 1])
    }
}

impl Reference<f64> for SmoothSpline {
    fn add_derivatives(&self, t: f64, weight: f64, out: &mut [f64]) {
        Piecewise { knots: &self.breaks, coefficients: &self.taylor, smoothness: None }.add_derivatives(t, weight, out);
    }

    /// With [`Ends::Nearest`] within its span only; where it holds before and after, the velocity jumps.
    fn smoothness(&self) -> Option<usize> {
        Some(self.degree)
    }
}

/// `times` with `extra` more in the first and in the last interval, at equal distances.
fn divided(times: &[f64], extra: usize) -> Vec<f64> {
    let last = times.len() - 2;
    let mut out = Vec::with_capacity(times.len() + 2 * extra);
    for (i, w) in times.windows(2).enumerate() {
        let parts = 1 + if i == 0 { extra } else { 0 } + if i == last { extra } else { 0 };
        out.extend((0..parts).map(|k| w[0] + (w[1] - w[0]) * k as f64 / parts as f64));
    }
    out.push(times[last + 1]);
    out
}

/// The first `count` derivatives at `at`, from the 0th, of the polynomial through all points given (Newton's divided differences).
fn newton(times: &[f64], values: &[f64], at: f64, count: usize) -> Vec<f64> {
    let n = times.len();
    let mut c = values.to_vec();
    for level in 1..n {
        for i in (level..n).rev() {
            c[i] = (c[i] - c[i - 1]) / (times[i] - times[i - level]);
        }
    }
    let mut out = vec![0.0; count];
    for i in (0..n).rev() {
        // Times (x − t_i), plus c_i, as a polynomial in x − at.
        for k in (0..count).rev() {
            out[k] = out[k] * (at - times[i]) + if k > 0 { out[k - 1] } else { c[i] };
        }
    }
    let mut factorial = 1.0;
    for (k, d) in out.iter_mut().enumerate().skip(1) {
        factorial *= k as f64;
        *d *= factorial;
    }
    out
}

/// The first coefficients of a spline, from as many derivatives where it begins: the rule for the coefficients of a derivative,
/// `c⁽ᵏ⁾_i = (p−k+1) (c⁽ᵏ⁻¹⁾_{i+1} − c⁽ᵏ⁻¹⁾_i) / (t_{i+p+1} − t_{i+k})`, read backwards.
fn from_derivatives(derivatives: &[f64], knots: &[f64], p: usize) -> Vec<f64> {
    let mut own = derivatives.to_vec();
    let mut out = Vec::with_capacity(own.len());
    for i in 0..own.len() {
        out.push(own[0]);
        for k in 1..own.len() - i {
            own[k - 1] += own[k] * (knots[i + p + 1] - knots[i + k]) / (p + 1 - k) as f64;
        }
    }
    out
}

/// The `degree + 1` B-splines that are not zero between the knots `span` and `span + 1`, at `x` (Cox, de Boor).
fn basis(knots: &[f64], span: usize, degree: usize, x: f64) -> Vec<f64> {
    let mut b = vec![1.0];
    for d in 1..=degree {
        let mut saved = 0.0;
        for r in 0..d {
            let (right, left) = (knots[span + r + 1], knots[span + 1 + r - d]);
            let part = b[r] / (right - left);
            b[r] = saved + (right - x) * part;
            saved = (x - left) * part;
        }
        b.push(saved);
    }
    b
}

/// Fills the coefficients from number `from` on such that the spline passes the points: one point for each, those around are given.
fn interpolate(times: &[f64], values: &[f64], knots: &[f64], p: usize, from: usize, c: &mut [f64]) {
    let n = times.len();
    // Entry p of a row is its diagonal.
    let mut rows = vec![vec![0.0; 2 * p + 1]; n];
    for (r, (&t, &value)) in times.iter().zip(values).enumerate() {
        let span = knots.partition_point(|x| *x <= t) - 1;
        let mut rest = value;
        for (i, b) in (span - p..).zip(basis(knots, span, p, t)) {
            match i.checked_sub(from).filter(|column| *column < n) {
                Some(column) => rows[r][column + p - r] = b,
                None => rest -= b * c[i],
            }
        }
        c[from + r] = rest;
    }
    for r in 0..n {
        let (above, below) = rows.split_at_mut(r + 1);
        for (k, row) in below.iter_mut().take(p).enumerate() {
            let factor = row[p - 1 - k] / above[r][p];
            for i in 0..=p {
                let at = p - 1 - k + i;
                row[at] -= factor * above[r][p + i];
            }
            c[from + r + 1 + k] -= factor * c[from + r];
        }
    }
    for r in (0..n).rev() {
        let right: f64 = (1..=p.min(n - 1 - r)).map(|i| rows[r][p + i] * c[from + r + i]).sum();
        c[from + r] = (c[from + r] - right) / rows[r][p];
    }
}

/// Taylor coefficients of the piece that begins at the knot `span`, from the `p + 1` coefficients that it depends on.
fn taylor(c: &[f64], knots: &[f64], p: usize, span: usize) -> Vec<f64> {
    let (mut c, first, mut factorial) = (c.to_vec(), span - p, 1.0);
    let mut out = Vec::with_capacity(p + 1);
    for k in 0..=p {
        if k > 0 {
            for i in 0..=p - k {
                let width = knots[first + i + p + 1] - knots[first + i + k];
                c[i] = (p + 1 - k) as f64 * (c[i + 1] - c[i]) / width;
            }
            c.truncate(p - k + 1);
            factorial *= k as f64;
        }
        let value: f64 = basis(knots, span, p - k, knots[span]).iter().zip(&c).map(|(b, c)| b * c).sum();
        out.push(value / factorial);
    }
    out
}
