//! Forward dynamics of all four models against their dense oracles.

use gyroflex::model::Fidelity;
use gyroflex_testkit::dense::Accelerations;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, norm, tol};
use gyroflex_tests::{Trial, for_trials, small};

fn assert_equal<T: Real>(t: &Trial<'_, T>, got: &Accelerations, want: &Accelerations) {
    t.assert_close("qdd", &got.qdd, &want.qdd, 0.0);
    t.assert_close("thetadd", &got.thetadd, &want.thetadd, 0.0);
    // What a rigid gear passes on is what the motor's own inertia leaves of its torque.
    t.assert_close("tau_j", &got.tau_j, &want.tau_j, norm(&t.state.tau));
}

fn equals_oracle<T: Real>(t: &Trial<'_, T>) {
    assert_equal(t, &t.core.forward(&t.state), &t.oracle().forward(&t.state));
}

#[test]
fn complete_model_equals_2n_body_tree() {
    for_trials::<f64>(1000, &Options::default(), &[Fidelity::Complete], tol(1e-10, 0.0), equals_oracle);
}

#[test]
fn reduced_model_equals_its_dense_oracle() {
    for_trials::<f64>(1000, &Options::default(), &[Fidelity::Reduced], tol(1e-10, 0.0), equals_oracle);
}

#[test]
fn rigid_geared_model_equals_the_projected_2n_body_tree() {
    for_trials::<f64>(1000, &Options::default(), &[Fidelity::Rigid], tol(1e-10, 0.0), equals_oracle);
}

#[test]
fn rigid_reflected_model_equals_its_dense_oracle() {
    for_trials::<f64>(1000, &Options::default(), &[Fidelity::RigidReflected], tol(1e-10, 0.0), equals_oracle);
}

#[test]
fn single_precision_equals_the_oracles_as_far_as_it_goes() {
    for_trials::<f32>(500, &small(), &Fidelity::ALL, tol(0.0, 1e-3), equals_oracle);
}

/// The articulated recursion is exact in every model as long as rigidly geared rotors sit on their joint's parent.
#[test]
fn articulated_and_joint_space_routes_agree() {
    let options = Options { remote_rigid: false, ..Options::default() };
    for_trials::<f64>(300, &options, &[Fidelity::Complete, Fidelity::Reduced], tol(1e-10, 0.0), |t| {
        assert_equal(t, &t.core.aba(&t.state), &t.core.forward_in_joint_space(&t.state));
    });
    let options = Options { remote_mount: 0.0, ..Options::default() };
    for_trials::<f64>(300, &options, &Fidelity::ALL, tol(1e-10, 0.0), |t| {
        assert_equal(t, &t.core.aba(&t.state), &t.core.forward_in_joint_space(&t.state));
    });
}
