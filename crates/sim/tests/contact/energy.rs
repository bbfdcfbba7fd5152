//! Energy of what strikes the ground.

use crate::machines::{Run, rod, run};
use crate::stands::table;
use gyroflex_sim::record::Sample;

fn fallen(ground: &str) -> Run {
    let yaml = format!(
        "duration: 0.8\ninitial: {{q: {{z: 0.5, pitch: 0.4}}, qd: {{x: 0.3, pitch: 1.0}}}}
ground: {{{ground}, planar: true}}\nintegrator: {{method: rk4, step: 2e-4}}\nlog: {{rate: 1000}}"
    );
    run(&rod(), &yaml)
}

fn total(sample: &Sample) -> f64 {
    sample.kinetic_energy + sample.gravity_energy + sample.elastic_energy
}

#[test]
fn energy_never_grows_at_plastic_impacts_and_under_friction() {
    for friction in [0.0, 0.3, 1.0] {
        let run = fallen(&format!("friction: {friction}"));
        assert!(!run.summary.events.is_empty());
        let scale = total(&run.samples[0]).abs();
        for pair in run.samples.windows(2) {
            let grown = total(&pair[1]) - total(&pair[0]);
            assert!(grown <= 1e-9 * scale, "{grown} J at {} s, friction {friction}", pair[1].t);
        }
    }
}

#[test]
fn elastic_impacts_without_friction_lose_nothing() {
    let run = fallen("friction: 0, restitution: 1");
    let scale = total(&run.samples[0]);
    for sample in &run.samples {
        let lost = total(sample) - scale;
        assert!(lost.abs() <= 1e-9 * scale, "{lost} J at {} s", sample.t);
    }
}

#[test]
fn energy_without_friction_is_constant_between_events() {
    for restitution in [0.0, 0.5] {
        let run = fallen(&format!("friction: 0, restitution: {restitution}"));
        let scale = total(&run.samples[0]).abs();
        let before = |s: &Sample| run.summary.events.iter().filter(|e| e.t <= s.t).count();
        for pair in run.samples.windows(2).filter(|p| before(&p[0]) == before(&p[1])) {
            let change = total(&pair[1]) - total(&pair[0]);
            assert!(change.abs() <= 1e-9 * scale, "{change} J at {} s", pair[1].t);
        }
    }
}

/// Whatever falls, however askew: no run ends in an error, and none gains energy.
#[test]
fn rods_that_fall_askew_never_gain_energy() {
    for case in 0..24 {
        let wave = |k: f64| (1.3 * f64::from(case) + k).sin();
        let yaml = format!(
            "duration: 0.6\ninitial: {{q: {{z: 0.4, pitch: {}}}, qd: {{x: {}, z: {}, pitch: {}}}}}
ground: {{friction: {}, planar: true}}\nintegrator: {{method: rk4, step: 1e-3}}\nlog: {{rate: 500}}",
            1.2 * wave(0.0),
            2.0 * wave(1.0),
            wave(2.0),
            6.0 * wave(3.0),
            [0.0, 0.2, 0.5, 0.9][case as usize % 4]
        );
        let run = run(&rod(), &yaml);
        never_gains(&run, &format!("case {case}"));
    }
}

#[test]
fn tables_that_fall_askew_on_ice_never_gain_energy() {
    tables([0.0; 4]);
}

#[test]
fn tables_that_fall_askew_never_gain_energy() {
    tables([0.0, 0.2, 0.5, 0.9]);
}

fn tables(friction: [f64; 4]) {
    for case in 0..8 {
        let wave = |k: f64| (1.3 * f64::from(case) + k).sin();
        let yaml = format!(
            "duration: 0.5\ninitial: {{base: {{xyz: [0, 0, 0.3], rpy: [{}, {}, 0.4], twist: [{}, {}, {}, {}, {}, 0]}}}}
ground: {{friction: {}}}\nintegrator: {{method: rk4, step: 1e-3}}\nlog: {{rate: 500}}",
            0.2 * wave(0.0),
            0.2 * wave(1.0),
            wave(2.0),
            wave(3.0),
            wave(4.0),
            wave(5.0),
            wave(6.0),
            friction[case as usize % 4]
        );
        let run = run(&table(4), &yaml);
        never_gains(&run, &format!("case {case}"));
    }
}

fn never_gains(run: &Run, case: &str) {
    let scale = total(&run.samples[0]).abs();
    assert!(!run.summary.events.is_empty(), "{case}");
    for pair in run.samples.windows(2) {
        let gained = total(&pair[1]) - total(&pair[0]);
        assert!(gained <= 1e-7 * scale, "{case}: {gained} J at {} s, {:?}", pair[1].t, run.summary.events);
    }
}
