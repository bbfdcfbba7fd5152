//! Laws of simpler equations: what is kept is a mechanical system, and what is dropped is as small as said.

mod arms;

use arms::{Arm, numbers, options, seeds, shipped};
use gyroflex::model::Fidelity;
use gyroflex_codegen::explicit::{ExplicitModel, Options};
use gyroflex_codegen::function::Function;
use gyroflex_codegen::quantity::{Options as Choices, Quantity, function};
use gyroflex_codegen::weigh::{Motion, Place, rank, simplify};
use gyroflex_testkit::random::Options as Random;
use gyroflex_testkit::tolerance::{assert_close_above, norm};
use gyroflex_testkit::{Dual, State};

fn explicit(arm: &Arm) -> ExplicitModel {
    ExplicitModel::of(&arm.robot(), &Options::default()).expect("nothing in it is not explicit")
}

fn motion(s: &State) -> Motion {
    let [q, qd, theta, thetad, qdd, thetadd] = [&s.q, &s.qd, &s.theta, &s.thetad, &s.qdd, &s.thetadd].map(Clone::clone);
    Motion { q, qd, theta, thetad, qdd, thetadd }
}

fn samples(arm: &Arm, count: u64) -> Vec<Motion> {
    (0..count).map(|k| motion(&arm.state(k))).collect()
}

fn result(f: &Function, name: &str, inputs: &[f64]) -> Vec<f64> {
    let place = f.outputs.iter().position(|o| o.name == name).expect("it is a result");
    f.evaluate(inputs).swap_remove(place)
}

#[test]
fn tolerance_zero_keeps_everything() {
    for seed in seeds(12) {
        let arm = Arm::new(seed, &options(1..=4));
        let whole = explicit(&arm);
        let simplified = simplify(&whole, &samples(&arm, 5), 0.0);
        assert_eq!(simplified.model, whole, "seed {seed}");
        assert_eq!((simplified.report.kept, simplified.report.torque_error()), (simplified.report.terms, 0.0));
        let library = function(&arm.robot(), Quantity::Inverse, &Choices::default()).expect("every robot has it");
        let ours = simplified.model.function(Quantity::Inverse).expect("explicit equations say it");
        let state = arm.state(9);
        let [got, want] = [&ours, &library].map(|f| result(f, "tau", &numbers(f, &state)));
        assert_close_above("torques", &format!("seed {seed}"), &got, &want, 1e-12, 1e-3);
    }
}

#[test]
fn errors_fall_with_the_tolerance() {
    for seed in seeds(8) {
        let arm = Arm::new(seed, &Random { prismatic: 0.0, ..options(3..=5) });
        let (whole, samples) = (explicit(&arm), samples(&arm, 10));
        let mut before = (0, f64::INFINITY);
        for tolerance in [0.1, 1e-2, 1e-3, 1e-4] {
            let report = simplify(&whole, &samples, tolerance).report;
            // No more than all that was dropped together.
            let dropped = report.terms - report.kept;
            assert!(report.torque_error() <= tolerance * dropped as f64, "{report:?}, seed {seed}");
            assert!(report.kept >= before.0, "{report:?} has fewer terms than at a larger tolerance, seed {seed}");
            assert!(
                report.torque_error() <= 2.0 * before.1,
                "{report:?} is worse than at a larger tolerance, seed {seed}"
            );
            before = (report.kept, report.torque_error());
        }
        assert!(before.1 < 1e-2, "an error of {} of what weighs 1e-4, seed {seed}", before.1);
    }
}

#[test]
fn reported_torque_error_is_that_of_the_functions() {
    for seed in seeds(24) {
        // Springs and dampers are not in inverse dynamics.
        let random = Random { prismatic: 0.0, damping: 0.0, cubic: 0.0, ..options(3..=4) };
        let arm = Arm::new(seed, &random);
        let whole = explicit(&arm);
        let simplified = simplify(&whole, &samples(&arm, 6), 0.02);
        let [full, simple] =
            [&whole, &simplified.model].map(|m| m.function(Quantity::Inverse).expect("explicit equations say it"));
        let n = whole.nv();
        let (mut error, mut scale) = (vec![0.0_f64; 2 * n], vec![0.0_f64; 2 * n]);
        for k in 0..6 {
            let state = arm.state(k);
            let of_links = if whole.is_elastic() { "tau_j" } else { "tau" };
            let value = |f: &Function, name: &str| result(f, name, &numbers(f, &state));
            let [[want, all], [got, rest]] = [&full, &simple].map(|f| [value(f, of_links), value(f, "tau")]);
            for i in 0..n {
                error[i] = error[i].max((got[i] - want[i]).abs());
                scale[i] = scale[i].max(want[i].abs());
                // What is left of a motor's torque is its own equation.
                error[n + i] = error[n + i].max((rest[i] - got[i] - all[i] + want[i]).abs());
                scale[n + i] = scale[n + i].max(all[i].abs());
            }
        }
        for i in 0..2 * n {
            let reported = simplified.report.torque_errors[i] * scale[i];
            let context = format!("equation {i}, seed {seed}");
            assert_close_above("the error", &context, &[reported], &[error[i]], 1e-9, 1e-3 * scale[i]);
        }
    }
}

#[test]
fn reported_acceleration_errors_are_those_of_the_functions() {
    for seed in seeds(40) {
        let arm = Arm::new(seed, &Random { prismatic: 0.0, ..options(2..=4) });
        let whole = explicit(&arm);
        let (state, n) = (arm.state(4), whole.nv());
        let value = |model: &ExplicitModel| {
            let f = model.function(Quantity::Forward).expect("explicit equations say it");
            let qdd = result(&f, "qdd", &numbers(&f, &state));
            let thetadd = if model.is_elastic() { result(&f, "thetadd", &numbers(&f, &state)) } else { qdd.clone() };
            [qdd, thetadd]
        };
        let [qdd, thetadd] = value(&whole);
        let at = Motion { qdd, thetadd, ..motion(&state) };
        let tolerance = [0.03, 0.3][seed as usize / 4 % 2];
        let simplified = simplify(&whole, std::slice::from_ref(&at), tolerance);
        let [qdd, thetadd] = value(&simplified.model);
        for i in 0..n {
            let elastic = whole.transmission(i).is_some();
            for (got, want, equation) in [(&qdd, &at.qdd, i), (&thetadd, &at.thetadd, n + i)] {
                if equation >= n && !elastic {
                    continue;
                }
                let reported = simplified.report.acceleration_errors[equation] * want[i].abs();
                let context = format!("equation {equation}, seed {seed}");
                let size = norm(&[norm(&at.qdd), norm(&at.thetadd)]);
                assert_close_above("the error", &context, &[reported], &[(got[i] - want[i]).abs()], 1e-7, 1e-3 * size);
            }
        }
    }
}

#[test]
fn reduced_inertia_is_symmetric_and_positive_definite() {
    for seed in seeds(12) {
        let arm = Arm::new(seed, &options(2..=5));
        let (whole, samples) = (explicit(&arm), samples(&arm, 6));
        let simpler = simplify(&whole, &samples, 0.2).model;
        let f = simpler.function(Quantity::Forward).expect("explicit equations say it");
        let m = simpler.function(Quantity::MassMatrix).expect("explicit equations say it");
        let n = simpler.nv();
        for k in 0..6 {
            let state = arm.state(k);
            let m = result(&m, "m", &numbers(&m, &state));
            for i in 0..n {
                assert!((0..i).all(|j| m[i * n + j] == m[j * n + i]), "seed {seed}");
            }
            let spin: Vec<f64> = (0..n).map(|i| (i as f64 + seed as f64).sin()).collect();
            let twice: f64 = (0..n * n).map(|at| m[at] * spin[at / n] * spin[at % n]).sum();
            assert!(twice > 0.0, "seed {seed}, state {k}");
            assert!(result(&f, "qdd", &numbers(&f, &state)).iter().all(|x| x.is_finite()), "seed {seed}, state {k}");
        }
    }
}

/// `dE/dt` of the energies of a model along its own forward dynamics, and the power of what acts on it.
fn power_balance(arm: &Arm, model: &ExplicitModel, state: &State) -> [f64; 3] {
    let forward = model.function(Quantity::Forward).expect("explicit equations say it");
    let energy = model.function(Quantity::Energy).expect("explicit equations say it");
    let qdd = result(&forward, "qdd", &numbers(&forward, state));
    let elastic = model.is_elastic();
    let thetadd = if elastic { result(&forward, "thetadd", &numbers(&forward, state)) } else { qdd.clone() };
    let dual =
        |x: &[f64], slope: &[f64]| -> Vec<Dual> { x.iter().zip(slope).map(|(x, s)| Dual::new(*x, *s)).collect() };
    let mut inputs = [dual(&state.q, &state.qd), dual(&state.qd, &qdd)].concat();
    if elastic {
        inputs.extend([dual(&state.theta, &state.thetad), dual(&state.thetad, &thetadd)].concat());
    }
    let parts: Vec<f64> = energy.evaluate(&inputs).iter().map(|e| e[0].slope).collect();
    let mut supplied = 0.0;
    let mut size = norm(&parts);
    for i in 0..model.nv() {
        let speed = if model.transmission(i).is_some() { state.thetad[i] } else { state.qd[i] };
        supplied += state.tau[i] * speed;
        size = size.max((state.tau[i] * speed).abs());
    }
    let _ = arm;
    [parts.iter().sum(), supplied, size]
}

#[test]
fn reduced_energy_balance_closes() {
    for seed in seeds(20) {
        let arm = Arm::new(seed, &options(1..=4).lossless());
        let whole = explicit(&arm);
        for tolerance in [0.0, 0.05, 0.3] {
            let simpler = simplify(&whole, &samples(&arm, 4), tolerance).model;
            let [rate, supplied, size] = power_balance(&arm, &simpler, &arm.state(2));
            let context = format!("tolerance {tolerance}, seed {seed}");
            assert_close_above("power", &context, &[rate], &[supplied], 1e-10, size);
        }
    }
}

#[test]
fn reduced_energy_balance_closes_where_links_bend() {
    for seed in seeds(6) {
        let mut arm = Arm::bending(seed);
        // Friction and dampers take no part in the law.
        while arm.random.bodies.iter().any(|b| b.friction.viscous != 0.0 || b.drive.is_some()) {
            arm = Arm::bending(arm.seed + 100);
        }
        let mut whole = explicit(&arm);
        let n = whole.modes();
        whole = whole.with_modal_damping(vec![0.0; n * n]);
        let mut state = arms::at(&arm, 1, 0.002);
        state.tau[arm.random.bodies.len()..].fill(0.0);
        let motions = [motion(&state)];
        for tolerance in [0.0, 0.1] {
            let simpler = simplify(&whole, &motions, tolerance).model;
            let [rate, supplied, size] = power_balance(&arm, &simpler, &state);
            let context = format!("tolerance {tolerance}, seed {}", arm.seed);
            assert_close_above("power", &context, &[rate], &[supplied], 1e-10, size);
        }
    }
}

#[test]
fn light_rotors_leave_the_reduced_model() {
    let (light, tolerance) = (1e-7, 1e-4);
    let arm = shipped::puma560(Fidelity::Complete, light);
    let (whole, motion) = (explicit(&arm), shipped::waves(&arm, 25));
    assert!(whole.is_coupled());
    let simplified = simplify(&whole, &motion, tolerance);
    assert!(simplified.report.uncoupled && !simplified.model.is_coupled(), "{:?}", simplified.report);
    // Spong's model of that robot, along the motion and under the torques that it takes.
    let spong = shipped::puma560(Fidelity::Reduced, light);
    let of_spong = |quantity| function(&spong.robot(), quantity, &Choices::default()).expect("every robot has it");
    let ours = |quantity| simplified.model.function(quantity).expect("explicit equations say it");
    let (inverse, forward) = (
        [ours(Quantity::Inverse), of_spong(Quantity::Inverse)],
        [ours(Quantity::Forward), of_spong(Quantity::Forward)],
    );
    let [mut error, mut scale, mut slip, mut speed] = [[0.0_f64; 6]; 4];
    for at in &motion {
        let inputs = [&at.q[..], &at.qd, &at.theta, &at.thetad, &at.qdd, &at.thetadd].concat();
        let [got, want] = inverse.each_ref().map(|f| result(f, "tau", &inputs));
        let tau_j = result(&inverse[1], "tau_j", &inputs);
        let stiffness = |i: usize| whole.transmission(i).map_or(1.0, |t| t.stiffness.value(whole.layout(), &at.q));
        let theta: Vec<f64> = (0..6).map(|i| at.q[i] + tau_j[i] / stiffness(i)).collect();
        let inputs = [&at.q[..], &at.qd, &theta, &at.thetad, &want].concat();
        let [qdd, asked] = forward.each_ref().map(|f| result(f, "qdd", &inputs));
        for i in 0..6 {
            error[i] = error[i].max((got[i] - want[i]).abs());
            scale[i] = scale[i].max(want[i].abs());
            slip[i] = slip[i].max((qdd[i] - asked[i]).abs());
            speed[i] = speed[i].max(asked[i].abs());
        }
    }
    let dropped = (simplified.report.terms - simplified.report.kept) as f64;
    for i in 0..6 {
        assert!(error[i] <= tolerance * dropped * scale[i], "torque {i}: {} of {}", error[i], scale[i]);
        let most = 1.1 * simplified.report.acceleration_error() + 1e-9;
        assert!(slip[i] <= most * speed[i], "acceleration {i}: {} of {}, reported {most}", slip[i], speed[i]);
    }
}

#[test]
fn the_largest_weight_is_first_and_what_does_nothing_weighs_nothing() {
    let arm = shipped::planar_2r(Fidelity::Complete);
    let model = explicit(&arm);
    let weights = rank(&model, &shipped::waves(&arm, 20));
    assert!(weights.is_sorted_by(|a, b| a.contribution >= b.contribution));
    // At rest nothing but gravity weighs.
    let rest = Motion {
        q: vec![0.3, -0.4],
        qd: vec![0.0; 2],
        theta: vec![0.3, -0.4],
        thetad: vec![0.0; 2],
        qdd: vec![0.0; 2],
        thetadd: vec![0.0; 2],
    };
    for weight in rank(&model, &[rest]) {
        assert_eq!(weight.contribution > 0.0, weight.place == Place::Potential, "{weight:?}");
    }
}
