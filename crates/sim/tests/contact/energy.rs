//! Energy of what strikes the ground.

use crate::machines::{Run, rod, run};
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
fn elastic_impacts_without_friction_lose_nothing_but_between_bodies_at_rest() {
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
