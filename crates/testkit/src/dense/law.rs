//! The scalar laws of friction, springs and transmission errors, written from their definitions.

use gyroflex::model::{Friction, SpringSpec, TransmissionError};

/// `viscous v + (coulomb + stribeck exp(−(v/v_s)²)) tanh(v/v_0)`.
pub(super) fn friction(f: &Friction<f64>, v: f64) -> f64 {
    let fading = (-(v / f.stribeck_velocity).powi(2)).exp();
    f.viscous * v + (f.coulomb + f.stribeck * fading) * (v / f.smoothing_velocity).tanh()
}

/// `e(θ)` and `de/dθ` of `e = A sin(c N θ + φ)`.
pub(super) fn transmission_error(e: &TransmissionError<f64>, gear: f64, theta: f64) -> (f64, f64) {
    let cycles = e.cycles_per_rotor_turn * gear;
    let angle = cycles * theta + e.phase;
    (e.amplitude * angle.sin(), e.amplitude * cycles * angle.cos())
}

/// `k(δ)`.
pub(super) fn spring_torque(spring: &SpringSpec, tables: &[[f64; 2]], delta: f64) -> f64 {
    match *spring {
        SpringSpec::Polynomial { stiffness, cubic } => stiffness * delta + cubic * delta.powi(3),
        SpringSpec::Table { first, len } => Curve::new(&tables[first..first + len]).torque(delta),
    }
}

/// `∫₀^δ k`.
pub(super) fn spring_energy(spring: &SpringSpec, tables: &[[f64; 2]], delta: f64) -> f64 {
    match *spring {
        SpringSpec::Polynomial { stiffness, cubic } => 0.5 * stiffness * delta.powi(2) + 0.25 * cubic * delta.powi(4),
        SpringSpec::Table { first, len } => Curve::new(&tables[first..first + len]).energy(delta),
    }
}

/// A monotone cubic Hermite curve: slope at an inner point the harmonic mean of its two secants, at an end the secant;
/// straight beyond the ends.
struct Curve {
    x: Vec<f64>,
    y: Vec<f64>,
    slope: Vec<f64>,
}

impl Curve {
    fn new(table: &[[f64; 2]]) -> Self {
        let mut points = table.to_vec();
        if table[0] == [0.0, 0.0] {
            points.extend(table[1..].iter().map(|[x, y]| [-x, -y]));
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        }
        let secants: Vec<f64> = points.windows(2).map(|w| (w[1][1] - w[0][1]) / (w[1][0] - w[0][0])).collect();
        let mut slope = vec![secants[0]];
        slope.extend(secants.windows(2).map(|s| 2.0 / (1.0 / s[0] + 1.0 / s[1])));
        slope.push(secants[secants.len() - 1]);
        let (x, y) = points.iter().map(|p| (p[0], p[1])).unzip();
        Self { x, y, slope }
    }

    fn torque(&self, d: f64) -> f64 {
        let last = self.x.len() - 1;
        if d <= self.x[0] {
            return self.y[0] + self.slope[0] * (d - self.x[0]);
        }
        if d >= self.x[last] {
            return self.y[last] + self.slope[last] * (d - self.x[last]);
        }
        let i = self.x.partition_point(|x| *x <= d) - 1;
        let h = self.x[i + 1] - self.x[i];
        let t = (d - self.x[i]) / h;
        // The four Hermite basis functions.
        let value = [(1.0 + 2.0 * t) * (1.0 - t).powi(2), t.powi(2) * (3.0 - 2.0 * t)];
        let tangent = [t * (1.0 - t).powi(2), t.powi(2) * (t - 1.0)];
        value[0] * self.y[i]
            + value[1] * self.y[i + 1]
            + h * (tangent[0] * self.slope[i] + tangent[1] * self.slope[i + 1])
    }

    /// Two-point Gauss quadrature, exact for the cubic pieces between the breaks.
    fn energy(&self, d: f64) -> f64 {
        let (lo, hi) = (d.min(0.0), d.max(0.0));
        let mut breaks = vec![lo];
        breaks.extend(self.x.iter().copied().filter(|x| *x > lo && *x < hi));
        breaks.push(hi);
        let piece = |w: &[f64]| {
            let (mid, half) = (0.5 * (w[0] + w[1]), 0.5 * (w[1] - w[0]));
            let node = half / 3.0_f64.sqrt();
            half * (self.torque(mid - node) + self.torque(mid + node))
        };
        let area: f64 = breaks.windows(2).map(piece).sum();
        if d < 0.0 { -area } else { area }
    }
}
