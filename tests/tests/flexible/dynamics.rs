//! The core's algorithms against Lagrange's equations of the same kinematics, and against each other.

use gyroflex::Lanes;
use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::dense::Accelerations;
use gyroflex_testkit::random::{FlexibleOptions, Options};
use gyroflex_testkit::tolerance::{Real, norm, tol};
use gyroflex_tests::{FlexibleTrial, for_flexible, small_flexible};
use nalgebra::{DMatrix, DVector};

fn any() -> FlexibleOptions {
    FlexibleOptions::default()
}

fn by_rows(m: &DMatrix<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}

fn assert_equal<T: Real>(t: &FlexibleTrial<'_, T>, got: &Accelerations, want: &Accelerations) {
    t.assert_close("qdd", &got.qdd, &want.qdd, 0.0);
    t.assert_close("thetadd", &got.thetadd, &want.thetadd, 0.0);
    // What a rigid gear passes on is what the motor's own inertia leaves of its torque.
    t.assert_close("tau_j", &got.tau_j, &want.tau_j, norm(&t.state.tau));
}

fn forward_equals_oracle<T: Real>(t: &FlexibleTrial<'_, T>) {
    assert_equal(t, &t.core.forward(&t.state), &t.oracle().forward(&t.state));
}

#[test]
fn forward_dynamics_equals_lagrangian_of_the_same_kinematics() {
    for_flexible::<f64>(300, &any(), &Fidelity::ALL, tol(1e-10, 0.0), forward_equals_oracle);
}

#[test]
fn forward_dynamics_in_single_precision() {
    for_flexible::<f32>(200, &small_flexible(), &Fidelity::ALL, tol(0.0, 1e-3), forward_equals_oracle);
}

#[test]
fn forward_dynamics_in_lanes() {
    for_flexible::<Lanes<f64, 8>>(100, &any(), &Fidelity::ALL, tol(1e-10, 0.0), forward_equals_oracle);
}

/// A flexible root that flies, and flexible links on one that does.
#[test]
fn floating_roots() {
    let options = FlexibleOptions { robot: Options { floating: 1.0, ..any().robot }, ..any() };
    for_flexible::<f64>(100, &options, &Fidelity::ALL, tol(1e-9, 0.0), |t| {
        forward_equals_oracle(t);
        inverse_equals_oracle(t);
        matrices_equal_oracle(t);
    });
}

/// A robot that falls freely bends and moves as one far from all masses, but for the acceleration of its root.
#[test]
fn falling_freely_is_no_load() {
    let options = FlexibleOptions { robot: Options { floating: 1.0, ..any().robot }, ..any() };
    for_flexible::<f64>(100, &options, &Fidelity::ALL, tol(1e-9, 0.0), |t| {
        let mut weightless = t.robot.clone();
        weightless.robot.gravity = [0.0; 3].into();
        let far = FlexibleTrial::<f64>::new(&weightless, t.fidelity, t.state.clone(), tol(1e-9, 0.0));
        let (falling, flying) = (t.core.forward(&t.state), far.core.forward(&t.state));
        t.assert_close("all but the root", &falling.qdd[6..], &flying.qdd[6..], norm(&falling.qdd));
        t.assert_close("the root's turn", &falling.qdd[..3], &flying.qdd[..3], norm(&falling.qdd));
        let gained: Vec<f64> = (3..6).map(|k| falling.qdd[k] - flying.qdd[k]).collect();
        let size = gained.iter().map(|x| x * x).sum::<f64>().sqrt();
        t.assert_close("the root's fall", &[size], &[t.robot.robot.gravity.norm()], norm(&falling.qdd));
    });
}

fn inverse_equals_oracle<T: Real>(t: &FlexibleTrial<'_, T>) {
    let (got, want) = (t.core.inverse(&t.state), t.oracle().inverse(&t.state));
    t.assert_close("tau_j", &got.tau_j, &want.tau_j, 0.0);
    t.assert_close("tau", &got.tau, &want.tau, 0.0);
}

#[test]
fn inverse_dynamics_equals_lagrangian_of_the_same_kinematics() {
    for_flexible::<f64>(200, &any(), &Fidelity::ALL, tol(1e-11, 0.0), inverse_equals_oracle);
    for_flexible::<f32>(200, &small_flexible(), &Fidelity::ALL, tol(0.0, 1e-4), inverse_equals_oracle);
    for_flexible::<Lanes<f64, 8>>(50, &any(), &Fidelity::ALL, tol(1e-11, 0.0), inverse_equals_oracle);
}

fn matrices_equal_oracle<T: Real>(t: &FlexibleTrial<'_, T>) {
    let ([mass, coupling], [want, coupled]) = (t.core.matrices(&t.state), t.oracle().matrices(&t.state));
    t.assert_close("M", &mass, &by_rows(&want), 0.0);
    t.assert_close("S", &coupling, &by_rows(&coupled), 1e-3);
}

#[test]
fn mass_matrix_equals_hessian_of_kinetic_energy() {
    for_flexible::<f64>(200, &any(), &Fidelity::ALL, tol(1e-12, 0.0), matrices_equal_oracle);
    for_flexible::<f32>(200, &any(), &Fidelity::ALL, tol(0.0, 1e-4), matrices_equal_oracle);
    for_flexible::<Lanes<f64, 8>>(50, &any(), &Fidelity::ALL, tol(1e-12, 0.0), matrices_equal_oracle);
}

/// Forward, then inverse: torques and modal forces come back.
fn inverse_inverts_forward<T: Real>(t: &FlexibleTrial<'_, T>) {
    let moved = t.core.forward(&t.state);
    let there = State { qdd: moved.qdd, thetadd: moved.thetadd, ..t.state.clone() };
    let back = t.core.inverse(&there);
    // The torques that accelerate rotors and links, which the loads are a remainder of: without loads they are all.
    let moving = norm(&t.core.inverse(&State { tau_ext: Vec::new(), wrenches: Vec::new(), ..there }).tau)
        .max(norm(&t.state.tau))
        .max(norm(&moved.tau_j));
    t.assert_close("tau_j", &back.tau_j, &moved.tau_j, moving);
    t.assert_close("tau", &back.tau, &t.state.tau, moving);
}

#[test]
fn inverse_of_forward_is_the_identity() {
    for_flexible::<f64>(300, &any(), &Fidelity::ALL, tol(1e-9, 0.0), inverse_inverts_forward);
    for_flexible::<f32>(200, &small_flexible(), &Fidelity::ALL, tol(0.0, 1e-3), inverse_inverts_forward);
}

/// Inverse, then forward: accelerations come back. What the asked motion needs beyond what the deflection of an elastic transmission
/// gives is made an external load.
#[test]
fn forward_inverts_inverse() {
    for_flexible::<f64>(300, &any(), &Fidelity::ALL, tol(1e-9, 0.0), |t| {
        let (transmitted, needed) = (t.core.forward(&t.state).tau_j, t.core.inverse(&t.state).tau_j);
        let mut s = t.state.clone();
        let model = t.core.model();
        for body in model.rigid().bodies().iter().filter(|b| b.is_elastic()) {
            let k = body.v_index();
            s.tau_ext[k] += needed[k] - transmitted[k];
        }
        s.tau = t.core.inverse(&s).tau;
        let back = t.core.forward(&s);
        t.assert_close("qdd", &back.qdd, &s.qdd, 0.0);
        for body in model.rigid().bodies().iter().filter(|b| b.is_elastic()) {
            // A light rotor's acceleration is a small difference of torques over a small inertia: compare what it takes.
            let (k, b) = (body.v_index(), body.drive.expect("an elastic joint has a drive").rotor.reflected_inertia);
            t.assert_close("B thetadd", &[b * back.thetadd[k]], &[b * s.thetadd[k]], norm(&s.tau));
        }
    });
}

/// Joints and motors that are asked to move as they do under these torques take these torques, and the modes move as they did.
fn hybrid_agrees_with_forward<T: Real>(t: &FlexibleTrial<'_, T>) {
    let joints = t.core.model().rigid().nv();
    let mut s = t.state.clone();
    s.tau[joints..].fill(0.0);
    let moved = t.core.forward(&s);
    let mut there = State { qdd: moved.qdd.clone(), thetadd: moved.thetadd.clone(), ..s.clone() };
    // Not read.
    there.qdd[joints..].fill(f64::NAN);
    let (torques, etadd) = t.core.hybrid(&there);
    let size = norm(
        &t.core.inverse(&State { qdd: moved.qdd.clone(), tau_ext: Vec::new(), wrenches: Vec::new(), ..there }).tau,
    );
    let moving = size.max(norm(&s.tau)).max(norm(&moved.tau_j));
    t.assert_close("etadd", &etadd, &moved.qdd[joints..], norm(&moved.qdd));
    t.assert_close("tau_j", &torques.tau_j[..joints], &moved.tau_j[..joints], moving);
    t.assert_close("tau", &torques.tau[..joints], &s.tau[..joints], moving);
    assert!(torques.tau[joints..].iter().chain(&torques.tau_j[joints..]).all(|x| *x == 0.0), "{t}");
}

#[test]
fn hybrid_agrees_with_forward_dynamics() {
    for_flexible::<f64>(300, &any(), &Fidelity::ALL, tol(1e-9, 0.0), hybrid_agrees_with_forward);
    for_flexible::<f32>(200, &small_flexible(), &Fidelity::ALL, tol(0.0, 1e-3), hybrid_agrees_with_forward);
}

/// Modes that are free accelerate such that no force but their own acts on them: `M_ηη η̈ = −p`, `p` what `η̈ = 0` needs.
#[test]
fn hybrid_dynamics_equals_lagrangian_of_the_same_kinematics() {
    for_flexible::<f64>(200, &any(), &Fidelity::ALL, tol(1e-9, 0.0), |t| {
        let (oracle, joints) = (t.oracle(), t.core.model().rigid().nv());
        let mut s = t.state.clone();
        s.qdd[joints..].fill(0.0);
        let held = DVector::from_column_slice(&oracle.inverse(&s).tau[joints..]);
        let [mass, _] = oracle.matrices(&s);
        let modal = mass.view((joints, joints), (held.len(), held.len())).into_owned();
        let free = -modal.cholesky().expect("modes have mass").solve(&held);
        s.qdd[joints..].copy_from_slice(free.as_slice());
        let want = oracle.inverse(&s);
        let (torques, etadd) = t.core.hybrid(&s);
        t.assert_close("etadd", &etadd, free.as_slice(), 0.0);
        t.assert_close("tau_j", &torques.tau_j[..joints], &want.tau_j[..joints], 0.0);
        t.assert_close("tau", &torques.tau[..joints], &want.tau[..joints], 0.0);
    });
}

#[test]
fn links_and_stations_are_where_the_oracle_has_them() {
    for_flexible::<f64>(200, &any(), &[Fidelity::Complete], tol(1e-12, 0.0), |t| {
        let [links, stations] = t.core.placements(&t.state);
        let [want, sections] = t.oracle().placements(&t.state);
        t.assert_close("links", &links, &want, 1.0);
        t.assert_close("stations", &stations, &sections, 1.0);
    });
}
