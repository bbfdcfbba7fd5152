//! Laws of motion in time.

use crate::arms::{EI, LENGTH, MASS_PER_LENGTH, beam, run, scenario, tree};
use crate::assert_close;
use gyroflex_sim::inverse::InverseRun;
use gyroflex_sim::record::{MemoryRecorder, Table};
use gyroflex_sim::zeros::{InverseOutput, Verdict};
use std::ops::ControlFlow;

const SWING: &str = "duration: 0.4\ninitial: {q: {shoulder: 0.4, elbow: -0.5}, qd: {shoulder: 1.0, elbow: -2.0}, \
    eta: {upper.bending_y1: 0.004, lower.bending_z1: -0.003}, etad: {upper.torsion1: 0.2}}\nlog: {rate: 1000}\n";

/// The energy after every sample, and the work done on the robot up to there by Simpson's rule over pairs of samples.
fn balance(table: &Table) -> (f64, f64) {
    let column = |name: &str| table.get(name).unwrap();
    let (kinetic, gravity, elastic) = (column("kinetic_energy"), column("gravity_energy"), column("elastic_energy"));
    let energy = |i: usize| kinetic[i] + gravity[i] + elastic[i];
    let power: Vec<f64> = column("power_in").iter().zip(column("dissipation")).map(|(a, b)| a - b).collect();
    let time = column("time");
    let last = (table.len() - 1) / 2 * 2;
    let work: f64 = (0..last)
        .step_by(2)
        .map(|i| (time[i + 2] - time[i]) / 6.0 * (power[i] + 4.0 * power[i + 1] + power[i + 2]))
        .sum();
    (energy(last) - energy(0), work)
}

#[test]
fn lossless_links_keep_their_energy() {
    for model in ["complete", "rigid"] {
        let robot = tree(model, 0.0, false);
        let (summary, ..) = run(&robot, &format!("{SWING}integrator: {{method: rk4, step: 1e-5}}\n"));
        let drift = summary.energy_drift.expect("nothing drives or damps it");
        assert!(drift < 1e-7, "{model}: {drift}");
    }
}

#[test]
fn what_dampers_and_motors_do_is_what_the_energy_changes_by() {
    let robot = tree("complete", 0.03, false);
    let drive = "controller: {type: pd, rate: 500, kp: 30, kd: 1}\nreference: {shoulder: {type: hold, at: 0.1}}\n";
    let swing = SWING.replace("duration: 0.4", "duration: 0.1").replace("rate: 1000", "rate: 20000");
    let (_, table, _) = run(&robot, &format!("{swing}{drive}integrator: {{method: rk4, step: 1e-5}}\n"));
    let (gained, work) = balance(&table);
    assert!(work.abs() > 0.1, "something happens: {work}");
    assert!((gained - work).abs() < 2e-3 * work.abs(), "{gained} {work}");
}

#[test]
fn schemes_agree_on_links_that_bend() {
    let robot = tree("complete", 0.02, false);
    let end = |integrator: &str| {
        let (_, _, simulation) =
            run(&robot, &format!("{SWING}integrator: {integrator}\n").replace("0.4\ninitial", "0.05\ninitial"));
        let state = simulation.state();
        [state.q.clone(), state.qd.clone(), state.theta.clone()].concat()
    };
    let exact = end("{method: rk4, step: 5e-6}");
    for (integrator, tolerance) in [
        ("{method: dop853, rtol: 1e-10, atol: 1e-12}", 1e-7),
        ("{method: kvaerno5, rtol: 1e-9, atol: 1e-11}", 1e-6),
        ("{method: rk4, step: 2e-5}", 1e-6),
        ("{method: semi_implicit_euler, step: 1e-6}", 2e-3),
    ] {
        assert_close(integrator, &end(integrator), &exact, tolerance);
    }
}

#[test]
fn a_floating_arm_keeps_its_energy_too() {
    let robot = tree("complete", 0.0, true);
    let (summary, ..) = run(
        &robot,
        &format!("{SWING}integrator: {{method: rk4, step: 1e-5}}\n").replace("0.4\ninitial", "0.1\ninitial"),
    );
    assert!(summary.energy_drift.unwrap() < 1e-7, "{:?}", summary.energy_drift);
}

const REACH: &str = "duration: 0.6\nreference:\n  shoulder: {type: polynomial, from: 0.2, to: 0.9, start: 0, duration: 0.5, order: 3}\n  \
    elbow: {type: polynomial, from: -0.4, to: 0.5, start: 0, duration: 0.5, order: 3}\n  slide: {type: hold, at: 0.05}\nlog: {rate: 5000}\n";

fn invert(robot: &gyroflex_sim::Robot, text: &str) -> (Table, InverseRun, Vec<String>) {
    let mut inverse =
        InverseRun::new(robot, &scenario(text), None, 0.0, InverseOutput::Link).expect("it can be inverted");
    let mut recorder = MemoryRecorder::new(inverse.run_info());
    let summary = inverse.run(&mut recorder, &mut |_| ControlFlow::Continue(())).expect("it runs");
    let named = summary.warnings.clone();
    assert_eq!(summary.stability.verdict, if named.is_empty() { Verdict::Stable } else { Verdict::Undamped });
    (recorder.table(), inverse, named)
}

#[test]
fn torques_of_the_inverse_move_the_joints_as_asked_and_bend_the_links_as_they_do() {
    let robot = tree("rigid", 0.02, false);
    let (table, ..) = invert(&robot, REACH);
    let column = |name: &str| table.get(name).unwrap();
    // Joints are on their references, and accelerate along them: differences of the recorded velocities.
    assert_close("shoulder", column("q.shoulder"), column("reference.shoulder"), 1e-12);
    for (rate, acceleration) in [
        ("qd.elbow", "qdd.elbow"),
        ("qd.shoulder", "qdd.shoulder"),
        ("etad.upper.bending_z1", "etadd.upper.bending_z1"),
        ("etad.lower.bending_y1", "etadd.lower.bending_y1"),
        ("eta.upper.bending_z1", "etad.upper.bending_z1"),
    ] {
        let (v, a, t) = (column(rate), column(acceleration), column("time"));
        let slopes: Vec<f64> = (2..v.len() - 2)
            .map(|i| (8.0 * (v[i + 1] - v[i - 1]) - (v[i + 2] - v[i - 2])) / (6.0 * (t[i + 1] - t[i - 1])))
            .collect();
        assert_close(rate, &slopes, &a[2..a.len() - 2], 2e-3);
    }
    let (gained, work) = balance(&table);
    assert!((gained - work).abs() < 1e-4 * work.abs(), "{gained} {work}");
    let sideways = column("tip.lower.y").iter().chain(column("tip.lower.z"));
    let bent = sideways.fold(0.0, |most: f64, x| most.max(x.abs()));
    assert!(bent > 1e-3, "the links bend: {bent}");
}

#[test]
fn an_open_loop_under_the_inverse_follows_the_reference() {
    // The torques as a reference-free motion: the run repeats what the inverse found, up to the sampling of its torques.
    let robot = tree("rigid", 0.05, false);
    let text = REACH.replace("5000", "20000").replace("duration: 0.6", "duration: 0.2");
    let (table, ..) = invert(&robot, &text);
    let tau: Vec<&[f64]> = ["tau.shoulder", "tau.elbow", "tau.slide"].map(|n| table.get(n).unwrap()).to_vec();
    let mut dynamics = gyroflex_sim::Dynamics::new(robot.model(robot.fidelity).unwrap());
    let names: Vec<String> =
        gyroflex_sim::coordinates::Coordinates::of(&robot).names().map(|n| format!("q.{n}")).collect();
    let all: Vec<String> = names.into_iter().chain(robot.mode_names().iter().map(|m| format!("eta.{m}"))).collect();
    let start = |i: usize| -> Vec<f64> { all.iter().map(|n| table.get(n).unwrap()[i]).collect() };
    let n = all.len();
    let mut state = gyroflex_sim::simulate::StateVec { q: start(0), ..gyroflex_sim::simulate::StateVec::zeros(0, n) };
    state.theta = state.q.clone();
    let time = table.get("time").unwrap();
    for i in 0..time.len() - 1 {
        let mut now = vec![0.0; n];
        (0..3).for_each(|k| now[k] = 0.5 * (tau[k][i] + tau[k][i + 1]));
        dynamics.rk4(state.view_mut(), &now, gyroflex::dynamics::External::none(), time[i + 1] - time[i]).unwrap();
    }
    assert_close("end", &state.q, &start(time.len() - 1), 1e-5);
}

#[test]
fn links_without_damping_are_said_to_swing_on() {
    let (_, inverse, warnings) = invert(&tree("rigid", 0.0, false), REACH);
    assert!(
        warnings[0].contains("swings on without damping") && warnings[0].contains("give the links damping"),
        "{warnings:?}"
    );
    assert!(inverse.run_info().modes.contains(&"lower.bending_z1".to_owned()));
}

#[test]
fn a_shaper_takes_its_modes_from_links_that_bend() {
    let robot =
        beam(2, "", [0.0; 3], "drives:\n  hinge: {rotor: {inertia: 0.01}, gear_ratio: 10, transmission: rigid}\n");
    let text = "duration: 0.5\nreference: {hinge: {type: polynomial, from: 0, to: 0.3, start: 0, duration: 0.2, order: 3}}\n\
        controller: {type: pd, rate: 1000, kp: 400, kd: 40}\nshaper: {type: zv, modes: linearized}\nlog: {rate: 100}\n\
        integrator: {method: rk4, step: 5e-5}\n";
    let simulation = gyroflex_sim::Simulation::new(&robot, &scenario(text)).expect("it can be shaped");
    let impulses = simulation.references().shaper().impulses().to_vec();
    // The motor is held: half a period of the cantilever.
    let period = std::f64::consts::TAU / (1.875104_f64.powi(2) * (EI / (MASS_PER_LENGTH * LENGTH.powi(4))).sqrt());
    assert_close("delay", &[impulses[1].delay], &[0.5 * period], 1e-4);
}
