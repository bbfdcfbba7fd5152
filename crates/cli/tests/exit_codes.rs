//! Laws of exit codes and of what goes to which stream.

mod process;

use process::{folder, gyroflex, is_complete, pendulum, write};

#[test]
fn a_wrong_command_line_ends_with_2() {
    let here = folder("usage");
    for args in [
        &[][..],
        &["dance"],
        &["eval"],
        &["info", "--jsn", "robot.urdf"],
        &["simulate", "--model", "spong"],
        &["simulate", "--duration", "nan"],
        &["simulate", "--duration", "-1"],
        &["bench", "robot.urdf", "--calls", "0"],
        &["schema", "universe"],
        &["linearize", "robot.urdf", "--zoh", "0"],
        &["linearize", "robot.urdf", "--at", "1"],
        &["linearize", "robot.urdf", "--scenario", "scenario.yaml"],
        &["modes", "robot.urdf", "--plot", "modes.pdf"],
        &["frf", "robot.urdf"],
        &["frf", "robot.urdf", "--joint", "a", "--points", "1"],
        &["export", "robot.urdf"],
        &["export", "--rust", "robot.urdf", "--scalar", "f16"],
    ] {
        let ended = gyroflex(&here, args);
        assert_eq!(ended.code, Some(2), "{args:?}: {}", ended.err);
        assert!(
            ended.out.is_empty() && ended.err.contains("Usage") || ended.err.contains("--help"),
            "{args:?}: {}",
            ended.err
        );
    }
}

#[test]
fn help_and_version_end_with_0_on_standard_output_and_document_the_exit_codes() {
    let here = folder("help");
    let help = gyroflex(&here, &["--help"]);
    assert_eq!(help.code, Some(0));
    assert!(
        help.err.is_empty() && ["  0 ", "  1 ", "  2 ", "  130 "].iter().all(|c| help.out.contains(c)),
        "{}",
        help.out
    );
    for command in ["simulate", "info", "eval", "linearize", "modes", "frf", "bench", "export", "schema", "completions"]
    {
        let help = gyroflex(&here, &[command, "--help"]);
        assert_eq!(help.code, Some(0));
        assert!(help.out.contains("Example"), "{command} shows no example");
    }
    assert_eq!(gyroflex(&here, &["--version"]).out.trim(), format!("gyroflex {}", env!("CARGO_PKG_VERSION")));
}

#[test]
fn a_missing_file_ends_with_1_and_is_named() {
    let here = folder("missing");
    for args in [&["info", "ghost.urdf"][..], &["eval", "ghost.yaml", "--state", "-"], &["simulate", "ghost.yaml"]] {
        let ended = gyroflex(&here, args);
        assert_eq!(ended.code, Some(1), "{args:?}");
        assert!(ended.out.is_empty() && ended.err.contains("ghost.") && ended.err.contains("remedy:"), "{}", ended.err);
    }
    let here = pendulum("missing_state");
    let ended = gyroflex(&here, &["eval", "robot.yaml", "--state", "ghost.jsonl"]);
    assert!(
        ended.code == Some(1) && ended.err.contains("ghost.jsonl") && ended.err.contains("remedy:"),
        "{}",
        ended.err
    );
}

#[test]
fn a_simulation_ends_with_0_its_summary_on_standard_output_and_a_complete_log() {
    let here = pendulum("simulate");
    let ended = gyroflex(&here, &["simulate", "scenario.yaml", "--csv", "run.csv"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.out.contains("hinge") && ended.out.contains("scenario.mcap"), "{}", ended.out);
    assert!(ended.err.contains("Foxglove") && !ended.out.contains("Foxglove"));
    assert!(is_complete(&here.join("scenario.mcap")));
    assert!(here.join("run.csv").exists());
}

#[test]
fn quiet_leaves_standard_error_empty() {
    let here = pendulum("quiet");
    for args in [&["simulate", "scenario.yaml", "--quiet"][..], &["-q", "info", "robot.yaml"]] {
        let ended = gyroflex(&here, args);
        assert_eq!((ended.code, ended.err.as_str()), (Some(0), ""), "{args:?}");
        assert!(!ended.out.is_empty());
    }
}

#[test]
fn the_json_summary_is_json_and_nothing_else() {
    let here = pendulum("json");
    let ended = gyroflex(
        &here,
        &["simulate", "scenario.yaml", "--json", "-o", "run.mcap", "--duration", "0.1", "--model", "reduced"],
    );
    let summary: serde_json::Value = serde_json::from_str(&ended.out).expect("the summary is JSON");
    assert_eq!(summary["log"], "run.mcap");
    assert_eq!(summary["model"], "reduced");
    assert_eq!(summary["end_time"], 0.1);
    assert_eq!(summary["joints"][0]["name"], "hinge");
}

#[test]
fn a_diverging_run_ends_with_1_names_joint_and_time_and_keeps_its_log() {
    let here = pendulum("diverged");
    // Far more damping than a sampled controller can have: every tick overshoots more than the one before.
    let unstable = process::SCENARIO.replace("kd: 10", "kd: 1.0e+7");
    write(&here, "scenario.yaml", &unstable);
    let ended = gyroflex(&here, &["simulate", "scenario.yaml", "-o", "kept.mcap"]);
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    assert!(
        ended.err.contains("joint `hinge`") && ended.err.contains("t = ") && ended.err.contains("kept.mcap"),
        "{}",
        ended.err
    );
    assert!(is_complete(&here.join("kept.mcap")));
}

#[test]
fn a_log_that_cannot_be_written_ends_with_1_before_the_run() {
    let here = pendulum("unwritable");
    let ended = gyroflex(&here, &["simulate", "scenario.yaml", "-o", "no/such/folder/run.mcap"]);
    assert_eq!(ended.code, Some(1));
    assert!(ended.err.contains("no/such/folder/run.mcap") && ended.err.contains("remedy:"), "{}", ended.err);
}

#[test]
fn the_scenario_is_never_overwritten() {
    let here = pendulum("overwrite");
    for args in [
        &["simulate", "scenario.yaml", "-o", "./scenario.yaml"][..],
        &["simulate", "scenario.yaml", "-o", "a", "--csv", "a"],
    ] {
        let ended = gyroflex(&here, args);
        assert!(ended.code == Some(1) && ended.err.contains("remedy:"), "{args:?}: {}", ended.err);
    }
    assert_eq!(std::fs::read_to_string(here.join("scenario.yaml")).expect("still there"), process::SCENARIO);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_with_130_and_a_complete_log() {
    let here = pendulum("interrupt");
    let child = process::start(&here, &["simulate", "scenario.yaml", "--duration", "1e6"]);
    let log = here.join("scenario.mcap");
    // The log grows by chunks once the run is on its way.
    let deadline = std::time::Instant::now() + std::time::Duration::from_secs(60);
    while std::fs::metadata(&log).map_or(0, |m| m.len()) < 100_000 {
        assert!(std::time::Instant::now() < deadline, "the run does not start");
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.expect("there is a `kill`").success());
    let ended = process::end(child);
    assert_eq!(ended.code, Some(130), "{}", ended.err);
    assert!(ended.err.contains("interrupted at t = "), "{}", ended.err);
    assert!(is_complete(&log));
}

#[test]
fn schemas_are_json_and_completions_mention_every_command() {
    let here = folder("schema");
    for file in ["robot", "scenario"] {
        let ended = gyroflex(&here, &["schema", file]);
        let schema: serde_json::Value = serde_json::from_str(&ended.out).expect("a schema is JSON");
        assert_eq!(schema["type"], "object", "{file}");
        assert_eq!(schema["additionalProperties"], false, "{file}");
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = gyroflex(&here, &["completions", shell]).out;
        assert!(["simulate", "info", "eval", "schema"].iter().all(|c| script.contains(c)), "{shell}");
    }
}
