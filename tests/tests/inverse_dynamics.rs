//! Inverse dynamics against its oracle, and against forward dynamics.

use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, norm, tol};
use gyroflex_tests::{Trial, for_trials, small};

fn equals_oracle<T: Real>(t: &Trial<'_, T>) {
    let (got, want) = (t.core.inverse(&t.state), t.oracle().inverse(&t.state));
    t.assert_close("tau_j", &got.tau_j, &want.tau_j, 0.0);
    t.assert_close("tau", &got.tau, &want.tau, 0.0);
}

#[test]
fn inverse_dynamics_equals_the_dense_oracles() {
    for_trials::<f64>(500, &Options::default(), &Fidelity::ALL, tol(1e-10, 0.0), equals_oracle);
}

#[test]
fn inverse_dynamics_in_single_precision() {
    for_trials::<f32>(500, &Options::default(), &Fidelity::ALL, tol(0.0, 1e-4), equals_oracle);
}

/// Forward, then inverse: the torques come back.
fn inverse_inverts_forward<T: Real>(t: &Trial<'_, T>) {
    let moved = t.core.forward(&t.state);
    let there = State { qdd: moved.qdd, thetadd: moved.thetadd, ..t.state.clone() };
    let back = t.core.inverse(&there);
    // The torques that accelerate rotors and links, which the loads are a remainder of.
    let moving = norm(&t.oracle().tree_forces(&there));
    t.assert_close("tau_j", &back.tau_j, &moved.tau_j, moving);
    t.assert_close("tau", &back.tau, &t.state.tau, moving);
}

#[test]
fn inverse_of_forward_is_the_identity() {
    for_trials::<f64>(500, &Options::default(), &Fidelity::ALL, tol(1e-10, 0.0), inverse_inverts_forward);
}

#[test]
fn inverse_of_forward_is_the_identity_in_single_precision() {
    for_trials::<f32>(500, &small(), &Fidelity::ALL, tol(0.0, 1e-3), inverse_inverts_forward);
}

/// Inverse, then forward: the accelerations come back. The torque through an elastic transmission is set by its
/// deflection; what the asked motion needs beyond it is made an external load.
fn forward_inverts_inverse<T: Real>(t: &Trial<'_, T>) {
    let transmitted = t.core.forward(&t.state).tau_j;
    let needed = t.core.inverse(&t.state).tau_j;
    let mut s = t.state.clone();
    for body in t.core.model().bodies().iter().filter(|b| b.is_elastic()) {
        let k = body.v_index();
        s.tau_ext[k] += needed[k] - transmitted[k];
    }
    s.tau = t.core.inverse(&s).tau;
    let back = t.core.forward(&s);
    t.assert_close("qdd", &back.qdd, &s.qdd, 0.0);
    // A light rotor's acceleration is a small difference of torques over a small inertia: compare what it takes.
    let b = t.core.reflected_inertia();
    let torque = |a: &[f64]| -> Vec<f64> { a.iter().zip(&b).map(|(a, b)| a * b).collect() };
    t.assert_close("B thetadd", &torque(&back.thetadd), &torque(&s.thetadd), norm(&s.tau));
}

#[test]
fn forward_of_inverse_is_the_identity() {
    for_trials::<f64>(500, &Options::default(), &Fidelity::ALL, tol(1e-10, 0.0), forward_inverts_inverse);
}
