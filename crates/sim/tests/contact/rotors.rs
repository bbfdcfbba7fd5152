//! What an impact does to rotors: nothing behind springs, all behind rigid gears.

use crate::machines::{Run, assert_near, chain, inertial, run};

/// Length of the arm, its inertia about the joint, the reflected one of its rotor, and the spring.
const LENGTH: f64 = 1.0;
const MASS: f64 = 3.0;
const ABOUT_CENTRE: f64 = 0.25;
const ARM: f64 = ABOUT_CENTRE + MASS * 0.25 * LENGTH * LENGTH;
const REFLECTED: f64 = 1.5;
const STIFFNESS: f64 = 1000.0;
/// Speed of the joint at the impact [rad/s], and the angle from which it comes [rad].
const SPEED: f64 = 2.0;
const ANGLE: f64 = 1e-5;
const DURATION: f64 = 1e-3;

/// A level arm whose tip is about to strike.
fn strike(model: &str) -> Run {
    let part = ("joint", "continuous", "0 -1 0", inertial(MASS, 0.5 * LENGTH, 0.0, ABOUT_CENTRE));
    let yaml = format!(
        "drives:\n  joint: {{rotor: {{inertia: {}}}, gear_ratio: 100, transmission: {{stiffness: {STIFFNESS}}}}}
contacts: {{tip: {{link: joint_link, point: [{LENGTH}, 0, 0]}}}}\n",
        REFLECTED * 1e-4
    );
    // Or its spring would carry the arm.
    let slack = if model == "complete" { format!("theta: {{joint: {ANGLE}}}, ") } else { String::new() };
    let scenario = format!(
        "model: {model}\nduration: {DURATION}\ninitial: {{q: {{joint: {ANGLE}}}, {slack}qd: {{joint: {}}}}}
ground: {{friction: 0.5, planar: true}}\nintegrator: {{method: rk4, step: 1e-4}}\nlog: {{rate: 1000}}",
        -SPEED
    );
    let run = run(&chain(&[part], &yaml), &scenario);
    assert_eq!(run.summary.events.len(), 1, "{:?}", run.summary.events);
    run
}

/// By how much gravity changes the speed on the way to the ground, relative.
const GRAVITY: f64 = 2.0 * 9.81 / LENGTH * ANGLE / SPEED / SPEED;

#[test]
fn elastic_gear_keeps_the_rotor_turning_while_the_link_stops() {
    let run = strike("complete");
    let last = run.last();
    assert_near("link", last.qd[0], 0.0, 1e-9);
    // The spring begins to brake it: by less than if its deflection grew at full speed all the time.
    let braked = STIFFNESS * SPEED * DURATION * DURATION / (2.0 * REFLECTED);
    assert_near("rotor", last.thetad[0], -SPEED, 1.01 * braked);
    let impulse = ARM * SPEED / LENGTH;
    assert_near("impulse", run.summary.events[0].impulse[2], impulse, 2.0 * GRAVITY * impulse);
}

#[test]
fn rigid_gear_stops_the_rotor_with_the_joint_and_strikes_harder() {
    let run = strike("rigid");
    assert_near("link", run.last().qd[0], 0.0, 1e-9);
    assert_near("rotor", run.last().thetad[0], 0.0, 1e-9);
    let impulse = (ARM + REFLECTED) * SPEED / LENGTH;
    assert_near("impulse", run.summary.events[0].impulse[2], impulse, 2.0 * GRAVITY * impulse);
}
