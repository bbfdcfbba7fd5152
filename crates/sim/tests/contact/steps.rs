//! Events are where they are in time, not where a step ends.

use crate::machines::{assert_near, rod, run};

/// A rod that falls askew and turning: both ends strike, bounce, slip and rest.
fn tumbling(step: f64) -> String {
    format!(
        "duration: 0.5\ninitial: {{q: {{z: 0.4, pitch: 0.3}}, qd: {{x: 0.5, pitch: -2.0}}}}
ground: {{friction: 0.3, restitution: 0.3, resting_speed: 0.05, planar: true}}
integrator: {{method: rk4, step: {step}}}\nlog: {{rate: 1000}}"
    )
}

#[test]
fn half_the_step_moves_no_event() {
    let [a, b] = [2e-4, 1e-4].map(|step| run(&rod(), &tumbling(step)).summary.events);
    assert!(a.len() >= 3, "{a:?}");
    assert_eq!(a.len(), b.len(), "{a:?}\n{b:?}");
    for (a, b) in a.iter().zip(&b) {
        assert_eq!((a.contact, a.kind), (b.contact, b.kind));
        assert_near("time", a.t, b.t, 1e-9);
    }
}
