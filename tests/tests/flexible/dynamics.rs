//! The core's algorithms against Lagrange's equations of the same kinematics.

use gyroflex::model::Fidelity;
use gyroflex_testkit::dense::Accelerations;
use gyroflex_testkit::random::FlexibleOptions;
use gyroflex_testkit::tolerance::{Real, norm, tol};
use gyroflex_tests::{FlexibleTrial, for_flexible};

fn assert_equal<T: Real>(t: &FlexibleTrial<'_, T>, got: &Accelerations, want: &Accelerations) {
    t.assert_close("qdd", &got.qdd, &want.qdd, 0.0);
    t.assert_close("thetadd", &got.thetadd, &want.thetadd, 0.0);
    // What a rigid gear passes on is what the motor's own inertia leaves of its torque.
    t.assert_close("tau_j", &got.tau_j, &want.tau_j, norm(&t.state.tau));
}

fn forward_equals_oracle<T: Real>(t: &FlexibleTrial<'_, T>) {
    let want = t.oracle().forward(&t.state);
    let got = t.core.forward(&t.state);
    assert_equal(t, &got, &want);
}

#[test]
fn forward_dynamics_equals_lagrangian_of_the_same_kinematics() {
    for_flexible::<f64>(200, &FlexibleOptions::default(), &Fidelity::ALL, tol(1e-9, 0.0), forward_equals_oracle);
}
