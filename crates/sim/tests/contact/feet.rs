//! Bodies with more feet than they need, that are pushed, tipped, spun and thrown.

use crate::machines::{G, Run, assert_near, inertial, run, try_load};
use gyroflex_sim::Robot;
use gyroflex_sim::contact::EventKind;
use gyroflex_sim::record::Sample;

const MASS: f64 = 12.0;
const THREE: &[[f64; 3]] = &[[-0.2, -0.1, -0.05], [-0.2, 0.1, -0.05], [0.25, 0.0, -0.05]];
const FOUR: &[[f64; 3]] = &[[-0.3, -0.2, -0.4], [-0.3, 0.2, -0.4], [0.3, -0.2, -0.4], [0.35, 0.2, -0.4]];
const FRICTION: f64 = 0.4;

/// A free body on points, its centre of mass in its origin.
fn body(feet: &[[f64; 3]]) -> Robot {
    let urdf = format!("<robot name=\"machine\"><link name=\"top\">{}</link></robot>", inertial(MASS, 0.0, 0.0, 0.3));
    let point = |(i, [x, y, z]): (usize, &[f64; 3])| format!("  foot{i}: {{link: top, point: [{x}, {y}, {z}]}}\n");
    let feet: String = feet.iter().enumerate().map(point).collect();
    try_load(&urdf, &format!("floating: true\ncontacts:\n{feet}")).unwrap_or_else(|e| panic!("{e}"))
}

fn scenario(duration: f64, friction: f64, base: &str, more: &str) -> String {
    format!(
        "duration: {duration}\nground: {{friction: {friction}}}\ninitial: {{base: {{{base}}}}}\n\
         integrator: {{method: rk4, step: 5e-4}}\nlog: {{rate: 2000}}\n{more}"
    )
}

fn pose(sample: &Sample) -> [f64; 7] {
    sample.base_pose.expect("it is free")
}

fn speed(sample: &Sample) -> f64 {
    sample.base_twist.expect("it is free").into_iter().fold(0.0, |m, v| m.max(v.abs()))
}

fn forces(sample: &Sample) -> Vec<[f64; 3]> {
    sample.footing.as_ref().expect("there is ground").contacts.iter().map(|c| c.force).collect()
}

/// Gains of energy, relative to that at the start.
fn gains(run: &Run) -> f64 {
    let total = |s: &Sample| s.kinetic_energy + s.gravity_energy;
    let changes = run.samples.windows(2).map(|pair| total(&pair[1]) - total(&pair[0]));
    changes.fold(0.0, f64::max) / total(&run.samples[0]).abs()
}

/// All of its friction is what friction makes of all its weight, however it is shared.
#[test]
fn body_slides_only_when_the_friction_of_all_feet_is_used_up() {
    let most = FRICTION * MASS * G;
    let pushed = |force: f64| {
        let push = format!("wrenches: [{{link: top, force: [0, {force}, 0], point: [0, 0, -0.4], start: 0.1}}]");
        run(&body(FOUR), &scenario(0.4, FRICTION, "xyz: [0, 0, 0.4]", &push))
    };
    assert_near("less", pose(pushed(0.95 * most).last())[1], 0.0, 1e-7);
    let way = 0.5 * 0.5 * FRICTION * G * 0.3 * 0.3;
    let moved = pushed(1.5 * most);
    // The feet are not evenly loaded about the push: it turns a little on its way.
    assert_near("more", pose(moved.last())[1], way, 0.1 * way);
}

#[test]
fn feet_share_what_they_bear_alike() {
    let square = [[-0.3, -0.2, -0.4], [-0.3, 0.2, -0.4], [0.3, -0.2, -0.4], [0.3, 0.2, -0.4]];
    let push = "wrenches: [{link: top, force: [10, 0, 0], point: [0, 0, -0.4]}]";
    let run = run(&body(&square), &scenario(0.05, FRICTION, "xyz: [0, 0, 0.4]", push));
    for force in forces(run.last()) {
        assert_near("normal", force[2], 0.25 * MASS * G, 1e-3);
        assert_near("along", force[0], -2.5, 1e-3);
    }
}

#[test]
fn sliding_body_stops_at_its_closed_form_time_and_place() {
    let (speed, time) = (1.5, 1.5 / (FRICTION * G));
    let start = format!("xyz: [0, 0, 0.05], twist: [0, 0, 0, {}, {}, 0]", 0.6 * speed, 0.8 * speed);
    let run = run(&body(THREE), &scenario(0.6, FRICTION, &start, ""));
    let way = 0.5 * speed * time;
    assert_near("x", pose(run.last())[0], 0.6 * way, 1e-7);
    assert_near("y", pose(run.last())[1], 0.8 * way, 1e-7);
    let stick = run.summary.events.iter().filter(|e| e.kind == EventKind::Stick);
    stick.for_each(|e| assert_near("time", e.t, time, 1e-6));
    assert!(self::speed(run.last()) < 1e-6, "{}", self::speed(run.last()));
}

/// Spinning and sliding: no two feet slip in one direction, and they come to rest together.
#[test]
fn spinning_body_comes_to_rest_and_never_asks_for_more_friction_than_there_is() {
    let run = run(&body(THREE), &scenario(1.0, FRICTION, "xyz: [0, 0, 0.05], twist: [0, 0, 8, 1, 0.5, 0]", ""));
    assert!(gains(&run) < 1e-7, "{}", gains(&run));
    assert!(run.last().kinetic_energy < 1e-9, "{} J are left", run.last().kinetic_energy);
    for sample in &run.samples {
        let forces = forces(sample);
        assert_near("weight", forces.iter().map(|f| f[2]).sum(), MASS * G, 1e-5);
        for [x, y, z] in forces {
            assert!(x.hypot(y) <= FRICTION * z * (1.0 + 1e-6) + 1e-6, "{x} {y} {z} at {}", sample.t);
        }
    }
}

#[test]
fn tipped_body_comes_back_to_all_its_feet() {
    let push = "wrenches: [{link: top, force: [130, 0, 0], start: 0.1, end: 0.2}]";
    let run = run(&body(FOUR), &scenario(1.5, 1.5, "xyz: [0, 0, 0.4]", push));
    let events = &run.summary.events;
    assert!(events.iter().filter(|e| e.kind == EventKind::LiftOff).count() >= 2, "{events:?}");
    // It rocks from foot to foot, ever faster and less.
    assert!(events.len() < 300, "{} events", events.len());
    let footing = run.last().footing.as_ref().expect("there is ground");
    assert_near("weight", footing.contacts.iter().map(|c| c.force[2]).sum(), MASS * G, 1e-5);
    assert!(footing.contacts.iter().all(|c| c.gap.abs() < 1e-7), "{footing:?}");
}

#[test]
fn thrown_bodies_come_down_without_gaining_energy() {
    for friction in [0.0, 0.3, 0.8, 2.0] {
        for case in 0..6 {
            let wave = |k: f64| (1.7 * f64::from(case) + k).sin();
            let numbers: Vec<String> = (1..9).map(|k| format!("{:.3}", 2.0 * wave(f64::from(k)))).collect();
            let start = format!(
                "xyz: [0, 0, 0.6], rpy: [{:.3}, {:.3}, 0.1], twist: [{}]",
                0.3 * wave(0.3),
                0.3 * wave(0.7),
                numbers[..6].join(", ")
            );
            let name = format!("case {case}, friction {friction}");
            let run = run(&body(FOUR), &scenario(0.8, friction, &start, ""));
            assert!(run.summary.events.iter().any(|e| e.kind == EventKind::TouchDown), "{name}");
            // With so much friction feet jam (Painlevé): forces then grow without end within a step.
            let most = if friction > 1.0 { 1e-4 } else { 1e-7 };
            assert!(gains(&run) < most, "{name}: {}", gains(&run));
            let gaps = run.samples.iter().flat_map(|s| &s.footing.as_ref().expect("there is ground").contacts);
            let deepest = gaps.map(|c| -c.gap).fold(0.0, f64::max);
            // What slips and nearly jams turns as fast as a step lasts.
            assert!(deepest < 1e-5, "{name}: {deepest} m below the ground");
        }
    }
}
