//! Energy, and what changes it.

use gyroflex::model::Fidelity;
use gyroflex_testkit::State;
use gyroflex_testkit::random::{FlexibleOptions, Options};
use gyroflex_testkit::tolerance::{Real, tol};
use gyroflex_tests::{FlexibleTrial, for_flexible, small_flexible};

fn equal_oracle<T: Real>(t: &FlexibleTrial<'_, T>) {
    let (got, want) = (t.core.energy(&t.state), t.oracle().energy(&t.state));
    t.assert_close("kinetic", &[got.kinetic], &[want.kinetic], 0.0);
    t.assert_close("elastic", &[got.elastic], &[want.elastic], 0.0);
    // Rotors on the world count as the user likes: compare what moving changes.
    let away = FlexibleTrial::<T>::new(t.robot, t.fidelity, t.robot.state(1), tol(0.0, 0.0)).state;
    let got = got.gravity - t.core.energy(&away).gravity;
    let (here, there) = (want.gravity, t.oracle().energy(&away).gravity);
    t.assert_close("gravity", &[got], &[here - there], here.abs() + there.abs() + 100.0);

    let (got, want) = (t.core.power(&t.state), t.oracle().power(&t.state));
    t.assert_close("dissipated", &[got.dissipated], &[want.dissipation], 1.0);
    t.assert_close("supplied", &[got.supplied], &[want.input], 100.0);
}

#[test]
fn energies_and_powers_equal_those_of_the_oracle() {
    for_flexible::<f64>(300, &FlexibleOptions::default(), &Fidelity::ALL, tol(1e-11, 0.0), equal_oracle);
    for_flexible::<f32>(200, &FlexibleOptions::default(), &Fidelity::ALL, tol(0.0, 1e-3), equal_oracle);
}

/// Rates of the coordinates; of a floating root, `ṗ = R v` and `q̇ = ½ q ω` for its body twist.
fn position_rates(s: &State) -> Vec<f64> {
    gyroflex_testkit::dual::moving_positions(&s.q, &s.qd).iter().map(|q| q.slope).collect()
}

fn moved(s: &State, rates: &State, h: f64) -> State {
    let by = |x: &[f64], v: &[f64]| -> Vec<f64> { x.iter().zip(v).map(|(x, v)| x + h * v).collect() };
    State {
        q: by(&s.q, &rates.q),
        qd: by(&s.qd, &rates.qd),
        theta: by(&s.theta, &rates.theta),
        thetad: by(&s.thetad, &rates.thetad),
        ..s.clone()
    }
}

fn rates<T: Real>(t: &FlexibleTrial<'_, T>, s: &State) -> State {
    let a = t.core.forward(s);
    State { q: position_rates(s), qd: a.qdd, theta: s.thetad.clone(), thetad: a.thetadd, ..State::default() }
}

/// `dE/dt` of the *oracle's* energy along the *core's* accelerations, by a seven-point difference, is the core's
/// `supplied − dissipated`.
fn rate_is_power<T: Real>(t: &FlexibleTrial<'_, T>) {
    let (s, oracle) = (&t.state, t.oracle());
    let rates = rates(t, s);
    let along = |h: f64| oracle.energy(&moved(s, &rates, h)).total();
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

#[test]
fn energy_rate_equals_power() {
    // A spring table has a jump in its second derivative that no difference quotient likes.
    let smooth =
        |options: FlexibleOptions| FlexibleOptions { robot: Options { table: 0.0, ..options.robot }, ..options };
    for_flexible::<f64>(300, &smooth(FlexibleOptions::default()), &Fidelity::ALL, tol(1e-8, 0.0), rate_is_power);
    for_flexible::<f32>(200, &smooth(small_flexible()), &Fidelity::ALL, tol(0.0, 1e-2), rate_is_power);
}

#[test]
fn nothing_is_lost_without_friction_damping_and_loads() {
    for_flexible::<f64>(100, &FlexibleOptions::default().lossless(), &Fidelity::ALL, tol(0.0, 0.0), |t| {
        let n = t.state.tau.len();
        let free = State { tau: vec![0.0; n], tau_ext: Vec::new(), wrenches: Vec::new(), ..t.state.clone() };
        let power = t.core.power(&free);
        assert_eq!((power.supplied, power.dissipated), (0.0, 0.0), "{t}");
    });
}

/// Over a stretch of motion, too: what a fourth-order method leaves of `E − ∫ P dt`, the work as one more state, falls sixteenfold when
/// the step is halved.
#[test]
fn energy_of_a_motion_is_the_work_done_on_it() {
    let options = FlexibleOptions {
        // No fast transmissions, so that a step can be seen to count.
        robot: Options { bodies: 1..=4, elastic: 0.0, remote_mount: 0.0, ..FlexibleOptions::default().robot },
        ..FlexibleOptions::default()
    };
    for_flexible::<f64>(25, &options, &[Fidelity::Rigid], tol(0.0, 0.0), |t| {
        let lost = |steps: usize| {
            let h = 0.02 / steps as f64;
            let (mut s, mut work) = (t.state.clone(), 0.0);
            let balance = |s: &State| {
                let p = t.core.power(s);
                p.supplied - p.dissipated
            };
            let start = t.core.energy(&s);
            for _ in 0..steps {
                let a = (rates(t, &s), balance(&s));
                let at = moved(&s, &a.0, h / 2.0);
                let b = (rates(t, &at), balance(&at));
                let at = moved(&s, &b.0, h / 2.0);
                let c = (rates(t, &at), balance(&at));
                let at = moved(&s, &c.0, h);
                let d = (rates(t, &at), balance(&at));
                for (r, weight) in [(&a, 1.0), (&b, 2.0), (&c, 2.0), (&d, 1.0)] {
                    s = moved(&s, &r.0, weight * h / 6.0);
                    work += r.1 * weight * h / 6.0;
                }
            }
            let end = t.core.energy(&s);
            let change = |f: fn(&gyroflex::dynamics::Energy<f64>) -> f64| f(&end) - f(&start);
            (
                change(|e| e.kinetic) + change(|e| e.gravity) + change(|e| e.elastic) - work,
                start.kinetic + start.elastic,
            )
        };
        let ((coarse, size), (fine, _)) = (lost(100), lost(200));
        assert!(coarse.abs() < 1e-3 * (size + 1.0), "lost {coarse:e} J of {size:e} J; {t}");
        // Down to rounding.
        assert!(fine.abs() < coarse.abs() / 10.0 + 1e-10 * (size + 1.0), "lost {coarse:e} J, then {fine:e} J; {t}");
    });
}
