//! The four-bar linkage of `robots/four_bar`.

use crate::machines::assert_near;
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::record::{MemoryRecorder, Sample};
use gyroflex_sim::{ScenarioFile, Simulation, Summary};
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::path::PathBuf;

fn turn() -> (Summary, Vec<Sample>, [usize; 3]) {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../robots/four_bar");
    let robot = load(&folder.join("robot.yaml"), &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let joint = |name: &str| robot.joints.iter().position(|j| j.name == name).expect("the joint is there");
    let joints = ["crank_joint", "coupler_joint", "rocker_joint"].map(joint);
    let text = std::fs::read_to_string(folder.join("turn.yaml")).expect("the scenario is there");
    let file = ScenarioFile::parse(&text, &folder.join("turn.yaml")).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(&robot, &file).unwrap_or_else(|e| panic!("{e}"));
    let mut memory = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut memory, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|e| panic!("{e}"));
    (summary, memory.samples().to_vec(), joints)
}

/// Along x and z, with the lengths of its README.
#[test]
fn four_bar_linkage_stays_closed_over_a_full_turn() {
    let (summary, samples, [crank, coupler, rocker]) = turn();
    let mut largest = 0.0_f64;
    for sample in &samples {
        let (a, b, c) = (sample.q[crank], sample.q[crank] + sample.q[coupler], sample.q[rocker]);
        let x = 0.1 * a.cos() + 0.3 * b.cos() - 0.4 - 0.3 * c.cos();
        let z = 0.1 * a.sin() + 0.3 * b.sin() - 0.3 * c.sin();
        largest = largest.max(x.hypot(z));
    }
    assert!(largest < 1e-8, "{largest} m");
    assert!(summary.constraint_drift.expect("a loop holds it") < 1e-8, "{:?}", summary.constraint_drift);
    // The rocker swings back; the coupler has turned back against the crank.
    let (first, last) = (&samples[0], samples.last().expect("a run has samples"));
    let missed = last.q[crank] - first.q[crank] - TAU;
    assert!(missed.abs() < 0.02, "{missed} rad");
    assert_near("rocker", last.q[rocker], first.q[rocker], 0.02);
    assert_near("coupler", last.q[coupler] + TAU, first.q[coupler], 0.04);
}

/// What holds the loop does no work: the energy changes by what the motor gives and the damper takes.
#[test]
fn closed_loop_does_no_work() {
    let (_, samples, _) = turn();
    let energy = |s: &Sample| s.kinetic_energy + s.gravity_energy + s.elastic_energy;
    let (mut work, mut most, mut apart) = (0.0, 0.0_f64, 0.0_f64);
    for pair in samples.windows(2) {
        // Torques are held from sample to sample, so that their work is exact; the damper's is a trapezoid.
        let turned = pair[0].theta.iter().zip(&pair[1].theta).map(|(a, b)| b - a);
        work += pair[0].tau.iter().zip(turned).map(|(t, d)| t * d).sum::<f64>();
        work -= 0.5 * (pair[1].t - pair[0].t) * (pair[0].dissipation + pair[1].dissipation);
        let gained = energy(&pair[1]) - energy(&samples[0]);
        (most, apart) = (most.max(gained.abs()), apart.max((gained - work).abs()));
    }
    assert!(apart < 1e-4 * most, "{apart} J apart, of {most} J");
}
