//! Linear models against simulations of the whole robot.

use crate::{arms, deviation, displaced, numbers, pose};
use gyroflex::dynamics::External;
use gyroflex_sim::linearize::{Output, zero_order_hold};
use nalgebra::DVector;

const DURATION: f64 = 0.1;
const STEPS: usize = 1000;

#[test]
fn the_error_of_the_linear_model_falls_fourfold_when_the_disturbance_halves() {
    for (name, mut linearizer, mut dynamics) in arms() {
        let q = pose(&linearizer);
        let point = linearizer.equilibrium_at(&q).expect("it fits");
        let linear = linearizer.linearize(&point, &[Output::LinkPosition]).expect("it fits");
        let layout = linearizer.layout();
        let (a, b) = zero_order_hold(&linear.a, &linear.b, DURATION).expect("it stays finite");
        let (x, u) = (DVector::from_vec(numbers(5, a.nrows())), DVector::from_vec(numbers(6, b.ncols())) * 10.0);
        let mut error = |size: f64| {
            let mut state = displaced(&dynamics, layout, &point.state, &(&x * size));
            let mut tau = point.tau.clone();
            layout.inputs().iter().zip(&u).for_each(|(k, u)| tau[*k] += size * u);
            for _ in 0..STEPS {
                let step = DURATION / STEPS as f64;
                dynamics.rk4(state.view_mut(), &tau, External::none(), step).expect("slices fit");
            }
            let apart = deviation(&dynamics, layout, &point.state, &state);
            let linear = (&a * &x + &b * &u) * size;
            ((apart - &linear).norm(), linear.norm())
        };
        let ((whole, size), (half, _)) = (error(2e-5), error(1e-5));
        assert!(whole < 1e-2 * size, "{name}: {whole} of {size}");
        assert!((3.9..4.1).contains(&(whole / half)), "{name}: {whole} against {half}");
    }
}
