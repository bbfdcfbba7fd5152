//! Laws of touching down.

use crate::robots::{G, close, energy, link, point, robot, run, table};
use gyroflex_sim::contact::EventKind;

const HEIGHT: f64 = 0.5;

#[test]
fn dropped_point_touches_down_when_it_must_and_stays() {
    let made = run(&point(), &format!("duration: 0.6\nground: {{friction: 0.8}}\ninitial: {{q: {{z: {HEIGHT}}}, qd: {{x: 0.3}}}}\nintegrator: {{method: rk4, step: 1e-3}}"));
    let down: Vec<_> = made.events(EventKind::TouchDown).collect();
    assert_eq!(down.len(), 1, "{:?}", made.simulation.events());
    close("time", down[0].t, (2.0 * HEIGHT / G).sqrt(), 1e-10);
    close("impulse", down[0].impulse[2], 2.0 * (2.0 * G * HEIGHT).sqrt(), 1e-8);
    close("impulse of friction", down[0].impulse[0], -2.0 * 0.3, 1e-9);
    let footing = made.last().footing.as_ref().unwrap();
    close("weight", footing.contacts[0].force[2], 2.0 * G, 1e-9);
    assert!(footing.contacts[0].gap.abs() < 1e-9 && footing.contacts[0].mode == 1.0, "{footing:?}");
}

/// After the k-th bounce the point flies for `2 eᵏ t₁`, as high as `e²ᵏ h`.
#[test]
fn bounces_fall_by_the_square_of_the_restitution() {
    let e: f64 = 0.5;
    let first = (2.0 * HEIGHT / G).sqrt();
    let made = run(&point(), &format!("duration: 1.2\nground: {{friction: 0.8, restitution: {e}}}\ninitial: {{q: {{z: {HEIGHT}}}}}\nlog: {{rate: 5000}}"));
    let times = made.times(EventKind::Bounce);
    assert!(times.len() > 6, "{times:?}");
    let mut expected = first;
    for (k, t) in times.iter().take(7).enumerate() {
        close("time of a bounce", *t, expected, 1e-9);
        let flight = 2.0 * e.powi(k as i32 + 1) * first;
        let top = made.samples.iter().filter(|s| s.t > expected && s.t < expected + flight).map(|s| s.q[1]);
        let height = e.powi(2 * (k as i32 + 1)) * HEIGHT;
        // The highest sample is within half a period of the log of the top.
        close("height of a bounce", top.fold(0.0, f64::max), height, G * 1e-4 * 1e-4);
        expected += flight;
    }
    assert_eq!(made.times(EventKind::TouchDown).len(), 1, "it comes to rest");
    close("the end of bouncing", made.times(EventKind::TouchDown)[0], first * (1.0 + e) / (1.0 - e), 1e-3);
    assert!(made.last().qd[1].abs() < 1e-9);
}

/// A body that falls flat on one end, then on the other.
#[test]
fn plastic_impacts_never_give_energy() {
    let feet = [[-0.3, -0.2, -0.3], [-0.3, 0.2, -0.3], [0.3, -0.2, -0.3], [0.3, 0.2, -0.3]];
    for friction in [0.0, 0.3, 2.0] {
        for twist in ["[0, 0, 0, 0, 0, 0]", "[1.5, -2, 1, 0.7, -0.4, 0.2]"] {
            let made = run(&table(&feet, ""), &format!("duration: 1.0\nground: {{friction: {friction}}}\ninitial: {{base: {{xyz: [0, 0, 0.5], rpy: [0.2, 0.3, 0.1], twist: {twist}}}}}\nlog: {{rate: 2000}}\nintegrator: {{method: rk4, step: 5e-4}}"));
            let before = energy(&made.samples[0]);
            let grown = made.samples.windows(2).map(|s| energy(&s[1]) - energy(&s[0])).fold(0.0, f64::max);
            assert!(grown < 1e-7 * before, "friction {friction}, twist {twist}: {grown} J of {before}");
            assert!(made.events(EventKind::TouchDown).count() >= 3);
            let deepest = made.samples.iter().flat_map(|s| &s.footing.as_ref().unwrap().contacts).map(|c| -c.gap);
            assert!(deepest.fold(0.0, f64::max) < 1e-8);
        }
    }
}

/// A leaning rod falls on its end; where and when is found inside of a step.
#[test]
fn times_of_events_do_not_depend_on_the_step() {
    let feet = [[-0.3, 0.0, -0.3], [0.3, 0.0, -0.3]];
    let times = |step: f64| -> Vec<(EventKind, f64)> {
        let made = run(&table(&feet, ""), &format!("duration: 0.6\nground: {{friction: 0.4}}\ninitial: {{base: {{xyz: [0, 0, 0.6], rpy: [0, 0.4, 0], twist: [0, 1, 0, 1.0, 0, 0]}}}}\nintegrator: {{method: rk4, step: {step}}}"));
        made.simulation.events().iter().map(|e| (e.kind, e.t)).collect()
    };
    let (coarse, fine) = (times(1e-3), times(5e-4));
    assert_eq!(coarse.len(), fine.len(), "{coarse:?}\n{fine:?}");
    assert!(coarse.len() >= 3, "{coarse:?}");
    for (a, b) in coarse.iter().zip(&fine) {
        assert!(a.0 == b.0 && (a.1 - b.1).abs() < 1e-8, "{a:?} {b:?}\n{coarse:?}");
    }
}

/// The blow stops the links; what the rotors have, they keep, and give it to the springs.
#[test]
fn elastic_rotors_keep_their_speed_through_an_impact() {
    let urdf = |_: ()| {
        use crate::robots::joint;
        [
            "<robot name=\"hopper\"><link name=\"world\"/>".to_owned(),
            joint("z", "prismatic", ["world", "trunk"], [0.0; 3], "0 0 1"),
            link("trunk", 5.0, [0.0; 3], 0.1),
            joint("leg", "prismatic", ["trunk", "foot"], [0.0, 0.0, -0.5], "0 0 1"),
            link("foot", 0.5, [0.0; 3], 1e-3),
            "</robot>".to_owned(),
        ]
        .concat()
    };
    let yaml = "contacts: {sole: {link: foot}}\ndrives:\n  leg:\n    rotor: {inertia: 1e-5}\n    gear_ratio: 200\n    transmission: {stiffness: 4000, damping: 20}\n";
    let hopper = robot(&urdf(()), yaml);
    let scenario = "duration: 1.0\nground: {friction: 0.5}\ninitial: {q: {z: 0.7}}\nreference: {leg: {type: hold, at: 0.0}}\ncontroller: {type: pd, rate: 1000, kp: 1e4, kd: 100}\nlog: {rate: 20000}\nintegrator: {method: rk4, step: 1e-4}\n";
    let made = run(&hopper, scenario);
    assert!(made.events(EventKind::LiftOff).count() >= 1, "it hops: {:?}", made.simulation.events());
    let (mut links, mut motors) = (0.0_f64, 0.0_f64);
    for s in made.samples.windows(2) {
        links = links.max((s[1].qd[1] - s[0].qd[1]).abs());
        motors = motors.max((s[1].thetad[1] - s[0].thetad[1]).abs());
    }
    assert!(links > 1.0 && motors < 0.1, "the foot's speed jumps by {links}, the motor's by {motors}");

    let made = run(&hopper, &format!("{scenario}model: rigid\n"));
    let jump = made.samples.windows(2).map(|s| (s[1].thetad[1] - s[0].thetad[1]).abs()).fold(0.0, f64::max);
    assert!(jump > 1.0, "a rigid gear stops its rotor with the joint: {jump}");
}
