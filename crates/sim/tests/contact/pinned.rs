//! The biped of `robots/biped5` on a pinned toe.

use crate::machines::assert_near;
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::record::{MemoryRecorder, Sample};
use gyroflex_sim::{ScenarioFile, Simulation, Summary};
use std::ops::ControlFlow;
use std::path::PathBuf;

/// `pinned_fall.yaml` with a robot of the folder, and more in its scenario.
fn fall(robot: &str, duration: f64, more: &str) -> (Summary, Vec<Sample>) {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../robots/biped5");
    let robot = load(&folder.join(robot), &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let text = std::fs::read_to_string(folder.join("pinned_fall.yaml")).expect("the scenario is there");
    let text = text.replace("duration: 0.4", &format!("duration: {duration}")) + more;
    let file = ScenarioFile::parse(&text, &folder.join("pinned_fall.yaml")).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(&robot, &file).unwrap_or_else(|e| panic!("{e}"));
    let mut memory = MemoryRecorder::new(simulation.run_info());
    let summary = simulation.run(&mut memory, &mut |_| ControlFlow::Continue(())).unwrap_or_else(|e| panic!("{e}"));
    (summary, memory.samples().to_vec())
}

#[test]
fn biped_topples_about_its_pinned_toe_and_keeps_its_energy() {
    let (summary, samples) = fall("pinned.yaml", 0.4, "");
    let energy = |s: &Sample| s.kinetic_energy + s.gravity_energy;
    let (first, last) = (&samples[0], samples.last().expect("a run has samples"));
    assert!(last.kinetic_energy > 10.0, "it falls: {} J", last.kinetic_energy);
    for sample in &samples {
        assert_near("energy", energy(sample), energy(first), 1e-6);
        // hip_x, hip_z, trunk_pitch, left_hip, left_knee; thigh and shank with the lengths of the README
        let [x, z, pitch, hip, knee] = sample.q[..5] else { panic!("five coordinates lead to the foot") };
        let (thigh, shank) = (pitch + hip, pitch + hip + knee);
        assert_near("toe ahead", x - 0.302 * thigh.sin() - 0.332 * shank.sin(), 0.0, 1e-8);
        assert_near("toe up", z - 0.302 * thigh.cos() - 0.332 * shank.cos(), 0.0, 1e-8);
    }
    assert!(summary.constraint_drift.expect("a pin holds it") < 1e-8, "{:?}", summary.constraint_drift);
}

/// Ground that only pushes, with friction enough, is a pin for as long as it presses the foot that stands, and the other one is in the air.
#[test]
fn pinned_toe_is_a_foot_that_neither_slips_nor_leaves_the_ground() {
    let (_, pinned) = fall("pinned.yaml", 0.15, "");
    let (summary, standing) = fall("robot.yaml", 0.15, "ground: {friction: 10, planar: true}\n");
    assert!(summary.events.is_empty(), "{:?}", summary.events);
    assert_eq!(pinned.len(), standing.len());
    for (a, b) in pinned.iter().zip(&standing) {
        for (a, b) in a.q.iter().chain(&a.qd).zip(b.q.iter().chain(&b.qd)) {
            assert_near("motion", *a, *b, 1e-9);
        }
    }
}
