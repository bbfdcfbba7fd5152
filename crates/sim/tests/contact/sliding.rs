//! Laws of friction.

use crate::robots::{G, close, point, run, table};
use gyroflex_sim::contact::EventKind;

const SPEED: f64 = 1.5;
const FRICTION: f64 = 0.4;

/// It stops after `v/(μ g)`, having slid `v²/(2 μ g)`.
#[test]
fn sliding_point_stops_where_and_when_it_must() {
    let time = SPEED / (FRICTION * G);
    for step in [1e-3, 5e-4] {
        let made = run(&point(), &format!("duration: 0.6\nground: {{friction: {FRICTION}, planar: true}}\ninitial: {{qd: {{x: {SPEED}}}}}\nintegrator: {{method: rk4, step: {step}}}"));
        assert_eq!(made.simulation.events().len(), 1, "{:?}", made.simulation.events());
        close("time", made.times(EventKind::Stick)[0], time, 1e-9);
        close("way", made.last().q[0], 0.5 * SPEED * time, 1e-9);
        let early = made.samples[10].footing.as_ref().unwrap().contacts[0];
        close("friction", early.force[0], -FRICTION * 2.0 * G, 1e-9);
        assert_eq!(early.mode, 2.0);
        assert_eq!(made.last().footing.as_ref().unwrap().contacts[0].mode, 1.0);
    }
}

#[test]
fn sliding_block_in_space_stops_where_it_must() {
    let feet = [[-0.2, -0.1, -0.05], [-0.2, 0.1, -0.05], [0.25, 0.0, -0.05]];
    let time = SPEED / (FRICTION * G);
    let (x, y) = (0.6 * SPEED, 0.8 * SPEED);
    let made = run(&table(&feet, ""), &format!("duration: 0.6\nground: {{friction: {FRICTION}}}\ninitial: {{base: {{xyz: [0, 0, 0.05], twist: [0, 0, 0, {x}, {y}, 0]}}}}"));
    let pose = made.last().base_pose.unwrap();
    close("way along x", pose[0], 0.5 * x * time, 1e-6);
    close("way along y", pose[1], 0.5 * y * time, 1e-6);
    for t in made.times(EventKind::Stick) {
        close("time", t, time, 1e-6);
    }
    let speed = made.last().base_twist.unwrap().into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    assert!(speed < 1e-6, "it is at rest: {speed}");
}

/// Spinning and sliding at once, so that no two points slip in one direction.
#[test]
fn friction_takes_what_the_log_says() {
    let feet = [[-0.2, -0.1, -0.05], [-0.2, 0.1, -0.05], [0.25, 0.0, -0.05]];
    let made = run(&table(&feet, ""), "duration: 1.0\nground: {friction: 0.4}\ninitial: {base: {xyz: [0, 0, 0.05], twist: [0, 0, 8, 1, 0.5, 0]}}\nlog: {rate: 2000}\nintegrator: {method: rk4, step: 2.5e-4}");
    let falls = made.samples.windows(2).all(|s| s[1].kinetic_energy <= s[0].kinetic_energy + 1e-9);
    assert!(falls, "kinetic energy never grows on level ground");
    assert!(made.last().kinetic_energy < 1e-9, "{} J are left", made.last().kinetic_energy);
    for sample in &made.samples {
        let contacts = &sample.footing.as_ref().unwrap().contacts;
        let weight: f64 = contacts.iter().map(|c| c.force[2]).sum();
        close("weight", weight, 12.0 * G, 1e-6);
        for c in contacts {
            let [x, y, z] = c.force;
            assert!(x.hypot(y) <= 0.4 * z * (1.0 + 1e-6) + 1e-9, "{c:?} at {}", sample.t);
        }
    }
}

/// A pull that grows beyond what friction can do, and ends again.
#[test]
fn point_slips_when_it_is_pulled_too_hard_and_sticks_again() {
    let pull = 1.5 * FRICTION * 2.0 * G;
    let made = run(&point(), &format!("duration: 1.0\nground: {{friction: {FRICTION}, planar: true}}\nwrenches:\n  - {{link: ball, force: [{}, 0, 0], start: 0.1, end: 0.2}}\n  - {{link: ball, force: [{pull}, 0, 0], start: 0.3, end: 0.5, frame: world}}", 0.9 * FRICTION * 2.0 * G));
    let kinds: Vec<_> = made.simulation.events().iter().map(|e| e.kind).collect();
    assert_eq!(kinds, [EventKind::Slip, EventKind::Stick]);
    close("begin", made.times(EventKind::Slip)[0], 0.3, 1e-9);
    // Driven for 0.2 s at half of what friction takes, then slowed by all of it for half as long.
    close("end", made.times(EventKind::Stick)[0], 0.6, 1e-9);
    let (pushed, slowed) = (0.5 * FRICTION * G, FRICTION * G);
    close("way", made.last().q[0], 0.5 * pushed * 0.04 + 0.5 * slowed * 0.01, 1e-8);
}
