//! A mass that slides on the ground.

use crate::machines::{G, MASS, Run, assert_near, mass, run};
use gyroflex_sim::contact::EventKind;

const FRICTION: f64 = 0.4;

fn on_ground(more: &str) -> Run {
    let yaml = format!(
        "duration: 1.0\nground: {{friction: {FRICTION}}}\nintegrator: {{method: rk4, step: 1e-3}}\nlog: {{rate: 1000}}\n{more}"
    );
    run(&mass(), &yaml)
}

/// After `v/(μ g)` at `v²/(2 μ g)`, whatever the direction, and on a straight line.
#[test]
fn sliding_mass_stops_at_its_closed_form_time_and_place() {
    let speed = 1.5;
    for (cx, cy) in [(1.0, 0.0), (0.0, -1.0), (0.6, 0.8), (-0.8, 0.6)] {
        let run = on_ground(&format!("initial: {{qd: {{x: {}, across: {}}}}}", speed * cx, speed * cy));
        let [event] = run.summary.events[..] else { panic!("{:?}", run.summary.events) };
        assert_eq!(event.kind, EventKind::Stick);
        assert_near("time", event.t, speed / (FRICTION * G), 1e-9);
        let way = speed * speed / (2.0 * FRICTION * G);
        assert_near("x", run.last().q[0], way * cx, 1e-8);
        assert_near("y", run.last().q[1], way * cy, 1e-8);
        for sample in &run.samples {
            assert_near("straight", sample.q[0] * cy - sample.q[1] * cx, 0.0, 1e-9);
            let touch = run.touch(sample, "foot");
            let slides = sample.t < event.t - 1e-9;
            assert_near("mode", touch.mode, if slides { 2.0 } else { 1.0 }, 0.0);
            let friction = touch.force[0].hypot(touch.force[1]);
            // Once it rests there is nothing that friction would have to hold.
            let want = if slides { FRICTION * MASS * G } else { 0.0 };
            assert_near("friction", friction, want, 1e-6);
        }
    }
}

fn pushed(force: f64) -> Run {
    on_ground(&format!("wrenches: [{{link: z_link, force: [{}, {}, 0], start: 0.1}}]", 0.6 * force, 0.8 * force))
}

#[test]
fn push_within_friction_moves_nothing() {
    let force = 0.99 * FRICTION * MASS * G;
    let run = pushed(force);
    assert!(run.summary.events.is_empty(), "{:?}", run.summary.events);
    assert_near("x", run.last().q[0], 0.0, 1e-12);
    assert_near("y", run.last().q[1], 0.0, 1e-12);
    let touch = run.touch(run.last(), "foot");
    assert_near("friction", touch.force[0].hypot(touch.force[1]), force, 1e-8);
}

#[test]
fn push_beyond_friction_accelerates_by_the_difference() {
    let run = pushed(1.5 * FRICTION * MASS * G);
    let [event] = run.summary.events[..] else { panic!("{:?}", run.summary.events) };
    assert_eq!(event.kind, EventKind::Slip);
    assert_near("time", event.t, 0.1, 1e-9);
    let (a, t) = (0.5 * FRICTION * G, 0.9);
    assert_near("x", run.last().q[0], 0.6 * 0.5 * a * t * t, 1e-8);
    assert_near("y", run.last().q[1], 0.8 * 0.5 * a * t * t, 1e-8);
}

/// A force across the way turns a sliding mass round without a rest: by far less friction than holds it, it never sticks, and the power of
/// friction is `μ m g` times the speed all the way.
#[test]
fn mass_that_is_turned_round_does_not_stick_on_the_way() {
    let force = 3.0 * FRICTION * MASS * G;
    let run = on_ground(&format!(
        "initial: {{qd: {{x: 1.0}}}}\nwrenches: [{{link: z_link, force: [{}, {}, 0]}}]",
        -0.8 * force,
        0.6 * force
    ));
    assert!(run.summary.events.is_empty(), "{:?}", run.summary.events);
    assert_near("speed", run.samples[0].qd[0], 1.0, 0.0);
    for sample in &run.samples {
        let touch = run.touch(sample, "foot");
        let speed = sample.qd[0].hypot(sample.qd[1]);
        let power = touch.force[0] * sample.qd[0] + touch.force[1] * sample.qd[1];
        assert_near("power", power, -FRICTION * MASS * G * speed, 1e-8);
    }
}

/// What starts on the ground and moves off it is not caught.
#[test]
fn mass_that_is_thrown_up_from_the_ground_flies() {
    let run = on_ground("initial: {qd: {z: 2.0}}");
    let event = run.summary.events[0];
    assert_eq!(event.kind, EventKind::TouchDown);
    assert_near("time", event.t, 2.0 * 2.0 / G, 1e-9);
}

#[test]
fn pull_beyond_the_weight_lifts_off_and_accelerates_by_the_difference() {
    let run = on_ground(&format!("wrenches: [{{link: z_link, force: [0, 0, {}], start: 0.1}}]", 1.2 * MASS * G));
    let [event] = run.summary.events[..] else { panic!("{:?}", run.summary.events) };
    assert_eq!(event.kind, EventKind::LiftOff);
    assert_near("time", event.t, 0.1, 1e-9);
    assert_near("height", run.last().q[2], 0.5 * 0.2 * G * 0.9 * 0.9, 1e-9);
}

/// Once pushed off it goes on while the push is gone, and stops like any other.
#[test]
fn pushed_mass_stops_when_friction_has_taken_its_momentum() {
    let (force, span) = (2.5 * FRICTION * MASS * G, 0.1);
    let run = on_ground(&format!("wrenches: [{{link: z_link, force: [{force}, 0, 0], start: 0.1, end: 0.2}}]"));
    let kinds: Vec<EventKind> = run.summary.events.iter().map(|e| e.kind).collect();
    assert_eq!(kinds, [EventKind::Slip, EventKind::Stick]);
    // All the impulse of the push is friction's in the end.
    assert_near("time", run.summary.events[1].t, 0.1 + force * span / (FRICTION * MASS * G), 1e-9);
}
