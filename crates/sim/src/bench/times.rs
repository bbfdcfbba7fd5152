//! What many measured times say.

use serde::Serialize;
use std::time::Instant;

/// A summary of the times of many calls [µs].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Times {
    /// Half of the calls took no longer.
    pub median_us: f64,
    /// 999 of 1000 calls took no longer.
    pub p999_us: f64,
    /// No call took longer.
    pub max_us: f64,
}

impl Times {
    /// Sums up times [ns], each of which has in it the reading of the clock, `clock` [ns]. Sorts them; zero if there are none.
    pub fn of(samples: &mut [u64], clock: u64) -> Self {
        samples.sort_unstable();
        let at = |per_mille: usize| {
            let (last, rank) = (samples.len().saturating_sub(1), (samples.len() * per_mille).div_ceil(1000));
            let ns = samples.get(rank.saturating_sub(1).min(last)).copied().unwrap_or(0);
            ns.saturating_sub(clock) as f64 * 1e-3
        };
        Self { median_us: at(500), p999_us: at(999), max_us: at(1000) }
    }
}

/// What reading the clock twice in a row takes [ns]: the least of many, so that taking it off never makes a time too short.
pub fn clock_cost() -> u64 {
    let pair = |_| {
        let before = Instant::now();
        (Instant::now() - before).as_nanos()
    };
    (0..10_000).map(pair).min().and_then(|ns| u64::try_from(ns).ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `1, 2, …, n` in an order that is not sorted: steps of a number that has no factor in common with `n`.
    fn shuffled(n: u64) -> Vec<u64> {
        (0..n).map(|i| (i * 7_919) % n + 1).collect()
    }

    #[test]
    fn quantiles_are_those_of_the_sorted_times() {
        let times = Times::of(&mut shuffled(10_000), 0);
        assert_eq!(times, Times { median_us: 5.0, p999_us: 9.99, max_us: 10.0 });
    }

    #[test]
    fn one_slow_call_in_a_thousand_is_the_maximum_and_nothing_else() {
        let mut samples = vec![200; 999];
        samples.push(50_000);
        let times = Times::of(&mut samples, 0);
        assert_eq!(times, Times { median_us: 0.2, p999_us: 0.2, max_us: 50.0 });
        // Twice as many are more than the share the quantile leaves out.
        samples[0] = 40_000;
        assert_eq!(Times::of(&mut samples, 0).p999_us, 40.0);
    }

    #[test]
    fn few_calls_have_a_maximum_for_every_quantile_beyond_them() {
        assert_eq!(Times::of(&mut [300], 0), Times { median_us: 0.3, p999_us: 0.3, max_us: 0.3 });
        assert_eq!(Times::of(&mut [100, 300], 0), Times { median_us: 0.1, p999_us: 0.3, max_us: 0.3 });
        assert_eq!(Times::of(&mut [], 0), Times { median_us: 0.0, p999_us: 0.0, max_us: 0.0 });
    }

    #[test]
    fn the_clock_is_taken_off_and_never_more() {
        let times = Times::of(&mut [20, 120, 1_020], 20);
        assert_eq!(times, Times { median_us: 0.1, p999_us: 1.0, max_us: 1.0 });
        assert_eq!(Times::of(&mut [5, 5, 5], 20).max_us, 0.0);
    }
}
