//! Laws of scenario files.

use gyroflex_sim::load::Disk;
use gyroflex_sim::{ErrorKind, ScenarioFile, scenario_schema};
use serde_json::Value;
use std::path::{Path, PathBuf};

fn parse(yaml: &str) -> Result<ScenarioFile, gyroflex_sim::Error> {
    ScenarioFile::parse(yaml, Path::new("s.yaml"))
}

#[test]
fn every_scenario_of_the_project_loads() {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    let mut seen = 0;
    for robot in std::fs::read_dir(robots).unwrap().map(|e| e.unwrap().path()).filter(|p| p.is_dir()) {
        // Robots name a URDF, scenarios a robot.
        let names_robot = |p: &PathBuf| std::fs::read_to_string(p).unwrap().lines().any(|l| l.starts_with("robot:"));
        let yaml = |p: &PathBuf| p.extension().is_some_and(|e| e == "yaml") && names_robot(p);
        for path in std::fs::read_dir(&robot).unwrap().map(|e| e.unwrap().path()).filter(yaml) {
            let file = ScenarioFile::load(&Disk, &path).unwrap_or_else(|e| panic!("{e}"));
            assert!(file.robot_path().exists(), "{}", path.display());
            seen += 1;
        }
    }
    assert!(seen >= 5);
}

#[test]
fn unknown_keys_name_the_nearest_known_one() {
    let cases = [
        ("robot: r\nduraton: 1", "duration"),
        ("robot: r\nduration: 1\nlog: {rates: 1}", "rate"),
        ("robot: r\nduration: 1\nintegrator: {method: rk4, stepp: 1e-3}", "step"),
        ("robot: r\nduration: 1\nintegrator: {method: rk5, step: 1e-3}", "rk4"),
        ("robot: r\nduration: 1\ncontroller: {type: pd, kp: 1, kd: 1, ratee: 1}", "rate"),
        ("robot: r\nduration: 1\nreference: {j: {type: sine, amplitud: 1, frequency: 1}}", "amplitude"),
        ("robot: r\nduration: 1\nwrenches: [{link: l, forces: [0, 0, 1]}]", "force"),
        ("robot: r\nduration: 1\ninitial: {thetta: {}}", "theta"),
        ("robot: r\nduration: 1\nmodel: complet", "complete"),
    ];
    for (yaml, near) in cases {
        let error = parse(yaml).unwrap_err();
        assert_eq!(error.kind, ErrorKind::Yaml);
        assert!(error.remedy.contains(&format!("`{near}`")), "{yaml}: {error}");
    }
}

#[test]
fn numbers_that_make_no_sense_are_refused_with_their_key() {
    let cases = [
        ("duration: -1", "duration"),
        ("duration: 0", "duration"),
        ("duration: 1\nlog: {rate: 0}", "log.rate"),
        ("duration: 1\ncontroller: {type: pd, kp: -1, kd: 1}", "controller.kp"),
        ("duration: 1\ncontroller: {type: pd, rate: 0, kp: 1, kd: 1}", "controller.rate"),
        ("duration: 1\nintegrator: {method: rk4, step: 0}", "integrator.step"),
        ("duration: 1\nintegrator: {method: dopri5, rtol: -1}", "integrator.rtol"),
        ("duration: 1\nreference: {j: {type: quintic, from: 0, to: 1, duration: 0}}", "reference.j.duration"),
        ("duration: 1\nreference: {j: {type: zhao, amplitude: -1, omega: 1}}", "reference.j.amplitude"),
        ("duration: 1\nwrenches: [{link: l, start: 2, end: 1}]", "wrenches[0].end"),
    ];
    for (yaml, key) in cases {
        let error = parse(&format!("robot: r\n{yaml}")).unwrap_err();
        assert_eq!((error.kind, error.element.as_str()), (ErrorKind::Scenario, key), "{error}");
        assert!(error.file.starts_with("s.yaml:") && !error.remedy.is_empty(), "{error}");
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for yaml in [
        "duration: .nan",
        "duration: .inf",
        "duration: 1\ninitial: {q: {j: .nan}}",
        "duration: 1\ngravity: [0, 0, -.inf]",
    ] {
        let error = parse(&format!("robot: r\n{yaml}")).unwrap_err();
        assert!(error.problem.contains("not a finite number"), "{error}");
    }
}

#[test]
fn defaults_are_what_the_schema_says() {
    let file = parse("robot: r.yaml\nduration: 2").unwrap();
    let s = &file.scenario;
    assert_eq!((s.log.rate, s.integrator.name(), s.integrator.fixed_step()), (1000.0, "rk4", Some(1e-4)));
    assert_eq!(s.controller.rate(), None);
    assert!(s.wrenches.is_empty() && s.model.is_none() && s.gravity.is_none());
}

#[test]
fn every_key_is_documented_in_the_schema() {
    fn walk(value: &Value, path: &str) {
        if let Some(properties) = value.get("properties").and_then(Value::as_object) {
            for (key, property) in properties {
                // The tag of a choice is documented by the choices.
                let tag = property.get("const").is_some();
                assert!(tag || property.get("description").is_some(), "{path}.{key} has no description");
            }
        }
        match value {
            Value::Object(map) => map.iter().for_each(|(k, v)| walk(v, &format!("{path}.{k}"))),
            Value::Array(list) => list.iter().for_each(|v| walk(v, path)),
            _ => {}
        }
    }
    let schema = scenario_schema();
    assert!(schema["properties"]["duration"].is_object());
    walk(&schema, "");
}

#[test]
fn csv_reference_is_read_with_the_scenario() {
    let folder = std::env::temp_dir().join(format!("gyroflex-csv-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let scenario = folder.join("s.yaml");
    std::fs::write(&scenario, "robot: r\nduration: 1\nreference: {csv: way.csv}").unwrap();
    let arm = crate::arm::arm(2);
    let build = |csv: &str| {
        std::fs::write(folder.join("way.csv"), csv).unwrap();
        gyroflex_sim::Simulation::new(&arm, &ScenarioFile::load(&Disk, &scenario)?)
    };
    let fine = build("time, joint2\n0, 0.1\n0.5, 0.3\n1, 0.2\n").unwrap();
    assert_eq!((fine.initial_state().q[1], fine.warnings().len()), (0.1, 0));
    let short = build("time,joint2\n0,0.1\n0.5,0.3\n").unwrap();
    assert!(short.warnings()[0].message.contains("holds outside"));
    for (csv, words) in [
        ("time,joint3\n0,1\n1,2\n", "no joint `joint3`"),
        ("joint1,joint2\n0,1\n1,2\n", "no column `time`"),
        ("time,joint1\n0,1\n0,2\n", "does not come after"),
        ("time,joint1\n0,1\n1,x\n", "`x` is not a finite number"),
        ("time,joint1\n0,1\n1\n", "record"),
        ("time,joint1\n0,1\n", "fewer than two rows"),
        ("time,joint1,joint1\n0,1,2\n1,1,2\n", "twice"),
    ] {
        let error = build(csv).unwrap_err();
        assert!(error.problem.contains(words) && error.file.ends_with("way.csv"), "{error}");
    }
    std::fs::remove_file(folder.join("way.csv")).unwrap();
    let missing = ScenarioFile::load(&Disk, &scenario).unwrap_err().to_string();
    assert!(missing.contains("way.csv") && missing.contains("no such file"), "{missing}");
    std::fs::remove_dir_all(&folder).unwrap();
}
