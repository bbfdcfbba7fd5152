//! Sine and cosine against the platform's, and the identities they obey.

use gyroflex::scalar::ANGLES;
use gyroflex::{Lanes, Scalar};

/// Angles of all sizes up to `largest`, of both signs.
fn angles(largest: f64) -> impl Iterator<Item = f64> {
    let steps = 40_000;
    (0..steps).flat_map(move |i| {
        let fraction = (i as f64 + 0.5) / steps as f64;
        [largest * fraction, -largest * fraction, largest.powf(fraction), -1e-8 * largest.powf(fraction)]
    })
}

#[test]
fn double_precision_is_exact_to_a_unit_in_the_last_place_of_one() {
    for x in angles(1e6).chain(angles(1e15)).chain([0.0, f64::MAX, f64::MIN_POSITIVE]) {
        let (s, c) = Scalar::sin_cos(x);
        let error = (s - x.sin()).abs().max((c - x.cos()).abs());
        assert!(error <= f64::EPSILON, "sin_cos({x:e}) is off by {error:e}");
    }
}

#[test]
fn single_precision_is_exact_to_a_unit_in_the_last_place_of_one() {
    for x in angles(1e4).chain(angles(1e8)).map(|x| x as f32).chain([0.0, f32::MAX, f32::MIN_POSITIVE]) {
        let (s, c) = Scalar::sin_cos(x);
        let (want_s, want_c) = f64::from(x).sin_cos();
        let error = (f64::from(s) - want_s).abs().max((f64::from(c) - want_c).abs());
        assert!(error <= f64::from(f32::EPSILON), "sin_cos({x:e}) is off by {error:e}");
    }
}

#[test]
fn zero_is_exact_and_what_is_no_angle_gives_no_number() {
    assert_eq!(Scalar::sin_cos(0.0_f64), (0.0, 1.0));
    assert_eq!(Scalar::sin_cos(0.0_f32), (0.0, 1.0));
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (s, c) = Scalar::sin_cos(x);
        assert!(s.is_nan() && c.is_nan(), "sin_cos({x}) = ({s}, {c})");
    }
}

#[test]
fn angles_side_by_side_equal_angles_alone() {
    // A far angle among near ones changes none of them.
    let x = [0.1, -3.0, 1e3, 2e6, -7.5e5, 1e300, 6.0, -1e-9];
    let alone = x.map(Scalar::sin_cos);
    for (group, alone) in x.chunks(ANGLES).zip(alone.chunks(ANGLES)) {
        let mut each = Vec::new();
        <f64 as Scalar>::sin_cos_each(|i| group[i], |i, s, c| each.push((i, (s, c))));
        assert!(each.into_iter().eq(alone.iter().copied().enumerate()));
    }
    let (s, c) = Lanes(x).sin_cos();
    assert_eq!((s.0, c.0), (alone.map(|p| p.0), alone.map(|p| p.1)));
}
