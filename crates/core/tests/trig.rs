//! Sine and cosine against the platform's.

use gyroflex::Scalar;

#[test]
fn sine_and_cosine_equal_the_platforms() {
    let mut worst = 0.0f64;
    for i in -200_000..200_000 {
        let x = i as f64 * 0.01 + 1e-3 * (i as f64 * 0.7).sin();
        let (s, c) = Scalar::sin_cos(x);
        worst = worst.max((s - x.sin()).abs()).max((c - x.cos()).abs());
    }
    assert!(worst <= f64::EPSILON, "{worst:e}");
}
