//! Laws of motions in minimum time.

use crate::common::{assert_consistent, at, scattered};
use gyroflex::control::reference::{MinimumTime, Reference};

fn plan(way: f64, limits: &[f64]) -> MinimumTime<f64, 8> {
    MinimumTime::new(0.0, way, 0.0, limits).unwrap()
}

/// Bounds over four decades, of `n` derivatives; from 1 on, so that all sorts of them bind.
fn some_limits(case: usize, n: usize) -> Vec<f64> {
    (0..n).map(|k| 10f64.powf(k as f64 + 4.0 * scattered(7 * case + k) - 2.0)).collect()
}

#[test]
fn no_bound_is_exceeded_and_the_last_one_is_reached() {
    for case in 0..300 {
        let n = 1 + case % 8;
        let (limits, way) = (some_limits(case, n), 10f64.powf(3.0 * scattered(3 * case) - 2.0));
        let way = if case % 3 == 0 { -way } else { way };
        let plan = plan(way, &limits);
        let mut largest = vec![0f64; n];
        for i in 0..4000 {
            // Everywhere, and crowded at the start, whose pulses may be short.
            let part = if i % 2 == 0 { scattered(i) } else { 10f64.powf(-8.0 * scattered(i)) };
            let all = at(&plan, plan.duration() * part, n + 1);
            for k in 0..n {
                largest[k] = largest[k].max(all[k + 1].abs() / limits[k]);
            }
        }
        assert!(largest.iter().all(|x| *x < 1.0 + 1e-9), "case {case}: {largest:?} of {limits:?}");
        let first = at(&plan, 0.0, n + 1)[n];
        assert!((first / (limits[n - 1] * way.signum()) - 1.0).abs() < 1e-9, "case {case}: {first} of {limits:?}");
    }
}

#[test]
fn it_goes_from_rest_to_rest_without_a_jump_below_its_order() {
    for case in 0..100 {
        let n = 1 + case % 8;
        let limits = some_limits(case, n);
        let plan = MinimumTime::<f64, 8>::new(0.3, -1.1, 0.2, &limits).unwrap();
        assert_eq!(plan.smoothness(), Some(n));
        let duration = plan.duration();
        // Between neighbouring instants nothing below the last derivative moves by more than the next one's bound allows.
        let steps = 5000;
        let mut before = at(&plan, 0.2 - 1e-3 * duration, n);
        assert_eq!(before[0], 0.3);
        for i in -1..=steps + 1 {
            let h = duration / steps as f64;
            let now = at(&plan, 0.2 + i as f64 * h, n);
            for k in 0..n {
                let most = limits[k] * h + 1e-12 * now[k].abs().max(1.0);
                assert!((now[k] - before[k]).abs() <= most * (1.0 + 1e-9), "case {case}, {k} at {i}");
            }
            before = now;
        }
        assert_eq!(before[0], -1.1);
        assert!(before[1..].iter().all(|x| *x == 0.0));
    }
}

#[test]
fn every_derivative_is_the_slope_of_the_one_before() {
    // Way 1 with these bounds: averages over 1, 0.5, 0.2 and 0.1 s, whose edges lie at multiples of 0.1 s.
    let plan = plan(1.0, &[1.0, 2.0, 10.0, 100.0]);
    assert!((plan.duration() - 1.8).abs() < 1e-12);
    let times: Vec<f64> = (0..18).map(|i| 0.1 * i as f64 + 0.05).collect();
    assert_consistent("minimum time", &plan, &times, 4, 0.02);
}

#[test]
fn two_bounds_make_the_trapezoid_or_the_triangle() {
    for (way, v, a) in [(2.0, 1.0, 4.0), (0.1, 1.0, 4.0), (0.25, 1.0, 4.0), (7.0, 0.3, 0.5)] {
        let peak = f64::min(v, f64::sqrt(way * a));
        let expected = way / peak + peak / a;
        let plan = plan(way, &[v, a]);
        assert!((plan.duration() - expected).abs() < 1e-12);
        assert!((at(&plan, expected / 2.0, 2)[1] - peak).abs() < 1e-12);
    }
}

#[test]
fn three_bounds_take_as_long_as_the_double_s_of_the_textbook() {
    // Biagiotti, Melchiorri, Trajectory Planning for Automatic Machines and Robots, section 3.4, from rest to rest.
    for case in 0..500 {
        let (limits, way) = (some_limits(case, 3), 10f64.powf(3.0 * scattered(3 * case) - 2.0));
        let [v, a, j] = limits[..] else { unreachable!() };
        // To velocity v: with or without a plateau of acceleration.
        let rise = if v * j >= a * a { a / j + v / a } else { 2.0 * (v / j).sqrt() };
        let expected = if way >= v * rise {
            rise + way / v
        } else {
            // The velocity is not reached; the acceleration is, if its pulse is longer than both of its ramps.
            let rise = (a * a / j + (a.powi(4) / (j * j) + 4.0 * a * way).sqrt()) / (2.0 * a);
            if rise >= 2.0 * a / j { 2.0 * rise } else { 4.0 * (way / (2.0 * j)).cbrt() }
        };
        let duration = plan(way, &limits).duration();
        assert!((duration / expected - 1.0).abs() < 1e-9, "case {case}: {duration} s, not {expected} s");
    }
}

#[test]
fn where_only_the_last_bound_is_reached_it_is_as_near_to_the_minimum_as_documented() {
    // The fastest motion of a chain of n integrators switches at the extrema of a Chebyshev polynomial of the second kind, whose
    // integral of the modulus is the least: way / bound = (T/2)ⁿ 2^(2−n) / (n−1)!.
    let way = 0.7;
    for (n, most) in [(1, 1.0), (2, 1.0), (3, 1.0), (4, 1.075), (5, 1.22), (6, 1.43)] {
        let mut limits = vec![1e9; n];
        limits[n - 1] = 300.0;
        let factorial: f64 = (1..n).map(|i| i as f64).product();
        let fastest = 2.0 * (way / 300.0 * factorial * 2f64.powi(n as i32 - 2)).powf(1.0 / n as f64);
        let ratio = plan(way, &limits).duration() / fastest;
        assert!(ratio > 1.0 - 1e-9 && ratio < most + 1e-9, "{n} bounds: {ratio}");
    }
}

#[test]
fn looser_bounds_never_take_longer() {
    for case in 0..200 {
        let n = 1 + case % 6;
        let limits = some_limits(case, n);
        let before = plan(1.0, &limits).duration();
        for k in 0..n {
            let mut looser = limits.clone();
            looser[k] *= 1.1 + scattered(case);
            assert!(plan(1.0, &looser).duration() <= before * (1.0 + 1e-9), "case {case}, bound {k}");
        }
        assert!(plan(1.2, &limits).duration() > before);
    }
}

#[test]
fn it_is_a_rectangle_of_velocity_behind_moving_averages() {
    // Way 1: averages over 1, 0.5, 0.2 and 0.1 s. The rectangle through running means of samples, summed to positions.
    let (h, n) = (1e-4, 20_000);
    let mut velocity: Vec<f64> = (0..n).map(|i| if i < 10_000 { 1.0 } else { 0.0 }).collect();
    for width in [5000, 2000, 1000] {
        let mut sum = 0.0;
        let before = velocity.clone();
        for i in 0..n {
            sum += before[i] - if i >= width { before[i - width] } else { 0.0 };
            velocity[i] = sum / width as f64;
        }
    }
    let plan = plan(1.0, &[1.0, 2.0, 10.0, 100.0]);
    let mut position = 0.0;
    for i in 0..n {
        position += h * velocity[i];
        // A mean of samples is that of their whole intervals, half a sample ahead of the middle of the last; three times.
        let own = at(&plan, (i + 1) as f64 * h + 1.5 * h, 1)[0];
        assert!((own - position).abs() < 1e-6, "{i}: {own} is not {position}");
    }
}

#[test]
fn no_way_takes_no_time_and_bounds_that_make_no_sense_are_refused() {
    let still = MinimumTime::<f64, 4>::new(0.4, 0.4, 0.0, &[1.0, 2.0]).unwrap();
    assert_eq!(still.duration(), 0.0);
    assert_eq!(at(&still, 0.0, 4), [0.4, 0.0, 0.0, 0.0]);
    for limits in [&[][..], &[1.0, 0.0], &[1.0, -1.0], &[f64::NAN], &[1.0; 5]] {
        assert!(MinimumTime::<f64, 4>::new(0.0, 1.0, 0.0, limits).is_none());
    }
}
