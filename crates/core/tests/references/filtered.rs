//! Laws of the low-pass filter and of its steps in closed form.

use crate::common::{assert_consistent, at, choose, scattered};
use gyroflex::control::LowPass;
use gyroflex::control::reference::{FilteredStep, Reference, Step};
use std::f64::consts::TAU;

/// The corner of `n` lags from the gain that they must have at the cutoff: a bisection.
fn corner(cutoff: f64, n: i32) -> f64 {
    let (mut low, mut high) = (cutoff, 100.0 * cutoff);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let gain = (1.0 + (cutoff / middle).powi(2)).sqrt().powi(-n);
        if gain < 0.5f64.sqrt() { low = middle } else { high = middle }
    }
    TAU * low
}

#[test]
fn steps_through_the_filter_are_the_closed_form() {
    fn law<const N: usize>() {
        let (cutoff, h) = (3.0, 0.01);
        let steps = [Step { time: 0.05, to: 1.4 }, Step { time: 0.21, to: -0.3 }, Step { time: 0.33, to: 0.2 }];
        let closed = FilteredStep::new(0.5, &steps, N, cutoff).unwrap();
        let mut filter = LowPass::<f64, N>::new(cutoff, 0.5).unwrap();
        let omega = corner(cutoff, N as i32);
        for i in 0..80 {
            let t = i as f64 * h;
            let input = steps.iter().rev().find(|s| s.time <= t + 1e-9).map_or(0.5, |s| s.to);
            let mut own = [f64::NAN; 20];
            filter.derivatives(input, &mut own);
            // A hair later, so that the step is over.
            let expected = at(&closed, t + 1e-13, 20);
            for k in 0..20 {
                let size = 4.0 * (2.0 * omega).powi(k as i32);
                assert!(
                    (own[k] - expected[k]).abs() < 1e-11 * size,
                    "{N} lags, derivative {k} at {t}: {own:?} {expected:?}"
                );
            }
            filter.advance(input, h);
        }
        assert_eq!(closed.smoothness(), Some(filter.smoothness()));
    }
    law::<1>();
    law::<2>();
    law::<4>();
    law::<9>();
    law::<16>();
}

#[test]
fn every_derivative_is_the_slope_of_the_one_before() {
    let steps = [Step { time: 0.0, to: 1.0 }, Step { time: 0.1, to: 0.4 }];
    let times: Vec<f64> = (0..20).map(|i| 0.12 + 0.6 * scattered(i)).collect();
    for order in 1..=12 {
        let reference = FilteredStep::new(-0.2, &steps, order, 2.0).unwrap();
        assert_consistent(&format!("order {order}"), &reference, &times, order + 3, 4e-4);
    }
}

#[test]
fn derivatives_obey_the_filters_own_equation() {
    // (D + ω)ᴺ y = ωᴺ u.
    const N: usize = 6;
    let omega = corner(5.0, N as i32);
    let mut filter = LowPass::<f64, N>::new(5.0, 0.1).unwrap();
    for i in 0..200 {
        let input = scattered(i / 7);
        let mut y = [0.0; N + 1];
        filter.derivatives(input, &mut y);
        let sum: f64 = (0..=N).map(|k| choose(N as u32, k as u32) as f64 * omega.powi((N - k) as i32) * y[k]).sum();
        assert!((sum / omega.powi(N as i32) - input).abs() < 1e-10, "{i}");
        filter.advance(input, 0.004);
    }
}

#[test]
fn steps_of_any_length_make_the_same_motion() {
    let filter = || LowPass::<f64, 5>::new(4.0, 0.0).unwrap();
    let (mut whole, mut parts) = (filter(), filter());
    whole.advance(1.0, 0.1);
    for i in 0..10 {
        parts.advance(1.0, 0.1 * (i as f64 + 1.0) / 55.0);
    }
    let [mut a, mut b] = [[0.0; 6]; 2];
    whole.derivatives(1.0, &mut a);
    parts.derivatives(1.0, &mut b);
    for (k, (a, b)) in a.iter().zip(&b).enumerate() {
        assert!((a - b).abs() < 1e-13 * 100f64.powi(k as i32), "{k}: {a} {b}");
    }
}

#[test]
fn at_the_cutoff_the_gain_is_three_decibels_down() {
    fn law<const N: usize>() {
        let (cutoff, h) = (2.0, 1e-4);
        let mut filter = LowPass::<f64, N>::new(cutoff, 0.0).unwrap();
        let omega = TAU * cutoff;
        for i in 0..100_000 {
            // Half-way through the step, so that holding it delays nothing.
            filter.advance((omega * (i as f64 + 0.5) * h).sin(), h);
        }
        let mut y = [0.0; 2];
        filter.derivatives(0.0, &mut y);
        if N > 1 {
            let gain = y[0].hypot(y[1] / omega);
            assert!((gain - 0.5f64.sqrt()).abs() < 1e-6, "{N} lags: {gain}");
        }
    }
    law::<2>();
    law::<3>();
    law::<7>();
}

#[test]
fn a_filter_at_rest_stays_and_nonsense_is_refused() {
    let mut filter = LowPass::<f64, 4>::new(10.0, 0.7).unwrap();
    filter.advance(0.7, 0.01);
    let mut y = [1.0; 5];
    filter.derivatives(0.7, &mut y);
    assert_eq!(y, [0.7, 0.0, 0.0, 0.0, 0.0]);
    filter.advance(1.0, 0.01);
    filter.reset(0.2);
    filter.derivatives(0.2, &mut y);
    assert_eq!(y, [0.2, 0.0, 0.0, 0.0, 0.0]);
    assert!(LowPass::<f64, 0>::new(1.0, 0.0).is_none() && LowPass::<f64, 2>::new(0.0, 0.0).is_none());
    assert!(FilteredStep::new(0.0, &[], 0, 1.0).is_none() && FilteredStep::new(0.0, &[], 1, f64::NAN).is_none());
}
