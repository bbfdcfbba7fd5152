//! Truncated Taylor series against closed forms.

mod common;

use common::{Lowered, drive, elastic, link};
use gyroflex::dynamics::{Acceleration, External, Inverse, RneaScratch, State, rnea};
use gyroflex::model::Fidelity;
use gyroflex::{Jet, Scalar};

/// Coefficients below the length up to which products are written out, above it, and the two shortest.
macro_rules! for_lengths {
    ($check:ident) => {
        $check::<1>();
        $check::<2>();
        $check::<7>();
        $check::<14>();
    };
}

/// `want` gives derivatives; rounding is that of the coefficients, a factorial smaller.
fn assert_close<const K: usize>(what: &str, got: Jet<f64, K>, want: impl Fn(usize) -> f64) {
    for k in 0..K {
        let (got, want) = (got.0[k], want(k) / factorial(k));
        assert!((got - want).abs() <= 1e-12 * (1.0 + want.abs()), "{what}, coefficient {k} of {K}: {got}, not {want}");
    }
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}

/// Derivatives of `1/(1 + t)`, `√(1 + t)`, `sin`, `cos`, `exp` and `atan` about 0.3, each from its own formula.
fn elementary_functions<const K: usize>() {
    let t0 = 0.3;
    let t = Jet::<f64, K>::time(t0);
    let one = Jet::one();
    assert_close("1/(1 + t)", one / (one + t), |k| {
        (-1.0_f64).powi(k as i32) * factorial(k) / (1.0 + t0).powi(k as i32 + 1)
    });
    assert_close("√(1 + t)", (one + t).sqrt(), |k| {
        (0..k).map(|i| 0.5 - i as f64).product::<f64>() * (1.0 + t0).powf(0.5 - k as f64)
    });
    let quarter = |k: usize| k as f64 * std::f64::consts::FRAC_PI_2;
    let w = 1.7;
    let (sin, cos) = t.scale(w).sin_cos();
    assert_close("sin", sin, |k| w.powi(k as i32) * (w * t0 + quarter(k)).sin());
    assert_close("cos", cos, |k| w.powi(k as i32) * (w * t0 + quarter(k)).cos());
    assert_close("exp", t.scale(-w).exp(), |k| (-w).powi(k as i32) * (-w * t0).exp());
    // The angle of (cos wt, sin wt) is wt.
    assert_close("atan2", sin.atan2(cos), |k| [w * t0, w].get(k).copied().unwrap_or(0.0));
    // tanh x = 1 − 2/(e^{2x} + 1)
    let doubled = t.scale(2.0).exp();
    let other = one - Jet::from_f64(2.0) / (doubled + one);
    assert_close("tanh", t.tanh(), |k| other.derivative(k));
}

#[test]
fn elementary_functions_have_their_derivatives() {
    for_lengths!(elementary_functions);
}

/// Leibniz' rule for `t³ · t²`, and products undone by quotients and roots.
fn products<const K: usize>() {
    let t = Jet::<f64, K>::time(0.7);
    let fifth = (t * t * t) * (t * t);
    assert_close(
        "t⁵",
        fifth,
        |k| {
            if k > 5 { 0.0 } else { factorial(5) / factorial(5 - k) * 0.7_f64.powi(5 - k as i32) }
        },
    );
    assert_close("t⁵/t²", fifth / (t * t), |k| {
        if k > 3 { 0.0 } else { factorial(3) / factorial(3 - k) * 0.7_f64.powi(3 - k as i32) }
    });
    assert_close("√t⁴", (t * t * t * t).sqrt(), |k| [0.49, 1.4, 2.0].get(k).copied().unwrap_or(0.0));
    let x = Jet::<f64, K>::from_derivatives(&[2.0, -1.0, 3.0]);
    assert_close("derivatives in, derivatives out", x, |k| [2.0, -1.0, 3.0].get(k).copied().unwrap_or(0.0));
}

#[test]
fn products_quotients_and_roots_follow_leibniz() {
    for_lengths!(products);
}

#[test]
fn choices_are_made_by_the_present_value() {
    let (a, b) = (Jet([1.0, 5.0]), Jet([2.0, -5.0]));
    assert_eq!(a.select_less(b, a, b), a);
    assert_eq!(b.select_less(a, a, b), b);
    assert!(!Jet([1.0, f64::NAN]).is_finite() && a.is_finite());
}

#[test]
fn single_precision_follows_double() {
    let double = |t: f64| (Jet::<f64, 6>::time(t).scale(1.3).sin_cos().0 * Jet::time(t).exp()) / Jet::time(t + 2.0);
    let single = |t: f32| (Jet::<f32, 6>::time(t).scale(1.3).sin_cos().0 * Jet::time(t).exp()) / Jet::time(t + 2.0);
    for i in 0..20 {
        let t = 0.1 * f64::from(i);
        for k in 0..6 {
            let (got, want) = (f64::from(single(t as f32).derivative(k)), double(t).derivative(k));
            assert!((got - want).abs() < 1e-4 * (1.0 + want.abs()), "t {t}, derivative {k}: {got}, not {want}");
        }
    }
}

/// RNEA, as it is, on series: the rates of its torques are differences of its torques.
#[test]
fn inverse_dynamics_runs_on_series_unchanged() {
    let mut bodies = [
        link(None, [0.0, 0.0, 1.0], [0.0; 3], [0.1, 0.0, 0.05]),
        link(Some(0), [0.0, 1.0, 0.0], [0.1, 0.0, 0.3], [0.0, 0.05, 0.2]),
        link(Some(1), [1.0, 0.0, 0.0], [0.0, 0.1, 0.3], [0.1, 0.0, 0.1]),
    ];
    for (i, body) in bodies.iter_mut().enumerate() {
        body.drive = Some(drive(i.checked_sub(1), [0.6, 0.0, 0.8], 80.0, elastic(900.0, 2.0)));
    }
    let robot = Lowered::new(&bodies, [0.0, 0.0, -9.81], Fidelity::Complete);
    let model = robot.model();
    // x(t) = Σ aᵢ sin(wᵢ t): positions of links, then of motors
    let series = |i: usize, t: f64| Jet::<f64, 5>::time(t).scale(1.0 + 0.4 * i as f64).sin_cos().0.scale(0.8);
    let torques = |t: f64| {
        let all = |first: usize, k: usize| -> Vec<Jet<f64, 5>> {
            (0..3).map(|i| (0..k).fold(series(first + i, t), |x, _| x.rate())).collect()
        };
        let (mut tau_j, mut tau) = ([Jet::zero(); 3], [Jet::zero(); 3]);
        let state = State { q: &all(0, 0), qd: &all(0, 1), theta: &all(3, 0), thetad: &all(3, 1) };
        let accel = Acceleration { qdd: &all(0, 2), thetadd: &all(3, 2) };
        let out = Inverse { tau_j: &mut tau_j, tau: &mut tau };
        rnea(&model, state, accel, External::none(), &mut [RneaScratch::new(); 3], out).expect("slices fit");
        [tau_j, tau].concat()
    };
    let h = 1e-3;
    let [now, before, after] = [0.4, 0.4 - h, 0.4 + h].map(torques);
    for i in 0..6 {
        let [b, n, a] = [before[i].value(), now[i].value(), after[i].value()];
        let (rate, second) = (now[i].derivative(1), now[i].derivative(2));
        assert!((rate - (a - b) / (2.0 * h)).abs() < 1e-4 * (1.0 + rate.abs()), "{i}: {rate}");
        assert!((second - (a - 2.0 * n + b) / (h * h)).abs() < 1e-3 * (1.0 + second.abs()), "{i}: {second}");
    }
}
