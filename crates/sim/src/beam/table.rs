//! A mode shape given by points, as finite-element tools write it.

use nalgebra::{DMatrix, DVector};

/// A shape that is a cubic between its points.
///
/// With slopes given it is the field of Hermite's beam elements, whose stiffness is theirs. Without, it is a spline: the curvature is
/// continuous; at the root the slope is zero (clamped) or the curvature (not), and the last two pieces are one cubic.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// `x, φ, φ'` at the points, `x` ascending.
    points: Vec<[f64; 3]>,
}

impl Table {
    /// Through points with slopes, at least two, `x` strictly ascending.
    pub fn with_slopes(points: Vec<[f64; 3]>) -> Self {
        Self { points }
    }

    /// Through points `[x, φ]`, at least two, `x` strictly ascending.
    pub fn spline(points: &[[f64; 2]], clamped: bool) -> Self {
        let slopes = slopes(points, clamped);
        Self { points: points.iter().zip(&slopes).map(|([x, y], slope)| [*x, *y, *slope]).collect() }
    }

    /// Points and slopes.
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The derivative of order `k` by `x`, up to the third [1/mᵏ].
    pub fn derivative(&self, x: f64, k: usize) -> f64 {
        let last = self.points.len().saturating_sub(1);
        let after = self.points.partition_point(|p| p[0] <= x).clamp(1, last.max(1));
        let (Some([a, from, start]), Some([b, to, end])) = (self.points.get(after - 1), self.points.get(after)) else {
            return 0.0;
        };
        // y = from + start t + c t² + d t³, t = x − a
        let (h, t) = (b - a, x - a);
        let chord = (to - from) / h;
        let c = (3.0 * chord - 2.0 * start - end) / h;
        let d = (start + end - 2.0 * chord) / (h * h);
        match k {
            0 => from + t * (start + t * (c + t * d)),
            1 => start + t * (2.0 * c + 3.0 * t * d),
            2 => 2.0 * c + 6.0 * t * d,
            3 => 6.0 * d,
            _ => 0.0,
        }
    }
}

/// Slopes that make a cubic spline.
fn slopes(points: &[[f64; 2]], clamped: bool) -> Vec<f64> {
    let n = points.len();
    if n < 2 {
        return vec![0.0; n];
    }
    let pieces: Vec<[f64; 2]> = points
        .windows(2)
        .map(|p| {
            let h = p[1][0] - p[0][0];
            [h, (p[1][1] - p[0][1]) / h]
        })
        .collect();
    let (mut a, mut b) = (DMatrix::zeros(n, n), DVector::zeros(n));
    let [h, chord] = pieces[0];
    if clamped {
        a[(0, 0)] = 1.0;
    } else {
        (a[(0, 0)], a[(0, 1)], b[0]) = (2.0 / h, 1.0 / h, 3.0 * chord / h);
    }
    for i in 1..n - 1 {
        let ([h, chord], [k, next]) = (pieces[i - 1], pieces[i]);
        (a[(i, i - 1)], a[(i, i)], a[(i, i + 1)]) = (1.0 / h, 2.0 / h + 2.0 / k, 1.0 / k);
        b[i] = 3.0 * (chord / h + next / k);
    }
    let [k, last] = pieces[n - 2];
    match n.checked_sub(3).map(|i| pieces[i]) {
        // The third derivative does not jump at the last point but one.
        Some([h, chord]) => {
            let (before, after) = (1.0 / (h * h), 1.0 / (k * k));
            (a[(n - 1, n - 3)], a[(n - 1, n - 2)], a[(n - 1, n - 1)]) = (before, before - after, -after);
            b[n - 1] = 2.0 * (chord * before - last * after);
        }
        // One piece: no third derivative.
        None => (a[(1, 0)], a[(1, 1)], b[1]) = (1.0, 1.0, 2.0 * last),
    }
    a.lu().solve(&b).map_or_else(|| vec![0.0; n], |d| d.iter().copied().collect())
}
