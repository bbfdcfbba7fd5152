//! What is refused, and with which words.

use crate::robots::{joint, link, point, scenario, table, try_robot};
use gyroflex_sim::{Error, Robot, Simulation};

const FEET: [[f64; 3]; 3] = [[-0.3, -0.2, -0.4], [-0.3, 0.2, -0.4], [0.3, 0.0, -0.4]];

#[track_caller]
fn says(error: &Error, words: &[&str]) {
    let text = error.to_string();
    assert!(!error.remedy.is_empty(), "{text}");
    for word in words {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
}

#[track_caller]
fn refused(robot: &Robot, yaml: &str, words: &[&str]) {
    says(&Simulation::new(robot, &scenario(yaml)).expect_err("it is refused"), words);
}

#[test]
fn contact_below_the_ground_is_named_with_its_depth() {
    refused(&table(&FEET, ""), "duration: 1\nground: {friction: 0.5}\ninitial: {base: {xyz: [0, 0, 0.37]}}", &["foot0", "0.03", "below"]);
}

#[test]
fn ground_without_contact_points_is_refused() {
    let urdf = format!("<robot name=\"r\"><link name=\"w\"/>{}{}</robot>", joint("j", "revolute", ["w", "a"], [0.0; 3], "0 1 0"), link("a", 1.0, [0.1, 0.0, 0.0], 0.01));
    let robot = try_robot(&urdf, "").unwrap();
    refused(&robot, "duration: 1\nground: {friction: 0.5}", &["ground", "contacts"]);
}

#[test]
fn other_integrators_are_refused() {
    for method in ["{method: dopri5}", "{method: kvaerno5}", "{method: semi_implicit_euler, step: 1e-3}"] {
        refused(&point(), &format!("duration: 1\nground: {{friction: 0.5}}\ninitial: {{q: {{z: 1}}}}\nintegrator: {method}"), &["integrator", "rk4"]);
    }
}

#[test]
fn numbers_of_the_ground_are_checked() {
    for (ground, word) in [("{friction: -1}", "friction"), ("{friction: 0.5, restitution: 1.5}", "restitution"), ("{friction: 0.5, height: .nan}", "height")] {
        let text = format!("robot: r.yaml\nduration: 1\nground: {ground}");
        let error = gyroflex_sim::ScenarioFile::parse(&text, "test.yaml".as_ref()).expect_err("it is refused");
        says(&error, &[word]);
    }
}

fn arm(yaml: &str) -> Result<Robot, Error> {
    let urdf = [
        "<robot name=\"r\"><link name=\"base\"/>".to_owned(),
        joint("one", "revolute", ["base", "a"], [0.0; 3], "0 1 0"),
        link("a", 1.0, [0.25, 0.0, 0.0], 0.02),
        joint("two", "revolute", ["a", "b"], [0.5, 0.0, 0.0], "0 1 0"),
        link("b", 1.0, [0.25, 0.0, 0.0], 0.02),
        "</robot>".to_owned(),
    ];
    try_robot(&urdf.concat(), yaml)
}

#[test]
fn unknown_names_are_refused_with_the_nearest_known_one() {
    let cases = [
        ("contacts: {tip: {link: bb}}", "contacts.tip", "`b`"),
        ("constraints: {end: {link: aa, directions: point}}", "constraints.end", "`a`"),
        ("constraints: {end: {link: a, to: {link: bbb}, directions: point}}", "constraints.end.to", "`b`"),
        ("couplings: {pair: {joint: onee, follows: two, ratio: 1}}", "couplings.pair.joint", "`one`"),
        ("couplings: {pair: {joint: one, follows: tow, ratio: 1}}", "couplings.pair.follows", "`two`"),
    ];
    for (yaml, key, near) in cases {
        says(&arm(yaml).expect_err(yaml), &["robot.yaml:2", key, near]);
    }
}

#[test]
fn constraints_that_make_no_sense_are_refused() {
    let cases = [
        ("constraints: {end: {link: b, directions: []}}", "directions"),
        ("constraints: {end: {link: b, directions: [x, w]}}", "directions"),
        ("constraints: {end: {link: b, to: {link: b}, directions: point}}", "constraints.end"),
        ("constraints: {end: {link: b, directions: point, stabilisation: -1}}", "stabilisation"),
        ("constraints: {end: {link: base, directions: point}}", "base"),
        ("constraints: {end: {link: b, directions: point, damping: 1}}", "damping"),
        ("couplings: {pair: {joint: one, follows: one, ratio: 1}}", "itself"),
        ("couplings: {pair: {joint: one, follows: two, ratio: 1, stabilisation: -2}}", "stabilisation"),
        ("contacts: {tip: {link: base}}", "does not move"),
    ];
    for (yaml, word) in cases {
        says(&arm(yaml).expect_err(yaml), &[word, "robot.yaml"]);
    }
}

#[test]
fn constraint_that_the_first_state_misses_is_named() {
    let robot = arm("constraints: {end: {link: b, xyz: [0.5, 0, 0], to: {xyz: [0.9, 0, 0]}, directions: planar_point}}").unwrap();
    refused(&robot, "duration: 1", &["`end`", "0.1", "initial"]);
}

#[test]
fn constraints_that_contradict_each_other_are_refused() {
    // A joint that must turn against itself.
    let robot = arm("couplings:\n  same: {joint: two, follows: one, ratio: 1}\n  other: {joint: two, follows: one, ratio: -1}\nconstraints: {end: {link: a, xyz: [0.5, 0, 0], to: {xyz: [0.5, 0, 0]}, directions: planar_point}}").unwrap();
    let simulation = Simulation::new(&robot, &scenario("duration: 1")).unwrap();
    assert!(simulation.warnings().iter().any(|w| w.message.contains("depend on others")), "{:?}", simulation.warnings());
}

#[test]
fn held_twice_is_reported_not_refused() {
    let end = "{link: b, xyz: [0.5, 0, 0], to: {xyz: [1, 0, 0]}, directions: [z]}";
    let robot = arm(&format!("constraints: {{end: {end}, again: {end}}}")).unwrap();
    let simulation = Simulation::new(&robot, &scenario("duration: 0.1")).unwrap();
    assert!(simulation.warnings().iter().any(|w| w.message.contains("depend on others")), "{:?}", simulation.warnings());
}
