//! Laws of sampled models.

use crate::{assert_close, numbers};
use gyroflex_sim::linearize::zero_order_hold;
use nalgebra::{DMatrix, DVector};

fn system(seed: u64, n: usize, m: usize, size: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    (DMatrix::from_vec(n, n, numbers(seed, n * n)) * size, DMatrix::from_vec(n, m, numbers(seed + 100, n * m)))
}

#[test]
fn a_sample_is_where_the_taylor_series_of_the_motion_leads() {
    for seed in 0..20 {
        let (n, m, step) = (1 + seed as usize % 9, 1 + seed as usize % 3, 0.4);
        let (a, b) = system(seed, n, m, 4.0);
        let (x, u) = (DVector::from_vec(numbers(seed + 200, n)), DVector::from_vec(numbers(seed + 300, m)));
        // Short pieces, so that twenty terms are plenty.
        let pieces = 256;
        let h = step / f64::from(pieces);
        let mut moved = x.clone();
        for _ in 0..pieces {
            let mut term = (&a * &moved + &b * &u) * h;
            for order in 2..22 {
                moved += &term;
                term = &a * term * (h / f64::from(order));
            }
        }
        let (ad, bd) = zero_order_hold(&a, &b, step).expect("it is finite");
        assert_close(&format!("seed {seed}"), &(ad * x + bd * u), &moved, 1e-12);
    }
}

#[test]
fn two_samples_are_one_of_twice_the_time() {
    let (a, b) = system(3, 8, 2, 30.0);
    let (one_a, one_b) = zero_order_hold(&a, &b, 0.01).expect("it is finite");
    let (two_a, two_b) = zero_order_hold(&a, &b, 0.02).expect("it is finite");
    assert_close("A", &(&one_a * &one_a), &two_a, 1e-13);
    assert_close("B", &(&one_a * &one_b + &one_b), &two_b, 1e-13);
}

#[test]
fn an_integrator_adds_up_exactly() {
    let (a, b) = (DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, 0.0]), DMatrix::from_row_slice(2, 1, &[0.0, 1.0]));
    let (ad, bd) = zero_order_hold(&a, &b, 0.5).expect("it is finite");
    assert_close("A", &ad, &[1.0, 0.0, 0.5, 1.0], 1e-15);
    assert_close("B", &bd, &[0.125, 0.5], 1e-15);
}

#[test]
fn steps_that_are_none_and_motions_beyond_all_numbers_are_refused() {
    let (a, b) = system(5, 3, 1, 1.0);
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(zero_order_hold(&a, &b, step).is_err(), "{step}");
    }
    let fast = DMatrix::from_element(1, 1, 1e6);
    assert!(zero_order_hold(&fast, &DMatrix::zeros(1, 1), 1.0).is_err(), "exp(1e6)");
}
