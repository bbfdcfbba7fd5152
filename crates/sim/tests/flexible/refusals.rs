//! What links that bend are refused, and in which words.

use crate::arms::{beam, scenario, tree};
use gyroflex_sim::error::Error;
use gyroflex_sim::eval::{Evaluator, Options};
use gyroflex_sim::inverse::{InverseModel, InverseRun};
use gyroflex_sim::linearize::{KeptFriction, Linearizer};
use gyroflex_sim::zeros::InverseOutput;
use gyroflex_sim::{Fidelity, Simulation, bench, export};
use std::ops::ControlFlow;

fn words(e: &Error, parts: &[&str]) {
    let text = e.to_string();
    for part in parts {
        assert!(text.contains(part), "`{part}` is missing in: {text}");
    }
    assert!(text.contains("remedy: "), "{text}");
}

fn refused(text: &str, parts: &[&str]) {
    let e = Simulation::new(&tree("complete", 0.0, false), &scenario(text)).map(|_| ()).expect_err("it is refused");
    words(&e, parts);
}

#[test]
fn a_step_too_long_for_a_mode_names_the_mode_and_the_step_that_works() {
    let drives = "drives:\n  hinge: {rotor: {inertia: 1.0e+6}, gear_ratio: 1, transmission: rigid}\n";
    let robot = beam(3, "", [0.0; 3], drives);
    let text = "duration: 0.1\nintegrator: {method: rk4, step: 1e-2}\nlog: {rate: 100}\n";
    let e = Simulation::new(&robot, &scenario(text)).map(|_| ()).expect_err("it is refused");
    words(
        &e,
        &["scenario.yaml:3: integrator.step", "at mode `beam.bending_y3`", "the largest usable step is", "kvaerno5"],
    );
    let step = e.remedy.split("step is ").nth(1).unwrap().split(' ').next().unwrap().to_owned();
    Simulation::new(&robot, &scenario(&text.replace("1e-2", &step))).expect("that step works");
}

#[test]
fn unknown_modes_are_named_with_the_nearest_known_one() {
    refused(
        "duration: 1\ninitial: {eta: {upper.bendingy1: 0.1}}\n",
        &["initial.eta.upper.bendingy1", "did you mean `upper.bending_y1`?"],
    );
    refused(
        "duration: 1\ninitial: {etad: [1, 2]}\n",
        &["initial.etad", "2 entries", "upper.bending_y1, upper.bending_y2"],
    );
    let rigid = tree("complete", 0.0, false).with_rigid_links();
    let e = Simulation::new(&rigid, &scenario("duration: 1\ninitial: {eta: {upper.bending_y1: 0.1}}\n"))
        .map(|_| ())
        .unwrap_err();
    words(&e, &["no link of the robot bends"]);
}

#[test]
fn controllers_that_know_no_bending_are_refused_by_name() {
    let flatness = "duration: 1\ncontroller: {type: feedback_linearization, rate: 1000, bandwidth: 10}\n";
    refused(flatness, &["flexible_links.upper", "feedback_linearization", "use `pd` or `computed_torque`"]);
    let two = "duration: 1\ncontroller: {type: two_degree_of_freedom, rate: 1000, kp: 1, kd: 1}\n";
    refused(two, &["flexible_links.upper", "two_degree_of_freedom"]);
}

#[test]
fn ground_is_refused() {
    refused("duration: 1\nground: {friction: 0.5}\n", &["flexible_links.upper", "holds a robot", "`ground`"]);
}

#[test]
fn wrenches_on_a_bending_link_need_a_place_that_carries_them() {
    let text = "duration: 1\nwrenches: [{link: upper, force: [0, 0, 1], point: [0.4, 0, 0]}]\n";
    refused(text, &["wrenches[0].point", "link `upper` bends", "name a link that a fixed joint holds"]);
}

#[test]
fn the_inverse_of_elastic_joints_is_refused_and_that_of_rigid_gears_is_not() {
    let robot = tree("complete", 0.0, false);
    let file = scenario("duration: 1\n");
    let parts = ["flexible_links.upper", "the inverse of elastic joints", "the model `rigid`"];
    let e = InverseRun::new(&robot, &file, None, 0.0, InverseOutput::Link).map(|_| ()).unwrap_err();
    words(&e, &parts);
    words(&InverseModel::new(&robot, robot.fidelity, 0).map(|_| ()).unwrap_err(), &parts);
    InverseRun::new(&robot, &file, Some(Fidelity::Rigid), 0.0, InverseOutput::Link).expect("gears are rigid there");
}

#[test]
fn what_has_no_version_for_bending_links_says_so() {
    let robot = tree("complete", 0.0, false);
    let link = "flexible_links.upper: the link bends";
    let significance = Options { significance: true, ..Options::default() };
    words(&Evaluator::new(robot.clone(), significance).map(|_| ()).unwrap_err(), &[link, "significance"]);
    words(
        &export::rust(&robot, robot.fidelity, export::Precision::Double).map(|_| ()).unwrap_err(),
        &[link, "exported code"],
    );
    let none = &mut |_| ControlFlow::Continue(());
    words(&bench::bench(&robot, &[robot.fidelity], 10, none).map(|_| ()).unwrap_err(), &[link, "`bench`"]);
    let mut linearizer = Linearizer::new(&robot, robot.fidelity, KeptFriction::All).unwrap();
    let torques = linearizer.equilibrium_for(&[0.0; 9], &[0.0; 3]).map(|_| ()).unwrap_err();
    words(&torques, &[link, "give the pose itself"]);
}
