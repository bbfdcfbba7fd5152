//! Constraints and couplings.

use crate::machines::{G, assert_near, chain, inertial, planar, run, side_by_side};
use gyroflex_sim::Robot;

const LENGTH: f64 = 0.7;
const MASS: f64 = 1.3;
/// Of the body about its own centre: without joints that hold it a point could not be turned.
const ABOUT_CENTRE: f64 = 0.02;

/// A body that is free in the plane, but for a pin above its centre.
fn pinned() -> Robot {
    let yaml = format!("constraints:\n  pin: {{link: pitch_link, xyz: [0, 0, {LENGTH}], directions: planar_point}}\n");
    planar(inertial(MASS, 0.0, 0.0, ABOUT_CENTRE), &yaml)
}

fn pendulum() -> Robot {
    chain(&[("pitch", "continuous", "0 1 0", inertial(MASS, 0.0, -LENGTH, ABOUT_CENTRE))], "model: complete\n")
}

const START: f64 = 1.2;

fn swing(duration: f64, initial: &str) -> String {
    format!("duration: {duration}\ninitial: {initial}\nintegrator: {{method: rk4, step: 1e-3}}\nlog: {{rate: 100}}")
}

fn pinned_start() -> String {
    // The pin is at (x + L sin φ, z + L cos φ).
    format!("{{q: {{x: {}, z: {}, pitch: {START}}}}}", -LENGTH * START.sin(), -LENGTH * START.cos())
}

#[test]
fn body_on_a_pin_is_a_pendulum() {
    let held = run(&pinned(), &swing(2.0, &pinned_start()));
    let free = run(&pendulum(), &swing(2.0, &format!("{{q: {{pitch: {START}}}}}")));
    for (a, b) in held.samples.iter().zip(&free.samples) {
        assert_near("angle", a.q[2], b.q[0], 1e-8);
        assert_near("speed", a.qd[2], b.qd[0], 1e-7);
    }
}

#[test]
fn pin_does_not_drift() {
    let drift = run(&pinned(), &swing(5.0, &pinned_start())).summary.constraint_drift.expect("a pin holds it");
    assert!(drift < 1e-8, "{drift} m");
}

fn sliders(ratio: f64) -> Robot {
    let parts = [
        ("a", "prismatic", "0 0 1", inertial(1.0, 0.0, 0.0, 0.01)),
        ("b", "prismatic", "0 0 1", inertial(3.0, 0.0, 0.0, 0.01)),
    ];
    side_by_side(&parts, &format!("couplings:\n  rope: {{joint: b, follows: a, ratio: {ratio}, offset: 0.1}}\n"))
}

/// Atwood's machine: `(1 + 3 r²) ä = −(1 + 3 r) g`.
#[test]
fn coupled_joints_keep_their_ratio_and_share_their_weights() {
    for ratio in [-1.0, -2.0, 0.5] {
        let run = run(&sliders(ratio), &swing(1.0, &format!("{{q: {{a: 0.2, b: {}}}}}", 0.2 * ratio + 0.1)));
        let acceleration = -(1.0 + 3.0 * ratio) * G / (1.0 + 3.0 * ratio * ratio);
        for sample in &run.samples {
            assert_near("ratio", sample.q[1], ratio * sample.q[0] + 0.1, 1e-9);
            assert_near("fall", sample.q[0], 0.2 + 0.5 * acceleration * sample.t * sample.t, 1e-9);
        }
    }
}

/// Both ends of the rope stand still where their weights are in balance.
#[test]
fn coupled_weights_in_balance_stay() {
    let run = run(&sliders(-1.0 / 3.0), &swing(1.0, "{q: {a: 0, b: 0.1}}"));
    assert_near("fall", run.last().q[0], 0.0, 1e-12);
}
