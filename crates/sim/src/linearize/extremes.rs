//! Peaks and dips of a curve that is known where it is asked for.

/// A peak or a dip of a response's magnitude.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Extreme {
    /// Frequency [Hz].
    pub frequency: f64,
    /// Magnitude there [rad/(N m), or m/N]; `None` where an undamped resonance has none.
    pub magnitude: Option<f64>,
}

/// Peaks and dips between the points of a grid, refined, without pairs that lie within a hundredth of each other's magnitude.
pub(super) fn extremes(grid: &[f64], size: impl Fn(f64) -> f64) -> (Vec<Extreme>, Vec<Extreme>) {
    let log = |f: f64| size(f).ln();
    let values: Vec<f64> = grid.iter().map(|f| log(*f)).collect();
    // Peaks (true) and dips in turn, as (is it a peak, frequency, log of magnitude).
    let mut found: Vec<(bool, f64, f64)> = Vec::new();
    for i in 1..grid.len().saturating_sub(1) {
        let [a, b, c] = [values[i - 1], values[i], values[i + 1]];
        let peak = b > a && b >= c;
        if !(peak || b < a && b <= c) {
            continue;
        }
        let sign = if peak { -1.0 } else { 1.0 };
        let (f, value) = golden(grid[i - 1], grid[i], grid[i + 1], |f| sign * log(f));
        found.push((peak, f, sign * value));
    }
    const SLIGHT: f64 = 0.01;
    loop {
        let rise = |i: usize| (found[i].2 - found[i + 1].2).abs();
        let least = (0..found.len().saturating_sub(1)).min_by(|a, b| rise(*a).total_cmp(&rise(*b)));
        match least.filter(|i| rise(*i) < SLIGHT) {
            Some(i) => drop(found.drain(i..i + 2)),
            None => break,
        }
    }
    let pick = |peaks: bool| {
        let chosen = found.iter().filter(|e| e.0 == peaks);
        chosen
            .map(|e| Extreme { frequency: e.1, magnitude: Some(e.2.exp()).filter(|m| m.is_finite()) })
            .collect::<Vec<_>>()
    };
    (pick(true), pick(false))
}

/// The lowest point between `low` and `high` by golden sections, `middle` being lower than both, and the value there.
fn golden(mut low: f64, mut middle: f64, mut high: f64, f: impl Fn(f64) -> f64) -> (f64, f64) {
    const SECTION: f64 = 0.381_966_011_250_105_1;
    let mut best = f(middle);
    for _ in 0..100 {
        if high - low <= 1e-12 * middle || best == f64::NEG_INFINITY {
            break;
        }
        let right = high - middle > middle - low;
        let next = if right { middle + SECTION * (high - middle) } else { middle - SECTION * (middle - low) };
        let value = f(next);
        match (value < best, right) {
            (true, true) => (low, middle, best) = (middle, next, value),
            (true, false) => (high, middle, best) = (middle, next, value),
            (false, true) => high = next,
            (false, false) => low = next,
        }
    }
    (middle, best)
}
