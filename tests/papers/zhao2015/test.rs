//! Laws of the comparison of Zhao et al. 2015.

mod study;

use study::{Conditions, compare};

fn half_a_second(pace: f64) -> Conditions {
    Conditions { duration: 0.5, pace, ..Conditions::default() }
}

#[test]
fn only_the_complete_simulator_shows_what_the_reduced_feedforward_leaves_out() {
    let c = compare(half_a_second(2.0)).expect("the robot is physical");
    assert!(c.max(1) < 1e-6, "the reduced simulator is off by {} m under its own inverse", c.max(1));
    assert!(c.max(0) > 20.0 * c.max(1) && c.rms(0) > 20.0 * c.rms(1), "{} {}", c.max(0), c.max(1));
    assert!(c.largest_ratio() > 0.0);
}

#[test]
fn without_rotor_motion_there_is_no_difference() {
    // At a thousandth of the pace the coupling, which grows with its square, is gone.
    let c = compare(half_a_second(1e-3)).expect("the robot is physical");
    assert!(c.max(0) < 1e-8 && c.max(1) < 1e-8, "{} {}", c.max(0), c.max(1));
}
