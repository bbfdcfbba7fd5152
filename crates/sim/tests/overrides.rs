//! A key that is overridden is as if the file said so.

use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::load::{Disk, LoadOptions, Overrides, load, load_urdf_text};
use gyroflex_sim::record::{MemoryRecorder, Table};
use gyroflex_sim::{Robot, ScenarioFile, Simulation};
use serde_json::json;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

const URDF: &str = include_str!("../../../robots/planar_3r/planar_3r.urdf");
const DRIVES: &str = "\
urdf: planar_3r.urdf
gravity: [0, 0, 0]
drives:
  joint1: {rotor: {inertia: 1.0e-4}, gear_ratio: 100, transmission: {stiffness: 5.0e3, damping: 1e0}}
  joint2: {rotor: {inertia: 1.0e-4}, gear_ratio: 100, transmission: rigid}
constraints: {}
";

fn robot(drives: &str, overrides: Overrides) -> Result<Robot, Error> {
    load_urdf_text(URDF, "planar_3r.urdf", Some(drives), &LoadOptions { overrides, ..LoadOptions::default() })
}

fn set(text: &str) -> Overrides {
    text.parse().unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str) -> Error {
    let error = robot(DRIVES, set(text)).expect_err(text);
    assert!(!error.problem.is_empty() && !error.remedy.is_empty(), "{error:?}");
    error
}

/// The robot of a file that was edited instead.
fn edited(from: &str, to: &str) -> Robot {
    assert!(DRIVES.contains(from));
    robot(&DRIVES.replace(from, to), Overrides::new()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn an_overridden_robot_is_the_robot_of_the_edited_file() {
    for (key, from, to) in [
        ("drives.joint1.transmission.stiffness=7.25e3", "stiffness: 5.0e3", "stiffness: 7.25e3"),
        ("drives.joint1.transmission.cubic=1e4", "stiffness: 5.0e3", "stiffness: 5.0e3, cubic: 1e4"),
        (
            "drives.joint1.friction.motor.viscous=0.1",
            "gear_ratio: 100, transmission: {s",
            "gear_ratio: 100, friction: {motor: {viscous: 0.1}}, transmission: {s",
        ),
        ("drives.joint2.transmission={stiffness: 4000}", "transmission: rigid", "transmission: {stiffness: 4000}"),
        ("drives.joint1.transmission=rigid", "{stiffness: 5.0e3, damping: 1e0}", "rigid"),
        ("gravity=[0, -9.81, 0]", "gravity: [0, 0, 0]", "gravity: [0, -9.81, 0]"),
        ("gravity[1]=-9.81", "gravity: [0, 0, 0]", "gravity: [0, -9.81, 0]"),
        ("model=reduced", "urdf:", "model: reduced\nurdf:"),
    ] {
        let (ours, theirs) = (robot(DRIVES, set(key)).unwrap_or_else(|e| panic!("{e}")), edited(from, to));
        assert_eq!(format!("{:?}", ours.bodies), format!("{:?}", theirs.bodies), "{key}");
        assert_eq!((ours.gravity.to_array(), ours.fidelity), (theirs.gravity.to_array(), theirs.fidelity), "{key}");
    }
}

#[test]
fn the_table_says_which_numbers_are_overridden() {
    let robot = robot(DRIVES, set("drives.joint1.transmission.stiffness=7000")).unwrap();
    let row = |key: &str| robot.table.iter().find(|r| r.joint == "joint1" && r.key == key).unwrap();
    assert_eq!(row("transmission.stiffness").source, "override");
    assert_eq!(row("gear_ratio").source, "robot.yaml:4");
}

#[test]
fn later_overrides_win_and_a_urdf_alone_takes_drives() {
    let drive = set("drives.joint1.rotor.inertia=1e-4");
    let both = drive.with("drives.joint1.gear_ratio", 3.0).with("drives.joint1.gear_ratio", 5.0);
    let options = LoadOptions { overrides: both, ..LoadOptions::default() };
    let robot = load_urdf_text(URDF, "planar_3r.urdf", None, &options).unwrap();
    assert_eq!(robot.bodies[0].drive.unwrap().gear_ratio, 5.0);
    let folder = robots().join("planar_3r");
    let from_disk = load(&folder.join("planar_3r.urdf"), &options).unwrap();
    assert_eq!(from_disk.bodies[0].drive.unwrap().gear_ratio, 5.0);
}

#[test]
fn an_unknown_key_is_refused_with_the_nearest_known_one() {
    for (text, near) in [
        ("drives.joint1.transmission.stifness=1", "`stiffness`"),
        ("drives.joint1.gear_ration=1", "`gear_ratio`"),
        ("drivs.joint1.gear_ratio=1", "`drives`"),
        ("drives.joint11.gear_ratio=1", "`joint1`"),
    ] {
        let error = refused(text);
        assert!(error.to_string().contains(near), "{error}");
        assert!(text.starts_with(&error.element), "{error}");
        assert_eq!((error.kind, error.file.as_str()), (ErrorKind::Yaml, "override"), "{error}");
    }
    let error = set("contrller.kp=3").split().unwrap_err();
    assert!(error.remedy.contains("`controller`"), "{error}");
}

#[test]
fn what_could_not_be_written_in_the_file_is_refused() {
    for (text, words) in [
        ("drives.joint1.transmission.stiffness=soft", "drives.joint1.transmission.stiffness"),
        ("drives.joint1.transmission.stiffness=-1", "stiffness"),
        ("drives.joint2.transmission.stiffness=1e4", "`drives.joint2.transmission` is \"rigid\""),
        ("gravity[3]=1", "list of 3 items"),
        ("gravity.x=1", "list of 3 items"),
        ("drives..gear_ratio=1", "empty"),
        ("drives.=1", "empty"),
    ] {
        let error = refused(text).to_string();
        assert!(error.contains(words) && error.contains("override"), "{text}: {error}");
    }
    for text in ["controller.kp", "model=[", "duration=.nan", "duration=1e999"] {
        let error = text.parse::<Overrides>().expect_err(text);
        assert!(error.to_string().contains("KEY=VALUE"), "{error}");
    }
}

fn robots() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots")
}

fn run(overrides: &Overrides) -> (Simulation, Table) {
    let file = ScenarioFile::load_with(&Disk, &robots().join("planar_3r/track.yaml"), overrides)
        .unwrap_or_else(|e| panic!("{e}"));
    let robot = file.load_robot(&Disk, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(&robot, &file).unwrap_or_else(|e| panic!("{e}"));
    let mut memory = MemoryRecorder::new(simulation.run_info());
    simulation.run(&mut memory, &mut |_| ControlFlow::Continue(())).unwrap();
    let table = memory.table();
    (simulation, table)
}

#[test]
fn keys_of_a_scenario_are_its_own_first_and_then_its_robots() {
    let overrides: Overrides = [
        ("duration", json!(0.05)),
        ("gravity", json!([0.0, -1.0, 0.0])),
        ("robot.gravity", json!([0.0, -2.0, 0.0])),
        ("drives.joint2.transmission.stiffness", json!(4321.0)),
    ]
    .into_iter()
    .collect();
    let (simulation, _) = run(&overrides);
    assert_eq!(simulation.robot().gravity.to_array(), [0.0, -1.0, 0.0]);
    let said = simulation.run_info().metadata;
    for (key, value) in overrides.iter() {
        assert!(said.contains(&(format!("override.{key}"), value.to_string())), "{key} is not in {said:?}");
    }
    let file = ScenarioFile::load_with(&Disk, &robots().join("planar_3r/track.yaml"), &overrides).unwrap();
    let robot = file.load_robot(&Disk, &LoadOptions::default()).unwrap();
    assert_eq!(robot.gravity.to_array(), [0.0, -2.0, 0.0]);
}

#[test]
fn a_run_with_the_files_own_values_is_the_same_run() {
    let short = set("duration=0.05");
    let stiffness = {
        let (simulation, _) = run(&short);
        let row = simulation.robot().table.iter().find(|r| r.joint == "joint2" && r.key == "transmission.stiffness");
        row.unwrap().value.parse::<f64>().unwrap()
    };
    let plain = run(&short).1;
    let mut same = short.clone();
    same.set("drives.joint2.transmission.stiffness", stiffness);
    assert_eq!(run(&same).1.values, plain.values);
    same.set("drives.joint2.transmission.stiffness", 0.5 * stiffness);
    assert_ne!(run(&same).1.values, plain.values);
}
