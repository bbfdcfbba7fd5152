//! `gyroflex sweep`, and `--set` of the other commands: a key that is set is as if the file said so.

mod process;

use process::{gyroflex, pendulum, write};
use std::fs;
use std::path::Path;

const SWEEP: [&str; 6] = [
    "sweep",
    "scenario.yaml",
    "--set",
    "drives.hinge.transmission.stiffness=100:1e4:5:log",
    "--set",
    "controller.kd=10,20",
];

fn sweep(here: &Path, more: &[&str]) -> process::Ended {
    gyroflex(here, &[&SWEEP[..], more].concat())
}

fn table(file: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(file).expect("the table was written");
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn every_row_is_the_run_with_those_values() {
    let here = pendulum("sweep_rows");
    let ended = sweep(&here, &["--json"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let told: serde_json::Value = serde_json::from_str(&ended.out).expect("it is JSON");
    assert_eq!(
        (&told["runs"], &told["failed"], &told["output"]),
        (&10.into(), &0.into(), &"scenario.sweep.csv".into())
    );
    let rows = table(&here.join("scenario.sweep.csv"));
    assert_eq!(rows.len(), 11);
    let column = |name: &str| {
        rows[0].iter().position(|head| head == name).unwrap_or_else(|| panic!("no {name} in {:?}", rows[0]))
    };
    for (i, row) in rows[1..].iter().enumerate() {
        let stiffness: f64 = row[0].parse().expect("it is a number");
        assert!((stiffness / (100.0 * 10_f64.powf(0.5 * (i / 2) as f64)) - 1.0).abs() < 1e-12, "{row:?}");
        assert_eq!(row[1], ["10", "20"][i % 2]);
        let (stiffness, kd) =
            (format!("drives.hinge.transmission.stiffness={}", row[0]), format!("controller.kd={}", row[1]));
        let ended = gyroflex(&here, &["simulate", "scenario.yaml", "--json", "--set", &stiffness, "--set", &kd]);
        let run: serde_json::Value = serde_json::from_str(&ended.out).expect("it is JSON");
        for measure in ["rms_tracking_error", "peak_tracking_error", "peak_torque", "saturation"] {
            let ours: f64 = row[column(&format!("{measure}.hinge"))].parse().expect("it is a number");
            assert_eq!(Some(ours), run["joints"][0][measure].as_f64(), "{measure} of {row:?}");
        }
        assert_eq!(row.last().map(String::as_str), Some(""));
    }
}

#[test]
fn the_table_is_the_same_on_any_number_of_threads_and_after_any_interruption() {
    let here = pendulum("sweep_resumes");
    assert_eq!(sweep(&here, &["-o", "whole.csv", "--jobs", "1"]).code, Some(0));
    let whole = fs::read_to_string(here.join("whole.csv")).expect("it was written");
    assert_eq!(sweep(&here, &["-o", "threads.csv", "--jobs", "4"]).code, Some(0));
    assert_eq!(fs::read_to_string(here.join("threads.csv")).expect("it was written"), whole);
    // Stopped anywhere, in the middle of a line too.
    for kept in [0, 10, whole.len() / 3, whole.len() / 2, whole.len() - 1, whole.len()] {
        let part = write(&here, "part.csv", &whole[..kept]);
        let ended = sweep(&here, &["-o", "part.csv"]);
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        assert_eq!(fs::read_to_string(part).expect("it is there"), whole, "{kept} bytes were kept");
    }
}

#[test]
fn a_table_of_something_else_is_not_written_over() {
    let here = pendulum("sweep_spares");
    assert_eq!(sweep(&here, &["-o", "table.csv"]).code, Some(0));
    let whole = fs::read_to_string(here.join("table.csv")).expect("it was written");
    let part = &whole[..whole[..whole.len() - 1].rfind('\n').expect("it has lines") + 1];
    let refused = |ended: process::Ended, words: &str| {
        assert_eq!(ended.code, Some(1), "{}", ended.out);
        assert!(ended.err.contains(words) && ended.err.contains("remedy: "), "{}", ended.err);
    };
    write(&here, "table.csv", part);
    refused(
        gyroflex(&here, &["sweep", "scenario.yaml", "--set", "controller.kp=1,2", "-o", "table.csv"]),
        "these keys",
    );
    let other = [
        "sweep",
        "scenario.yaml",
        "--set",
        "drives.hinge.transmission.stiffness=1:2:5",
        "--set",
        "controller.kd=10,20",
        "-o",
        "table.csv",
    ];
    refused(gyroflex(&here, &other), "row 1 has other values");
    let scenario = fs::read_to_string(here.join("scenario.yaml")).expect("it is there");
    write(&here, "scenario.yaml", &scenario.replace("kp: 100", "kp: 101"));
    refused(sweep(&here, &["-o", "table.csv"]), "comes out otherwise");
    assert_eq!(fs::read_to_string(here.join("table.csv")).expect("it is there"), part);
    write(&here, "notes.csv", "mine\n");
    refused(sweep(&here, &["-o", "notes.csv"]), "these keys");
    refused(sweep(&here, &["-o", "scenario.yaml"]), "scenario");
}

#[test]
fn a_run_that_cannot_be_is_a_row_and_a_key_that_is_not_known_ends_the_sweep() {
    let here = pendulum("sweep_fails");
    // The first is too stiff for the step, and has no measures to name the columns by.
    let ended =
        gyroflex(&here, &["sweep", "scenario.yaml", "--set", "drives.hinge.transmission.stiffness=1e12,500,1e13"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.out.contains("2 of them failed"), "{}", ended.out);
    let rows = fs::read_to_string(here.join("scenario.sweep.csv")).expect("it was written");
    let errors: Vec<bool> = rows.lines().skip(1).map(|row| row.contains("step")).collect();
    assert_eq!(errors, [true, false, true], "{rows}");
    let ended = gyroflex(
        &here,
        &["sweep", "scenario.yaml", "--set", "drives.hinge.transmission.stifness=1,2", "-o", "none.csv"],
    );
    assert_eq!(ended.code, Some(1));
    assert!(ended.err.contains("`stiffness`"), "{}", ended.err);
    for values in [
        "controller.kd=",
        "controller.kd=1:2",
        "controller.kd=0:1:5:log",
        "controller.kd=1:2:0",
        "controller.kd",
        "controller.kd=[1",
    ] {
        assert_eq!(gyroflex(&here, &["sweep", "scenario.yaml", "--set", values]).code, Some(2), "{values}");
    }
}

#[test]
fn commands_take_a_key_that_is_set_as_if_the_file_said_so() {
    let here = pendulum("set");
    let robot = fs::read_to_string(here.join("robot.yaml")).expect("it is there");
    write(&here, "edited.yaml", &robot.replace("stiffness: 500", "stiffness: 750"));
    let set = ["--set", "drives.hinge.transmission.stiffness=750"];
    for command in ["modes", "linearize"] {
        let ours = gyroflex(&here, &[&[command, "robot.yaml", "--json"], &set[..]].concat());
        let theirs = gyroflex(&here, &[command, "edited.yaml", "--json"]);
        assert_eq!((ours.code, &ours.out), (Some(0), &theirs.out), "{}", ours.err);
        assert_ne!(ours.out, gyroflex(&here, &[command, "robot.yaml", "--json"]).out);
    }
    let info = gyroflex(&here, &[&["info", "robot.yaml"], &set[..]].concat());
    assert!(info.out.contains("override"), "{}", info.out);
    let refused = gyroflex(&here, &["info", "robot.yaml", "--set", "drives.hinge.gear_ration=5"]);
    assert!(refused.code == Some(1) && refused.err.contains("`gear_ratio`"), "{}", refused.err);
    assert_eq!(gyroflex(&here, &["info", "robot.yaml", "--set", "model"]).code, Some(2));
}
