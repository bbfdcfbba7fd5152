//! Energy, and what changes it.

use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::Options;
use gyroflex_testkit::tolerance::{Real, tol};
use gyroflex_tests::{Trial, for_trials};

fn equal_oracle<T: Real>(t: &Trial<'_, T>) {
    let (got, want) = (t.core.energy(&t.state), t.oracle().energy(&t.state));
    t.assert_close("kinetic", &[got.kinetic], &[want.kinetic], 0.0);
    t.assert_close("elastic", &[got.elastic], &[want.elastic], 0.0);
    // Where gravity's energy is zero is free: compare what moving changes. Nearly cancelling sums are no smaller than this.
    let away = Trial::<T>::new(t.robot, t.fidelity, t.robot.state(1), tol(0.0, 0.0)).state;
    let got = got.gravity - t.core.energy(&away).gravity;
    let (here, there) = (want.gravity, t.oracle().energy(&away).gravity);
    t.assert_close("gravity", &[got], &[here - there], here.abs() + there.abs() + 100.0);

    let (got, want) = (t.core.power(&t.state), t.oracle().power(&t.state));
    t.assert_close("dissipated", &[got.dissipated], &[want.dissipation], 1.0);
    t.assert_close("supplied", &[got.supplied], &[want.input], 100.0);
    assert!(got.dissipated >= 0.0, "{t}");
}

#[test]
fn energies_and_powers_equal_the_dense_oracles() {
    for_trials::<f64>(500, &Options::default(), &Fidelity::ALL, tol(1e-11, 0.0), equal_oracle);
}

#[test]
fn energies_and_powers_in_single_precision() {
    for_trials::<f32>(500, &Options::default(), &Fidelity::ALL, tol(0.0, 1e-3), equal_oracle);
}

/// `dE/dt` of the *oracle's* energy along the *core's* accelerations, by a seven-point difference, is the core's
/// `supplied − dissipated`.
fn rate_is_power<T: Real>(t: &Trial<'_, T>) {
    let (s, oracle) = (&t.state, t.oracle());
    let a = t.core.forward(s);
    let along = |h: f64| {
        let moved = |x: &[f64], v: &[f64]| -> Vec<f64> { x.iter().zip(v).map(|(x, v)| x + h * v).collect() };
        let there = State {
            q: moved(&s.q, &position_rates(s)),
            theta: moved(&s.theta, &s.thetad),
            qd: moved(&s.qd, &a.qdd),
            thetad: moved(&s.thetad, &a.thetadd),
            ..s.clone()
        };
        oracle.energy(&there).total()
    };
    // Rotors turn up to 400 rad/s and transmission errors three times as fast: a step well inside their period.
    let h = 5e-6;
    let central = |k: f64| along(k * h) - along(-k * h);
    let rate = (45.0 * central(1.0) - 9.0 * central(2.0) + central(3.0)) / (60.0 * h);
    let power = t.core.power(s);
    // A difference quotient rounds like the energies it is taken of.
    let e = oracle.energy(s);
    let size = power.supplied.abs() + power.dissipated + e.kinetic + e.elastic + e.gravity.abs() + 100.0;
    t.assert_close("energy rate", &[rate], &[power.supplied - power.dissipated], size);
}

/// Rates of the coordinates; of a floating root, `ṗ = R v` and `q̇ = ½ q ω` for its body twist.
fn position_rates(s: &State) -> Vec<f64> {
    if s.q.len() == s.qd.len() {
        return s.qd.clone();
    }
    let q = nalgebra::Quaternion::new(s.q[6], s.q[3], s.q[4], s.q[5]);
    let omega = nalgebra::Quaternion::new(0.0, s.qd[0], s.qd[1], s.qd[2]);
    let spin = (q * omega * 0.5).coords;
    let v = nalgebra::UnitQuaternion::from_quaternion(q) * nalgebra::Vector3::new(s.qd[3], s.qd[4], s.qd[5]);
    let root = [v.x, v.y, v.z, spin.x, spin.y, spin.z, spin.w];
    root.into_iter().chain(s.qd[6..].iter().copied()).collect()
}

#[test]
fn energy_rate_equals_power_minus_dissipation() {
    // A spring table has a jump in its second derivative that no difference quotient likes.
    let options = Options { table: 0.0, ..Options::default() };
    for_trials::<f64>(1000, &options, &Fidelity::ALL, tol(1e-8, 0.0), rate_is_power);
}

#[test]
fn energy_rate_in_single_precision() {
    let options = Options { table: 0.0, bodies: 1..=8, ..Options::default() };
    for_trials::<f32>(300, &options, &Fidelity::ALL, tol(0.0, 1e-2), rate_is_power);
}

#[test]
fn a_robot_without_friction_and_loads_keeps_its_energy() {
    let options = Options { table: 0.0, ..Options::default() }.lossless();
    for_trials::<f64>(200, &options, &Fidelity::ALL, tol(1e-8, 0.0), |t| {
        let free =
            State { tau: vec![0.0; t.state.tau.len()], tau_ext: Vec::new(), wrenches: Vec::new(), ..t.state.clone() };
        let t = Trial::<f64>::new(t.robot, t.fidelity, free, tol(1e-8, 0.0));
        let power = t.core.power(&t.state);
        assert_eq!((power.supplied, power.dissipated), (0.0, 0.0), "{t}");
        rate_is_power(&t);
    });
}
