//! What is refused, and with which words.

use crate::machines::{inertial, mass, mass_urdf, planar, scenario, try_load};
use gyroflex_sim::{Error, Robot, Simulation};

fn refused(robot: &Robot, yaml: &str) -> Error {
    let yaml = format!("duration: 0.1\n{yaml}");
    let error = Simulation::new(robot, &scenario(&yaml)).expect_err("this must be refused");
    assert!(!error.remedy.is_empty() && error.file.starts_with("test.yaml"), "{error}");
    error
}

#[track_caller]
fn says(error: &Error, words: &[&str]) {
    let text = error.to_string();
    assert!(words.iter().all(|w| text.contains(w)), "{text}");
}

const RK4: &str = "integrator: {method: rk4, step: 1e-3}";

#[test]
fn contact_below_the_ground_is_refused_with_its_depth() {
    let yaml = format!("initial: {{q: {{z: -0.25}}}}\nground: {{friction: 0.5}}\n{RK4}");
    says(&refused(&mass(), &yaml), &["initial", "`foot`", "0.25", "raise the robot"]);
}

#[test]
fn ground_needs_contacts() {
    let robot = try_load(&mass_urdf(), "").unwrap_or_else(|e| panic!("{e}"));
    says(&refused(&robot, &format!("ground: {{friction: 0.5}}\n{RK4}")), &["ground", "no points", "`contacts`"]);
}

#[test]
fn adaptive_steps_cannot_hold_a_robot() {
    says(
        &refused(&mass(), "ground: {friction: 0.5}\nintegrator: {method: dopri5}"),
        &["integrator.method", "`dopri5`", "`rk4`"],
    );
}

fn pinned(constraints: &str) -> Robot {
    planar(inertial(1.0, 0.0, 0.0, 0.02), &format!("constraints:\n{constraints}"))
}

#[test]
fn start_that_misses_a_constraint_is_refused() {
    let robot = pinned("  pin: {link: pitch_link, directions: planar_point}\n");
    says(&refused(&robot, &format!("initial: {{q: {{x: 0.3}}}}\n{RK4}")), &["`pin`", "0.3", "`initial`"]);
}

/// Two pins for one point, less than a millimetre apart: each is kept to the tolerance of a start, but not both.
#[test]
fn constraints_that_contradict_each_other_are_refused() {
    let robot = pinned(
        "  one: {link: pitch_link, directions: planar_point}\n  two: {link: pitch_link, to: {xyz: [0.0005, 0, 0]}, directions: planar_point}\n",
    );
    says(&refused(&robot, RK4), &["constraints", "contradict", "take out"]);
}

#[test]
fn unknown_and_useless_names_are_refused_with_key_and_remedy() {
    let cases = [
        ("contacts: {foot: {link: z_lnik}}", "contacts.foot.link", "z_lnik", "`z_link`"),
        ("contacts: {foot: {link: base}}", "contacts.foot.link", "does not move", "name a link that moves"),
        ("constraints: {pin: {link: zlink, directions: point}}", "constraints.pin.link", "zlink", "`z_link`"),
        (
            "constraints: {pin: {link: z_link, to: {link: acros_link}, directions: point}}",
            "constraints.pin.to.link",
            "acros_link",
            "`across_link`",
        ),
        (
            "constraints: {pin: {link: z_link, directions: []}}",
            "constraints.pin.directions",
            "nothing is held",
            "list a direction",
        ),
        (
            "constraints: {pin: {link: z_link, to: {link: z_link}, directions: point}}",
            "constraints.pin",
            "never move",
            "name links",
        ),
        (
            "couplings: {rope: {joint: x, follows: z, ratio: 1, stabilisation: -2}}",
            "couplings.rope.stabilisation",
            "-2",
            "rad/s",
        ),
        ("couplings: {rope: {joint: w, follows: x, ratio: 1}}", "couplings.rope.joint", "`w`", "nearest"),
        (
            "couplings: {rope: {joint: x, follows: x, ratio: 1}}",
            "couplings.rope.follows",
            "follows itself",
            "another joint",
        ),
    ];
    for (yaml, key, problem, remedy) in cases {
        let error = try_load(&mass_urdf(), &format!("{yaml}\n")).expect_err("this must be refused");
        says(&error, &[key, problem, remedy]);
    }
}

/// In YAML 1.1 a plain `y` says yes.
#[test]
fn direction_y_needs_no_quotes() {
    for directions in ["[x, y]", "[y]", "[\"y\"]"] {
        let robot = pinned(&format!("  pin: {{link: pitch_link, directions: {directions}}}\n"));
        assert_eq!(robot.held.len(), 1, "{directions}");
    }
}
