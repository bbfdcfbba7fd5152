//! Laws of the discrete algebraic Riccati equation.

use crate::{apart, numbers, radius};
use gyroflex_sim::lqr::{Riccati, riccati};
use nalgebra::{DMatrix, DVector};

fn named(i: usize) -> String {
    format!("x{i}")
}

/// `A, B, Q, R` of a system without a pattern, unstable for most seeds.
fn system(seed: u64) -> [DMatrix<f64>; 4] {
    let (n, m) = (1 + seed as usize % 6, 1 + seed as usize % 3);
    let square = |seed: u64, n: usize| {
        let root = DMatrix::from_vec(n, n, numbers(seed, n * n));
        &root * root.transpose() + DMatrix::identity(n, n) * 0.1
    };
    let a = DMatrix::from_vec(n, n, numbers(seed, n * n)) * 1.5;
    [a, DMatrix::from_vec(n, m, numbers(seed + 100, n * m)), square(seed + 200, n), square(seed + 300, m)]
}

fn solve([a, b, q, r]: &[DMatrix<f64>; 4]) -> Riccati {
    riccati(a, b, q, r, &named).unwrap_or_else(|e| panic!("{e}"))
}

/// `b² x² + (r (1 − a²) − q b²) x − q r = 0`, its positive root.
fn closed_form(a: f64, b: f64, q: f64, r: f64) -> f64 {
    let c = r * (1.0 - a * a) - q * b * b;
    let root = (c * c + 4.0 * b * b * q * r).sqrt();
    // Of the two ways to write the root the one that loses no digits.
    if c > 0.0 { 2.0 * q * r / (c + root) } else { (root - c) / (2.0 * b * b) }
}

#[test]
fn a_scalar_system_has_its_closed_form() {
    for (a, b, q, r) in [(0.5, 1.0, 1.0, 1.0), (3.0, 0.1, 2.0, 0.5), (-1.2, 40.0, 1e-3, 1e4), (1.0, 1e-3, 1e6, 1e-6)] {
        let want = closed_form(a, b, q, r);
        let got = solve(&[a, b, q, r].map(|x| DMatrix::from_element(1, 1, x)));
        assert!((got.x[(0, 0)] / want - 1.0).abs() < 1e-12, "{} is not {want}", got.x[(0, 0)]);
        assert!((got.gain[(0, 0)] / (a * b * want / (r + b * b * want)) - 1.0).abs() < 1e-12);
    }
}

/// Two systems side by side, so far apart in size that one is nothing beside the other.
#[test]
fn a_slow_state_that_costs_little_is_solved_beside_a_fast_one_that_costs_much() {
    let ([a, b, q, r], diagonal) = ([[0.5, 0.9999], [1.0, 1e-4], [1e20, 1e-20], [1e20, 1e-20]], |x: [f64; 2]| {
        DMatrix::from_diagonal(&DVector::from_vec(x.to_vec()))
    });
    let got = solve(&[a, b, q, r].map(diagonal));
    for i in 0..2 {
        let want = closed_form(a[i], b[i], q[i], r[i]);
        assert!((got.x[(i, i)] / want - 1.0).abs() < 1e-10, "{i}: {} is not {want}", got.x[(i, i)]);
    }
}

#[test]
fn it_is_where_the_cost_of_ever_more_samples_leads() {
    for seed in 0..30 {
        let system @ [a, b, q, r] = &system(seed);
        let got = solve(system);
        let mut x = DMatrix::zeros(a.nrows(), a.nrows());
        for _ in 0..3_000 {
            let inner = (r + b.transpose() * &x * b).try_inverse().expect("it is positive");
            x = a.transpose() * (&x - &x * b * inner * b.transpose() * &x) * a + q;
        }
        assert!(apart(&got.x, &x) < 1e-9, "seed {seed}: {}", apart(&got.x, &x));
    }
}

#[test]
fn no_other_gain_costs_less_and_the_cost_is_the_sum_over_all_samples() {
    for seed in 0..30 {
        let system @ [a, b, q, r] = &system(seed);
        let got = solve(system);
        let start = DVector::from_vec(numbers(seed + 400, a.nrows()));
        let cost = |gain: &DMatrix<f64>| {
            let (mut x, mut sum) = (start.clone(), 0.0);
            for _ in 0..3_000 {
                let u = -(gain * &x);
                sum += x.dot(&(q * &x)) + u.dot(&(r * &u));
                x = a * &x + b * &u;
            }
            sum
        };
        let least = start.dot(&(&got.x * &start));
        assert!((cost(&got.gain) / least - 1.0).abs() < 1e-9, "seed {seed}: {} is not {least}", cost(&got.gain));
        for i in 0..got.gain.len() {
            let mut other = got.gain.clone();
            other[i] += 1e-2 * got.gain.norm();
            assert!(cost(&other) > least * (1.0 - 1e-12) || cost(&other).is_nan(), "seed {seed}, entry {i}");
        }
        let closed = radius(&(a - b * &got.gain));
        assert!(closed < 1.0 && (closed - got.radius).abs() < 1e-9, "seed {seed}: {closed}, {}", got.radius);
    }
}

#[test]
fn units_of_the_states_do_not_matter() {
    for seed in 0..30 {
        let system @ [a, b, q, r] = &system(seed);
        let plain = solve(system);
        let n = a.nrows();
        let unit = DMatrix::from_diagonal(&DVector::from_fn(n, |i, _| 10f64.powi(9 * (i as i32 % 3 - 1))));
        let back = unit.clone().try_inverse().expect("it is a diagonal");
        let other = solve(&[&unit * a * &back, &unit * b, &back * q * &back, r.clone()]);
        assert!(apart(&(other.gain * &unit), &plain.gain) < 1e-9, "seed {seed}");
        assert!(apart(&(&unit * other.x * &unit), &plain.x) < 1e-9, "seed {seed}");
    }
}

#[test]
fn what_no_input_reaches_is_refused_if_it_grows_and_left_alone_if_it_fades() {
    let system = |slow: f64| {
        let a = DMatrix::from_row_slice(2, 2, &[1.1, 0.3, 0.0, slow]);
        let b = DMatrix::from_row_slice(2, 1, &[1.0, 0.0]);
        riccati(&a, &b, &DMatrix::identity(2, 2), &DMatrix::identity(1, 1), &named)
    };
    for slow in [1.0, 1.01, -2.0] {
        let error = system(slow).expect_err("nothing reaches the second state");
        assert!(error.problem.contains("`x1`"), "{error}");
    }
    assert!(system(0.99).is_ok());
}

/// Least cost is not reason enough to bring back what costs nothing.
#[test]
fn motions_that_cost_nothing_are_refused_unless_they_fade() {
    let system = |free: f64| {
        let a = DMatrix::from_row_slice(3, 3, &[0.5, 0.1, 0.0, 0.0, 0.9, 0.0, 0.0, 0.0, free]);
        let b = DMatrix::from_row_slice(3, 1, &[1.0, 1.0, 1.0]);
        let q = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 2.0, 0.0]));
        riccati(&a, &b, &q, &DMatrix::identity(1, 1), &named)
    };
    for free in [1.0, -1.0, 1.3, 2.0] {
        let error = system(free).expect_err("nothing pays for the third state");
        assert!(error.problem.contains("`x2`"), "{error}");
    }
    assert!(system(0.95).is_ok());
    let one = DMatrix::identity(1, 1);
    assert!(riccati(&one, &one, &DMatrix::zeros(1, 1), &one, &named).is_err(), "an integrator");
}

#[test]
fn weights_that_are_none_are_refused() {
    let [a, b, q, r] = system(4);
    let nan = a.map(|x| if x == a[0] { f64::NAN } else { x });
    let bad = [
        riccati(&nan, &b, &q, &r, &named),
        riccati(&a, &b, &-&q, &r, &named),
        riccati(&a, &b, &q, &-&r, &named),
        riccati(&a, &b.transpose(), &q, &r, &named),
    ];
    for result in bad {
        result.expect_err("it makes no sense");
    }
}
