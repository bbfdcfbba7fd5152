//! Laws of the derivatives that linear models are made of.

use crate::differences::{Argument, differences};
use crate::{arms, assert_close, deviation, displaced, moving, numbers};
use gyroflex::dynamics::External;
use gyroflex_sim::linearize::{Derivatives, Output, partials};
use gyroflex_sim::simulate::StateVec;
use nalgebra::DVector;

#[test]
fn partials_of_forward_dynamics_equal_central_differences() {
    for (name, linearizer, mut dynamics) in arms() {
        let (state, tau) = moving(&linearizer, &dynamics);
        let all = partials(&dynamics, &state, &tau).expect("slices fit");
        let of = |d: &Derivatives| [&d.q, &d.qd, &d.theta, &d.thetad, &d.tau].map(Clone::clone);
        let got = [of(&all.qdd), of(&all.thetadd), of(&all.tau_j)];
        let arguments = [Argument::Q, Argument::Qd, Argument::Theta, Argument::Thetad, Argument::Tau];
        for (i, argument) in arguments.into_iter().enumerate() {
            for (of, want) in differences(&mut dynamics, &state, &tau, argument).iter().enumerate() {
                assert_close(&format!("{name}: {of} by {argument:?}"), &got[of][i], want, 1e-6);
            }
        }
    }
}

#[test]
fn motions_that_begin_close_together_part_as_the_linear_model_says_at_any_moving_state() {
    const REACH: f64 = 1e-5;
    const H: f64 = 1e-4;
    for (name, linearizer, mut dynamics) in arms() {
        let (state, tau) = moving(&linearizer, &dynamics);
        let point = linearizer.point(state.clone(), tau.clone()).expect("it fits");
        let linear = linearizer.linearize(&point, &[Output::LinkPosition]).expect("it fits");
        let (layout, view) = (linearizer.layout(), dynamics.clone());
        let mut after = |from: &StateVec, time: f64| {
            let mut state = from.clone();
            dynamics.rk4(state.view_mut(), &tau, External::none(), time).expect("slices fit");
            state
        };
        let half = layout.positions();
        let direction = DVector::from_vec(numbers(7, 2 * half));
        let other = displaced(&view, layout, &point.state, &(&direction * REACH));
        let back = displaced(&view, layout, &point.state, &(&direction * -REACH));
        let mut apart = |time: f64| {
            let (here, there, behind) = (after(&point.state, time), after(&other, time), after(&back, time));
            (deviation(&view, layout, &here, &there) - deviation(&view, layout, &here, &behind)) / (2.0 * REACH)
        };
        let rate = ((apart(H) - apart(-H)) * 8.0 - (apart(2.0 * H) - apart(-2.0 * H))) / (12.0 * H);
        let want = &linear.a * &direction;
        for (what, first) in [("positions", 0), ("velocities", half)] {
            let rows = |v: &DVector<f64>| v.rows(first, half).into_owned();
            assert_close(&format!("{name}: {what}"), &rows(&want), &rows(&rate), 1e-5);
        }
    }
}
