//! Laws of the project's own robots and scenarios.

use crate::arm::{distance, run_file};
use gyroflex_sim::load::{Disk, LoadOptions, load};
use gyroflex_sim::scenario::Integrator;
use gyroflex_sim::simulate::StateVec;
use gyroflex_sim::{Robot, ScenarioFile, Summary};
use std::path::Path;

fn read(name: &str) -> (Robot, ScenarioFile) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name);
    let file = ScenarioFile::load(&Disk, &path).unwrap_or_else(|e| panic!("{e}"));
    let robot = load(&file.robot_path(), &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    (robot, file)
}

fn run(name: &str) -> Summary {
    let (robot, file) = read(name);
    run_file(&robot, &file).0
}

#[test]
fn robots_follow_their_references() {
    let scenarios = [
        ("puma560/track.yaml", 0.02),
        ("iiwa14/track.yaml", 0.05),
        ("lwr/track.yaml", 0.05),
        ("planar_3r/track.yaml", 0.05),
        ("planar_3r/waypoints.yaml", 0.05),
        ("manutec_r3/hold.yaml", 1e-6),
        ("manutec_r3/move.yaml", 0.05),
    ];
    for (name, bound) in scenarios {
        for joint in run(name).joints {
            assert!(joint.rms_tracking_error < bound, "{name}: {joint:?}");
            assert!(joint.saturation < 0.05, "{name}: {joint:?}");
        }
    }
}

#[test]
fn robots_without_losses_keep_their_energy() {
    for name in ["planar_3r/free.yaml", "iiwa14/free.yaml", "biped5/fall.yaml"] {
        let drift = run(name).energy_drift.unwrap();
        assert!(drift < 1e-6, "{name}: {drift}");
    }
}

/// The distance from the motion of a much finer step falls by two to the fourth.
#[test]
fn halving_the_step_gains_four_orders() {
    for (name, step) in [("planar_3r/free.yaml", 2.5e-4), ("iiwa14/free.yaml", 1e-4)] {
        let (robot, mut file) = read(name);
        file.scenario.duration = 0.5;
        // Steps that divide the millisecond between samples are taken as they are.
        let mut end = |step: f64| {
            file.scenario.integrator = Integrator::Rk4 { step };
            run_file(&robot, &file).2.state().clone()
        };
        let (exact, coarse, fine) = (end(step / 10.0), end(step), end(step / 2.0));
        let error = |state: &StateVec| distance(&state.q, &exact.q).max(distance(&state.qd, &exact.qd));
        let order = (error(&coarse) / error(&fine)).log2();
        assert!((order - 4.0).abs() < 0.25, "{name}: order {order}");
    }
}
