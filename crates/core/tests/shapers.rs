//! Laws of input shapers.

use gyroflex::control::reference::{PointToPoint, Reference};
use gyroflex::control::{Mode, OnlineShaper, Real, Shaped, Shaper, ShaperKind, memory_len};
use std::f64::consts::{PI, TAU};

const KINDS: [ShaperKind<f64>; 3] = [ShaperKind::Zv, ShaperKind::Zvd, ShaperKind::Ei { tolerance: 0.05 }];

fn mode(frequency: f64, damping_ratio: f64) -> Mode<f64> {
    Mode { frequency, damping_ratio }
}

/// `x'' + 2ζω x' + ω² x = ω² u(t)` by RK4 over one smooth stretch of `u`.
fn oscillate(x: &mut [f64; 2], mode: Mode<f64>, from: f64, to: f64, u: impl Fn(f64) -> f64) {
    let (omega, zeta) = (TAU * mode.frequency, mode.damping_ratio);
    let steps = ((to - from) * mode.frequency * 400.0).ceil().max(1.0);
    let h = (to - from) / steps;
    let rate = |t: f64, x: [f64; 2]| [x[1], omega * (omega * (u(t) - x[0]) - 2.0 * zeta * x[1])];
    let plus = |x: [f64; 2], h: f64, d: [f64; 2]| [x[0] + h * d[0], x[1] + h * d[1]];
    for i in 0..steps as usize {
        let t = from + i as f64 * h;
        let a = rate(t, *x);
        let b = rate(t + h / 2.0, plus(*x, h / 2.0, a));
        let c = rate(t + h / 2.0, plus(*x, h / 2.0, b));
        let d = rate(t + h, plus(*x, h, c));
        for k in 0..2 {
            x[k] += h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]);
        }
    }
}

/// Amplitude of the vibration about `rest`.
fn amplitude(x: [f64; 2], mode: Mode<f64>, rest: f64) -> f64 {
    let (omega, zeta) = (TAU * mode.frequency, mode.damping_ratio);
    let (e, swing) = (x[0] - rest, omega * (1.0 - zeta * zeta).sqrt());
    e.hypot((x[1] + zeta * omega * e) / swing)
}

/// What a step through the shaper leaves of a mode, relative to what a step alone starts with: integrated.
fn left<const N: usize>(shaper: &Shaper<f64, N>, mode: Mode<f64>) -> f64 {
    let mut impulses = shaper.impulses().to_vec();
    impulses.sort_by(|a, b| a.delay.total_cmp(&b.delay));
    let (mut x, mut t, mut u) = ([0.0; 2], 0.0, 0.0);
    for impulse in impulses {
        oscillate(&mut x, mode, t, impulse.delay, |_| u);
        (t, u) = (impulse.delay, u + impulse.amplitude);
    }
    amplitude(x, mode, 1.0) / amplitude([0.0; 2], mode, 1.0)
}

#[test]
fn shares_are_positive_and_sum_to_one() {
    for kind in KINDS {
        for zeta in [0.0, 0.02, 0.3, 0.8] {
            let shaper = Shaper::<f64, 9>::new(kind, mode(3.0, zeta)).unwrap().and(kind, mode(7.0, zeta)).unwrap();
            assert!((shaper.impulses().iter().map(|i| i.amplitude).sum::<f64>() - 1.0).abs() < 1e-14);
            assert!(shaper.impulses().iter().all(|i| i.amplitude > 0.0 && i.delay <= shaper.duration()));
            assert_eq!(shaper.impulses()[0].delay, 0.0);
        }
    }
}

#[test]
fn what_is_left_of_any_mode_is_what_integration_finds() {
    for kind in KINDS {
        let shaper = Shaper::<f64, 3>::new(kind, mode(3.0, 0.05)).unwrap();
        for (f, zeta) in [(3.0, 0.05), (2.1, 0.05), (3.9, 0.0), (8.0, 0.2), (0.5, 0.6)] {
            let (own, integrated) = (shaper.residual(mode(f, zeta)), left(&shaper, mode(f, zeta)));
            assert!((own - integrated).abs() < 1e-8, "{kind:?} at {f} Hz: {own} is not {integrated}");
        }
    }
}

#[test]
fn zv_and_zvd_leave_nothing_of_their_mode_and_zvd_nothing_nearby_to_first_order() {
    for zeta in [0.0, 0.03, 0.2, 0.5] {
        let design = mode(4.0, zeta);
        let off = |by: f64| mode(4.0 * (1.0 + by), zeta);
        for (kind, order) in [(ShaperKind::Zv, 2.0), (ShaperKind::Zvd, 4.0)] {
            let shaper = Shaper::<f64, 3>::new(kind, design).unwrap();
            assert!(shaper.residual(design) < 1e-15 && left(&shaper, design) < 1e-8, "{kind:?}, {zeta}");
            // Twice as far away twice or four times as much.
            let ratio = left(&shaper, off(0.04)) / left(&shaper, off(0.02));
            assert!((ratio / order - 1.0).abs() < 0.1, "{kind:?}, {zeta}: {ratio}");
        }
    }
}

/// Width of the band around 1 Hz in which a shaper for 1 Hz leaves less than 5 %.
fn band(kind: ShaperKind<f64>, zeta: f64) -> f64 {
    let shaper = Shaper::<f64, 3>::new(kind, mode(1.0, zeta)).unwrap();
    let edge = |sign: f64| {
        (1..10_000).map(|i| 1e-4 * i as f64).find(|by| shaper.residual(mode(1.0 + sign * by, zeta)) > 0.0501)
    };
    edge(1.0).unwrap() + edge(-1.0).unwrap()
}

#[test]
fn bands_of_five_percent_are_as_wide_as_known() {
    // Undamped |cos(πr/2)|, its square, and |(1+V)/2 cos(πr) + (1−V)/2| below V: 0.064, 0.287 and 0.399 (Singhose 2009).
    let v = 0.05f64;
    let expected = [4.0 / PI * v.asin(), 4.0 / PI * v.sqrt().asin(), 2.0 / PI * ((1.0 - 3.0 * v) / (1.0 + v)).acos()];
    for (kind, expected) in KINDS.into_iter().zip(expected) {
        assert!((band(kind, 0.0) - expected).abs() < 1e-3, "{kind:?}: {}", band(kind, 0.0));
    }
}

#[test]
fn extra_insensitive_leaves_its_tolerance_at_its_mode_and_no_more_over_its_band() {
    for tolerance in [0.01, 0.05, 0.1] {
        for zeta in [0.0, 0.01, 0.05, 0.1] {
            let kind = ShaperKind::Ei { tolerance };
            let shaper = Shaper::<f64, 3>::new(kind, mode(2.0, zeta)).unwrap();
            assert!((left(&shaper, mode(2.0, zeta)) - tolerance).abs() < 1e-8);
            // The undamped half-width.
            let half = 1.0 / PI * ((1.0 - 3.0 * tolerance) / (1.0 + tolerance)).acos();
            for i in -50..=50 {
                let near = mode(2.0 * (1.0 + half * i as f64 / 50.0), zeta);
                let most = tolerance * (1.0 + 0.2 * zeta * zeta) + 1e-8;
                assert!(left(&shaper, near) <= most, "{tolerance}, {zeta}, {i}: {}", left(&shaper, near));
            }
        }
        // Wider than ZVD.
        assert!(band(ShaperKind::Ei { tolerance: 0.05 }, 0.05) > 1.3 * band(ShaperKind::Zvd, 0.05));
    }
}

#[test]
fn a_shaper_of_two_modes_kills_both() {
    let (slow, fast) = (mode(2.3, 0.02), mode(6.1, 0.05));
    let shaper = Shaper::<f64, 6>::new(ShaperKind::Zv, slow).unwrap().and(ShaperKind::Zvd, fast).unwrap();
    assert_eq!(shaper.impulses().len(), 6);
    assert!(left(&shaper, slow) < 1e-8 && left(&shaper, fast) < 1e-8);
    assert!(left(&Shaper::<f64, 6>::new(ShaperKind::Zv, slow).unwrap(), fast) > 0.01);
}

#[test]
fn a_shaped_motion_is_the_sum_of_its_delayed_shares_and_leaves_no_vibration() {
    let design = mode(1.5, 0.0);
    let shaper = Shaper::<f64, 2>::new(ShaperKind::Zv, design).unwrap();
    let motion = PointToPoint::new(0.2, 1.2, 0.0, 0.4, 4).unwrap();
    let shaped = Shaped { reference: &motion, shaper: &shaper };
    assert_eq!(shaped.smoothness(), motion.smoothness());
    let value = |r: &dyn Reference<f64>, t: f64, k: usize| {
        let mut out = [f64::NAN; 6];
        r.derivatives(t, &mut out);
        out[k]
    };
    for k in 0..6 {
        let sum: f64 = shaper.impulses().iter().map(|i| i.amplitude * value(&motion, 0.45 - i.delay, k)).sum();
        assert!((value(&shaped, 0.45, k) - sum).abs() <= 1e-12 * sum.abs().max(1.0));
    }
    let vibration = |r: &dyn Reference<f64>| {
        let mut x = [0.2, 0.0];
        oscillate(&mut x, design, 0.0, 1.0, |t| value(r, t, 0));
        amplitude(x, design, 1.2)
    };
    assert!(vibration(&motion) > 0.1 && vibration(&shaped) < 1e-7, "{}", vibration(&shaped));
}

#[test]
fn on_line_it_is_the_same_where_delays_are_whole_samples() {
    // Half a period of 2 Hz is 0.25 s.
    let shaper = Shaper::<f64, 3>::new(ShaperKind::Zvd, mode(2.0, 0.0)).unwrap();
    let motion = PointToPoint::new(-0.5, 1.0, 0.1, 0.6, 3).unwrap();
    let shaped = Shaped { reference: &motion, shaper: &shaper };
    let step = 1.0 / 64.0;
    let mut memory = vec![0.0; memory_len(&shaper, step)];
    let mut online = OnlineShaper::new(&shaper, step, -0.5, &mut memory).unwrap();
    for i in 0..100 {
        let (t, mut input, mut expected) = (i as f64 * step, [0.0], [0.0]);
        motion.derivatives(t, &mut input);
        shaped.derivatives(t, &mut expected);
        assert!((online.shape(input[0]) - expected[0]).abs() < 1e-14, "{i}");
    }
}

#[test]
fn between_samples_delays_are_kept_and_little_vibration_is_left() {
    let design = mode(1.7, 0.03);
    let shaper = Shaper::<f64, 3>::new(ShaperKind::Zvd, design).unwrap();
    let mean: f64 = shaper.impulses().iter().map(|i| i.amplitude * i.delay).sum();
    let residual = |step: f64| {
        let mut memory = vec![f64::NAN; memory_len(&shaper, step) + 3];
        let mut online = OnlineShaper::new(&shaper, step, 0.0, &mut memory).unwrap();
        // A ramp comes out late by the mean delay.
        let n = (2.0 / step) as usize;
        let last = (0..=n).fold(0.0, |_, i| online.shape(i as f64 * step));
        assert!((last - (n as f64 * step - mean)).abs() < 1e-12);
        let mut online = OnlineShaper::new(&shaper, step, 0.0, &mut memory).unwrap();
        let mut x = [0.0; 2];
        for i in 0..(1.0 / step) as usize {
            let u = online.shape(1.0);
            oscillate(&mut x, design, i as f64 * step, (i + 1) as f64 * step, |_| u);
        }
        amplitude(x, design, 1.0)
    };
    for step in [0.01, 0.002, 0.0005] {
        let most = (TAU * 1.7 * step).powi(2);
        assert!(residual(step) < most, "{step}: {} above {most}", residual(step));
    }
}

#[test]
fn shapers_that_make_no_sense_are_refused() {
    for (frequency, zeta) in [(0.0, 0.1), (-1.0, 0.1), (f64::NAN, 0.1), (1.0, 1.0), (1.0, -0.1), (1.0, f64::NAN)] {
        assert!(Shaper::<f64, 3>::new(ShaperKind::Zv, mode(frequency, zeta)).is_none());
    }
    for tolerance in [0.0, 1.0, f64::NAN] {
        assert!(Shaper::<f64, 3>::new(ShaperKind::Ei { tolerance }, mode(1.0, 0.0)).is_none());
    }
    assert!(Shaper::<f64, 2>::new(ShaperKind::Zvd, mode(1.0, 0.0)).is_none());
    let shaper = Shaper::<f64, 3>::new(ShaperKind::Zv, mode(1.0, 0.0)).unwrap();
    assert!(shaper.and(ShaperKind::Zv, mode(2.0, 0.0)).is_none(), "four do not fit");
    let mut short = vec![0.0; memory_len(&shaper, 0.01) - 1];
    assert!(OnlineShaper::new(&shaper, 0.01, 0.0, &mut short).is_none());
    assert_eq!(Shaper::<f64, 3>::none().impulses().len(), 1);
}

#[test]
fn single_precision_keeps_its_digits() {
    fn residual<T: Real>(kind: ShaperKind<T>) -> T {
        let f = T::from_f64;
        let design = Mode { frequency: f(3.0), damping_ratio: f(0.05) };
        Shaper::<T, 3>::new(kind, design).unwrap().residual(Mode { frequency: f(3.3), ..design })
    }
    let pairs = [
        (residual(ShaperKind::Zv), residual(ShaperKind::<f32>::Zv)),
        (residual(ShaperKind::Zvd), residual(ShaperKind::<f32>::Zvd)),
        (residual(ShaperKind::Ei { tolerance: 0.05 }), residual(ShaperKind::<f32>::Ei { tolerance: 0.05 })),
    ];
    for (double, single) in pairs {
        let double: f64 = double;
        assert!((double - f64::from(single)).abs() < 1e-6, "{double} {single}");
    }
}
