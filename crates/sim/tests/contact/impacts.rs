//! What a record keeps of impacts, beside the events of the summary.

use crate::machines::{MASS, Run, assert_near, mass, rod, run};
use gyroflex_sim::contact::EventKind;

fn dropped() -> Run {
    let yaml = "duration: 0.9\ninitial: {q: {z: 0.5}, qd: {x: 0.4, across: -0.3}}
ground: {friction: 0.2, restitution: 0.5}\nintegrator: {method: rk4, step: 1e-3}\nlog: {rate: 100}";
    run(&mass(), yaml)
}

/// Of a mass: the momentum that it gains, and the energy that it loses.
#[test]
fn impulse_is_the_change_of_momentum_and_what_is_lost_that_of_the_energy() {
    let run = dropped();
    assert!(run.impacts.len() >= 3, "{:?}", run.impacts);
    for impact in &run.impacts {
        let [point] = impact.struck.as_slice() else { panic!("{impact:?}") };
        let half = |v: [f64; 3]| 0.5 * MASS * v.iter().map(|x| x * x).sum::<f64>();
        for k in 0..3 {
            assert_near("momentum", point.impulse[k], MASS * (point.after[k] - point.before[k]), 1e-9);
        }
        assert_near("restitution", point.after[2], -0.5 * point.before[2], 1e-9);
        assert_near("energy", impact.energy_lost, half(point.before) - half(point.after), 1e-9);
        assert!(impact.energy_lost > 0.0, "{impact:?}");
    }
}

/// Every event that a blow makes has its impact, and none is told twice, though many samples come after it.
#[test]
fn events_and_impacts_tell_the_same() {
    let askew = "duration: 1.0\ninitial: {q: {z: 0.4, pitch: 0.3}}\nground: {friction: 0.4, planar: true}
integrator: {method: rk4, step: 1e-3}\nlog: {rate: 1000}";
    for run in [dropped(), run(&rod(), askew)] {
        let blows: Vec<_> = run
            .summary
            .events
            .iter()
            .filter(|event| event.impulse != [0.0; 3] || matches!(event.kind, EventKind::TouchDown | EventKind::Bounce))
            .map(|event| (event.t, event.contact, event.impulse))
            .collect();
        let struck: Vec<_> = run
            .impacts
            .iter()
            .flat_map(|impact| impact.struck.iter().map(|s| (impact.t, s.contact, s.impulse)))
            .filter(|told| blows.contains(told) || told.2 != [0.0; 3])
            .collect();
        assert_eq!(struck, blows);
        assert!(run.impacts.iter().all(|impact| impact.energy_lost > -1e-9), "{:?}", run.impacts);
    }
}
