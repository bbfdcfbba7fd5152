//! `gyroflex analyze`: what it prints, draws and refuses.

mod process;

use process::{folder, gyroflex, project};
use serde_json::Value;

fn puma(file: &str) -> String {
    project(&format!("robots/puma560/{file}")).to_str().expect("a path in UTF-8").to_owned()
}

#[test]
fn a_log_is_analysed_as_the_scenario_it_is_of() {
    let here = folder("analyze_log");
    let (robot, scenario) = (puma("robot.yaml"), puma("push.yaml"));
    let run = gyroflex(&here, &["-q", "simulate", &scenario, "--model", "complete", "-o", "run.mcap"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    let ask = |args: &[&str]| -> Value {
        let ended = gyroflex(&here, &[&["-q", "analyze", &robot, "--json"], args].concat());
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        serde_json::from_str(&ended.out).expect("--json prints JSON")
    };
    let (log, simulated) = (ask(&["--log", "run.mcap"]), ask(&["--scenario", &scenario]));
    for key in ["joints", "significance", "samples", "verdict"] {
        assert_eq!(log[key], simulated[key], "{key}");
    }
}

#[test]
fn the_table_ends_with_a_verdict_and_the_picture_is_drawn() {
    let here = folder("analyze_table");
    for file in ["a.svg", "a.png"] {
        let ended = gyroflex(&here, &["analyze", &puma("robot.yaml"), "--bounds", "--samples", "50", "--plot", file]);
        assert_eq!(ended.code, Some(0), "{}", ended.err);
        assert!(ended.out.trim_end().lines().last().is_some_and(|l| l.starts_with("verdict: ")), "{}", ended.out);
        assert!(ended.out.contains("largest ||g||"), "{}", ended.out);
        let bytes = std::fs::read(here.join(file)).expect("the picture is there");
        assert!(bytes.starts_with(b"<svg") || bytes.starts_with(b"\x89PNG"));
    }
}

#[test]
fn what_means_nothing_is_refused_with_a_reason() {
    let here = folder("analyze_refuses");
    let robot = puma("robot.yaml");
    for (args, code, word) in [
        (["--speed", "-3"], 2, "--speed"),
        (["--threshold", "nan"], 2, "above zero"),
        (["--plot", "a.pdf"], 2, ".svg or .png"),
        (["--log", "none.mcap"], 1, "none.mcap"),
        (["--log", &robot], 1, "robot.yaml"),
    ] {
        let ended = gyroflex(&here, &[&["-q", "analyze", &robot], &args[..]].concat());
        assert_eq!(ended.code, Some(code), "{args:?} {}", ended.err);
        assert!(ended.err.contains(word), "{args:?} {}", ended.err);
    }
}
