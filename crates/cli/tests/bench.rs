//! Laws of `gyroflex bench`: what it prints, and how it ends.

mod process;

use process::{end, gyroflex, pendulum, start};
use serde_json::Value;
use std::process::Command;
use std::time::Duration;

#[test]
fn every_model_and_algorithm_has_its_times_in_order() {
    let here = pendulum("bench_json");
    let ended = gyroflex(&here, &["bench", "robot.yaml", "--calls", "2000", "--json"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let report: Value = serde_json::from_str(&ended.out).expect("--json prints JSON");
    assert_eq!((&report["calls"], &report["nv"]), (&Value::from(2000), &Value::from(1)));
    let rows = report["rows"].as_array().expect("rows are an array");
    assert_eq!(rows.len(), 4 * 6);
    for row in rows {
        let [median, p999, max] = ["median_us", "p999_us", "max_us"].map(|key| row[key].as_f64().expect("a number"));
        assert!(0.0 <= median && median <= p999 && p999 <= max, "{row}");
    }
}

#[test]
fn the_table_has_the_model_asked_for_and_says_what_it_ran_on() {
    let here = pendulum("bench_table");
    let ended = gyroflex(&here, &["bench", "robot.yaml", "--calls", "500", "--model", "rigid_reflected"]);
    assert_eq!((ended.code, ended.err.as_str()), (Some(0), ""));
    assert_eq!(ended.out.matches("rigid_reflected").count(), 6, "{}", ended.out);
    assert!(!ended.out.contains("complete") && ended.out.contains("instructions: "), "{}", ended.out);
    // Without drives the four models are one.
    let ended = gyroflex(&here, &["bench", "pendulum.urdf", "--calls", "500"]);
    assert_eq!(ended.out.matches("complete").count(), 6, "{}", ended.out);
}

#[cfg(unix)]
#[test]
fn interrupted_it_prints_what_it_has_and_ends_with_130() {
    let here = pendulum("bench_interrupted");
    let child = start(&here, &["bench", "robot.yaml", "--calls", "100000000"]);
    std::thread::sleep(Duration::from_millis(700));
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(killed.success());
    let ended = end(child);
    assert_eq!(ended.code, Some(130), "{}", ended.err);
    assert!(
        ended.err.contains("interrupted") && ended.out.contains("nothing was finished"),
        "{}{}",
        ended.out,
        ended.err
    );
}
