//! A cubic spline through points in time.

use gyroflex::control::reference::Reference;

/// A twice continuously differentiable function through points, cubic between them; constant outside.
///
/// The slopes at its two ends are those of the cubic through the four points next to them.
#[derive(Clone, Debug)]
pub struct Spline {
    times: Vec<f64>,
    values: Vec<f64>,
    /// Second derivative at each point.
    curvatures: Vec<f64>,
}

impl Spline {
    /// The spline through `values` at strictly increasing `times`; `None` if there are fewer than two points, times do not
    /// increase, or a number is not finite.
    pub fn new(times: Vec<f64>, values: Vec<f64>) -> Option<Self> {
        let n = times.len();
        let finite = times.iter().chain(&values).all(|x| x.is_finite());
        if n < 2 || values.len() != n || !finite || times.windows(2).any(|w| w[1] <= w[0]) {
            return None;
        }
        let near = n.min(4);
        let first = end_slope(&times[..near], &values[..near], times[0]);
        let last = end_slope(&times[n - near..], &values[n - near..], times[n - 1]);
        let curvatures = curvatures(&times, &values, first, last);
        Some(Self { times, values, curvatures })
    }

    /// First and last time [s].
    pub fn span(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }
}

impl Reference<f64> for Spline {
    fn add_derivatives(&self, t: f64, weight: f64, out: &mut [f64]) {
        let n = self.times.len();
        let (first, last) = self.span();
        let outside = [self.values[if t < first { 0 } else { n - 1 }], 0.0, 0.0, 0.0];
        let all = if t < first || t > last { outside } else { self.within(t) };
        out.iter_mut().zip(all).for_each(|(slot, x)| *slot += weight * x);
    }

    /// Within its span; where it holds before and after, the velocity jumps.
    fn smoothness(&self) -> Option<usize> {
        Some(3)
    }
}

impl Spline {
    /// Position and three derivatives at a time of its span.
    fn within(&self, t: f64) -> [f64; 4] {
        let i = self.times.partition_point(|&x| x <= t).clamp(1, self.times.len() - 1) - 1;
        let h = self.times[i + 1] - self.times[i];
        let (b, a) = ((t - self.times[i]) / h, (self.times[i + 1] - t) / h);
        let (y0, y1, m0, m1) = (self.values[i], self.values[i + 1], self.curvatures[i], self.curvatures[i + 1]);
        [
            a * y0 + b * y1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0,
            (y1 - y0) / h + ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * h / 6.0,
            a * m0 + b * m1,
            (m1 - m0) / h,
        ]
    }
}

/// Slope at `at` of the polynomial through all points given (Newton's divided differences, differentiated).
fn end_slope(times: &[f64], values: &[f64], at: f64) -> f64 {
    let n = times.len();
    let mut c = values.to_vec();
    for level in 1..n {
        for i in (level..n).rev() {
            c[i] = (c[i] - c[i - 1]) / (times[i] - times[i - level]);
        }
    }
    let (mut value, mut slope) = (c[n - 1], 0.0);
    for i in (0..n - 1).rev() {
        slope = slope * (at - times[i]) + value;
        value = value * (at - times[i]) + c[i];
    }
    slope
}

/// Second derivatives of the spline with given end slopes: one tridiagonal system.
fn curvatures(times: &[f64], values: &[f64], first: f64, last: f64) -> Vec<f64> {
    let n = times.len();
    let step = |i: usize| times[i + 1] - times[i];
    let secant = |i: usize| (values[i + 1] - values[i]) / step(i);
    let (mut diagonal, mut m) = (vec![0.0; n], vec![0.0; n]);
    diagonal[0] = 2.0 * step(0);
    m[0] = 6.0 * (secant(0) - first);
    for i in 1..n {
        // Row i has step(i − 1) left of its diagonal, and the row above has it right of its own.
        let below = step(i - 1) / diagonal[i - 1];
        let (own, rhs) = if i + 1 < n {
            (2.0 * (step(i - 1) + step(i)), 6.0 * (secant(i) - secant(i - 1)))
        } else {
            (2.0 * step(i - 1), 6.0 * (last - secant(i - 1)))
        };
        diagonal[i] = own - below * step(i - 1);
        m[i] = rhs - below * m[i - 1];
    }
    m[n - 1] /= diagonal[n - 1];
    for i in (0..n - 1).rev() {
        m[i] = (m[i] - step(i) * m[i + 1]) / diagonal[i];
    }
    m
}
