//! Sines, point to point, piecewise.

use crate::common::{assert_consistent, at, choose, scattered};
use gyroflex::control::reference::{Piecewise, PointToPoint, Reference, Sine, Sines};
use std::f64::consts::TAU;

#[test]
fn every_derivative_is_the_slope_of_the_one_before() {
    let times: Vec<f64> = (0..20).map(|i| 0.31 + 1.2 * scattered(i)).collect();
    let sine = |amplitude, frequency, phase| Sine { amplitude, frequency, phase };
    let terms = [sine(0.5, 0.7, 0.2), sine(-0.2, 1.9, 1.0)];
    assert_consistent("sines", &Sines { offset: 0.1, terms: &terms }, &times, 10, 3e-3);
    for m in 1..=15 {
        let polynomial = PointToPoint::new(-0.4, 0.9, 0.2, 1.4, m).unwrap();
        assert_consistent(&format!("order {m}"), &polynomial, &times, 2 * m + 1, 2e-3);
    }
}

#[test]
fn four_derivatives_of_a_sine_are_its_frequency_to_the_fourth() {
    let reference = Sine { amplitude: 0.7, frequency: 1.3, phase: 0.4 };
    let all = at(&reference, 0.77, 17);
    for k in 4..17 {
        assert!((all[k] / all[k - 4] / (TAU * 1.3).powi(4) - 1.0).abs() < 1e-12);
    }
}

/// `σ⁽ᵏ⁾(a/4)/k!` of the polynomial of order `m`, in whole numbers: its integrand `sᵐ (1−s)ᵐ` multiplied out and integrated.
fn exact(m: u32, k: u32, a: i128) -> f64 {
    let n = 2 * m + 1;
    // c C(m, i) / (m+1+i) is whole: it is C(n, m+1+i) C(m+i, i).
    let term = |i: u32| {
        let j = m + 1 + i;
        let sign = if i.is_multiple_of(2) { 1 } else { -1 };
        if j < k { 0 } else { sign * choose(n, j) * choose(m + i, i) * choose(j, k) * a.pow(j - k) * 4i128.pow(n - j) }
    };
    (0..=m).map(term).sum::<i128>() as f64 / 4f64.powi((n - k) as i32)
}

#[test]
fn point_to_point_is_its_polynomial_in_whole_numbers() {
    for m in 1..=12 {
        let polynomial = PointToPoint::new(0.0, 1.0, 0.0, 1.0, m as usize).unwrap();
        for a in 1..4 {
            let all = at(&polynomial, a as f64 / 4.0, 2 * m as usize + 4);
            let mut factorial = 1.0;
            for k in 0..=2 * m + 1 {
                factorial *= f64::from(k.max(1));
                let (own, exact) = (all[k as usize], exact(m, k, a) * factorial);
                // Zeros of derivatives are judged against their values at the ends of the way.
                let size = (1..4).map(|a| self::exact(m, k, a).abs() * factorial).fold(1.0, f64::max);
                assert!((own - exact).abs() <= 2e-13 * size, "order {m}, derivative {k} at {a}/4: {own}, not {exact}");
            }
            assert_eq!(all[2 * m as usize + 2..], [0.0, 0.0]);
        }
    }
}

#[test]
fn point_to_point_rests_at_both_ends_up_to_its_order() {
    for m in 1..=15usize {
        let (start, duration, h) = (0.5, 2.0f64, 1e-9);
        let polynomial = PointToPoint::new(1.0, -2.0, start, duration, m).unwrap();
        assert_eq!(polynomial.smoothness(), Some(m + 1));
        // The first derivative that jumps: (2m+1)!/m! way / durationᵐ⁺¹, from the velocity's factor at an end.
        let jump = (m + 1..=2 * m + 1).map(|i| i as f64).product::<f64>() * -3.0 / duration.powi(m as i32 + 1);
        for (t, rest) in [(start, 1.0f64), (start + duration, -2.0)] {
            let inside = if t == start { t + h } else { t - h };
            let all: Vec<f64> = at(&polynomial, inside, m + 2);
            assert!((all[0] - rest).abs() < 1e-12);
            for k in 1..=m {
                assert!(all[k].abs() <= 1.1 * jump.abs() * h, "order {m}, derivative {k}: {}", all[k]);
            }
            let sign = if t == start || m % 2 == 0 { 1.0 } else { -1.0 };
            assert!((all[m + 1] / (sign * jump) - 1.0).abs() < 1e-5, "order {m}: {} is not {jump}", all[m + 1]);
            for outside in [t, if t == start { t - 1.0 } else { t + 1.0 }] {
                assert_eq!(at(&polynomial, outside, 2), [rest, 0.0]);
            }
            // Of a derivative that jumps the one after.
            let after = if t == start { jump } else { 0.0 };
            assert!((at(&polynomial, t, m + 2)[m + 1] - after).abs() < 1e-12 * jump.abs());
        }
    }
}

#[test]
fn point_to_point_never_turns_back() {
    for m in 1..=15 {
        let polynomial = PointToPoint::new(0.0, 1.0, 0.0, 1.0, m).unwrap();
        let mut before = 0.0;
        for i in 0..=1000 {
            let now = at(&polynomial, i as f64 / 1000.0, 2);
            assert!(now[0] >= before && now[1] >= 0.0, "order {m} at {i}");
            before = now[0];
        }
    }
}

#[test]
fn motions_that_make_no_sense_are_refused() {
    for (duration, order) in [(0.0, 2), (-1.0, 2), (f64::NAN, 2), (f64::INFINITY, 2), (1.0, 0), (1.0, 16)] {
        assert!(PointToPoint::new(0.0, 1.0, 0.0, duration, order).is_none());
    }
    assert!(PointToPoint::new(f64::NAN, 1.0, 0.0, 1.0, 2).is_none());
    assert!(Piecewise::new(&[0.0, 0.0], &[1.0], None).is_none());
    assert!(Piecewise::new(&[0.0, 1.0, 2.0], &[1.0, 2.0, 3.0], None).is_none());
    assert!(Piecewise::new(&[0.0], &[1.0], None).is_none());
}

#[test]
fn pieces_of_one_polynomial_are_that_polynomial() {
    // p = t⁵ − 2 t³ + t, and its Taylor coefficients about any knot by the derivatives of powers.
    let c = [0.0, 1.0, 0.0, -2.0, 0.0, 1.0];
    let falling = |j: usize, k: usize| (j - k + 1..=j).map(|i| i as f64).product::<f64>();
    let derivative = |k: usize, t: f64| (k..6).map(|j| c[j] * falling(j, k) * t.powi((j - k) as i32)).sum::<f64>();
    let knots = [-0.5, 0.1, 0.4, 1.3];
    let taylor: Vec<f64> =
        knots[..3].iter().flat_map(|&t| (0..6).map(move |k| derivative(k, t) / falling(k, k))).collect();
    let pieces = Piecewise::new(&knots, &taylor, Some(5)).unwrap();
    for i in 0..50 {
        let t = -0.5 + 1.8 * scattered(i);
        for (k, own) in at(&pieces, t, 8).into_iter().enumerate() {
            assert!((own - derivative(k, t)).abs() < 1e-12, "derivative {k} at {t}");
        }
    }
    for (t, end) in [(-0.6, -0.5), (-9.0, -0.5), (1.31, 1.3), (5.0, 1.3)] {
        let all = at(&pieces, t, 7);
        assert!((all[0] - derivative(0, end)).abs() < 1e-12 && all[1..].iter().all(|x| *x == 0.0), "{t}");
    }
}
