//! Laws of what is recorded of links that bend.

use crate::arms::{run, scenario, tree};
use gyroflex_sim::Simulation;
use gyroflex_sim::record::{CsvRecorder, McapRecorder, MemoryRecorder, TeeRecorder, columns, read_states};
use std::ops::ControlFlow;

const RUN: &str =
    "duration: 0.02\ninitial: {qd: {shoulder: 1.0}}\nlog: {rate: 500}\nintegrator: {method: rk4, step: 2e-5}\n";

#[test]
fn modes_and_tips_have_columns_by_name_with_units() {
    let robot = tree("complete", 0.02, false);
    let simulation = Simulation::new(&robot, &scenario(RUN)).unwrap();
    let all = columns(&simulation.run_info());
    let unit = |name: &str| all.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("no {name}")).unit;
    assert_eq!(
        [unit("eta.upper.bending_y2"), unit("etad.upper.bending_y2"), unit("etadd.upper.bending_y2")],
        ["m", "m/s", "m/s^2"]
    );
    assert_eq!([unit("eta.upper.torsion1"), unit("etadd.upper.torsion1")], ["rad", "rad/s^2"]);
    assert_eq!([unit("tip.upper.x"), unit("tip.lower.rz")], ["m", "rad"]);
    let (_, table, _) = run(&robot, RUN);
    assert_eq!(table.columns, all);
}

#[test]
fn a_log_holds_modes_and_tips_and_gives_them_back() {
    let folder = std::env::temp_dir().join(format!("gyroflex_flexible_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (log, csv) = (folder.join("run.mcap"), folder.join("run.csv"));
    let robot = tree("complete", 0.02, true);
    let mut simulation = Simulation::new(&robot, &scenario(RUN)).unwrap();
    let info = simulation.run_info();
    let mut memory = MemoryRecorder::new(info.clone());
    let mut recorder = TeeRecorder::new()
        .with(&mut memory)
        .with(McapRecorder::create(&log, info.clone()).unwrap())
        .with(CsvRecorder::create(&csv, info).unwrap());
    simulation.run(&mut recorder, &mut |_| ControlFlow::Continue(())).unwrap();
    drop(recorder);
    let (written, read) = (memory.table(), read_states(&log).unwrap());
    assert!(read.complete);
    for column in &read.table.columns {
        assert_eq!(written.get(&column.name), read.table.get(&column.name), "{}", column.name);
    }
    assert!(read.table.get("tip.lower.ry").is_some() && read.table.get("etadd.upper.torsion1").is_some());
    let header = std::fs::read_to_string(&csv).unwrap().lines().next().unwrap().to_owned();
    assert!(header.contains("eta.lower.bending_z1 [m]") && header.contains("tip.upper.z [m]"), "{header}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn the_frame_of_a_joint_beyond_a_bent_link_is_where_the_tip_is() {
    let robot = tree("rigid", 0.0, false);
    let text = RUN.replace("initial: {", "initial: {q: [0, 0, 0], eta: [0.01, 0, 0, 0, 0, 0], ");
    let (_, table, simulation) = run(&robot, &text);
    let at = |name: &str| table.get(name).unwrap()[0];
    assert_eq!(simulation.initial_state().q[3], 0.01);
    // At rest the elbow's frame lies at its joint's origin in the upper link; the tip carries it along and turns it.
    let rest = [0.5, 0.02, 0.01];
    let moved = ["x", "y", "z"].map(|key| at(&format!("frame.lower.{key}")));
    let tip = ["x", "y", "z", "rx", "ry", "rz"].map(|key| at(&format!("tip.upper.{key}")));
    assert!(tip[1] > 0.01 && tip[5] > 0.01, "{tip:?}");
    // To first order in the deflection: displacement, and rotation about the tip at x = 0.5.
    let lever = [rest[0] - 0.5, rest[1], rest[2]];
    let turned = [
        tip[4] * lever[2] - tip[5] * lever[1],
        tip[5] * lever[0] - tip[3] * lever[2],
        tip[3] * lever[1] - tip[4] * lever[0],
    ];
    for i in 0..3 {
        let expected = rest[i] + tip[i] + turned[i];
        assert!((moved[i] - expected).abs() < tip[5] * tip[5] * 0.1, "{i}: {} {expected}", moved[i]);
    }
}
