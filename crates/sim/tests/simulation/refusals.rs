//! What is refused before a run, and with which words.

use crate::arm::{arm, flying_arm, linear, scenario, with_drives, with_transmissions};
use gyroflex::model::{Friction, TransmissionError};
use gyroflex_sim::{Error, ErrorKind, Robot, Simulation};

fn refused(robot: &Robot, yaml: &str) -> Error {
    let error = Simulation::new(robot, &scenario(yaml)).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Scenario, "{error}");
    assert!(error.file.starts_with("test.yaml") && !error.remedy.is_empty(), "{error}");
    error
}

#[test]
fn too_large_step_is_refused_before_the_run() {
    let stiff = with_transmissions(arm(3), linear(1e7), 0.0, TransmissionError::none());
    for method in ["rk4", "semi_implicit_euler"] {
        let yaml =
            |step: &str| format!("duration: 1\nlog: {{rate: 10}}\nintegrator: {{method: {method}, step: {step}}}");
        let error = refused(&stiff, &yaml("1e-3"));
        assert!(error.problem.contains("Hz at joint"), "{error}");
        // The remedy names a step that works.
        let usable = error.remedy.split(' ').find_map(|w| w.parse::<f64>().ok()).unwrap();
        assert!(Simulation::new(&stiff, &scenario(&yaml(&usable.to_string()))).is_ok(), "{usable}");
        assert!(Simulation::new(&stiff, &scenario(&yaml(&(1.02 * usable).to_string()))).is_err(), "{usable}");
    }
    assert!(Simulation::new(&stiff, &scenario("duration: 1\nintegrator: {method: kvaerno5}")).is_ok());
}

#[test]
fn dry_friction_at_standstill_counts_as_fast() {
    let dry = with_drives(arm(2), |d| d.friction = Friction::coulomb(0.0, 0.1, 0.01));
    let error = refused(&dry, "duration: 1\nintegrator: {method: rk4, step: 1e-3}");
    assert!(error.problem.contains("friction at standstill"), "{error}");
    assert!(error.remedy.contains("largest usable step"), "{error}");
}

#[test]
fn steps_cut_by_ticks_are_judged_as_they_are_taken() {
    let yaml = |rate: u32| format!("duration: 1\nlog: {{rate: {rate}}}\nintegrator: {{method: rk4, step: 1}}");
    assert!(Simulation::new(&arm(2), &scenario(&yaml(1000))).is_ok());
    refused(&arm(2), &yaml(1));
}

#[test]
fn unknown_names_are_refused_with_the_nearest_known_one() {
    let cases = [
        ("initial: {q: {jiont2: 0.1}}", "joint2"),
        ("initial: {theta: {joint22: 0.1}}", "joint2"),
        ("reference: {joitn1: {type: hold}}", "joint1"),
        ("wrenches: [{link: lnik1}]", "link1"),
    ];
    for (yaml, near) in cases {
        let error = refused(&arm(2), &format!("duration: 1\n{yaml}"));
        assert!(error.remedy.contains(&format!("`{near}`")), "{error}");
        assert_eq!(error.file, "test.yaml:3");
    }
}

#[test]
fn entries_that_cannot_act_are_refused() {
    let cases = [
        ("initial: {q: [0.1]}", "1 entries"),
        ("initial: {base: {xyz: [0, 0, 1]}}", "root is fixed"),
        ("wrenches: [{link: base, force: [1, 0, 0]}]", "fixed to the world"),
        ("model: rigid\ninitial: {theta: {joint1: 0.1}}", "no elastic transmission"),
    ];
    for (yaml, words) in cases {
        let error = refused(&arm(2), &format!("duration: 1\n{yaml}"));
        assert!(error.problem.contains(words), "{error}");
    }
    assert!(Simulation::new(&flying_arm(2), &scenario("duration: 1\ninitial: {base: {xyz: [0, 0, 1]}}")).is_ok());
}

#[test]
fn wrench_that_never_acts_is_reported() {
    for wrench in [
        "{link: link1, force: [1, 0, 0], start: 2}",
        "{link: link1}",
        "{link: link1, force: [1, 0, 0], start: -2, end: -1}",
    ] {
        let simulation = Simulation::new(&arm(1), &scenario(&format!("duration: 1\nwrenches: [{wrench}]"))).unwrap();
        assert!(simulation.warnings().iter().any(|w| w.message.contains("never acts")), "{wrench}");
    }
}
