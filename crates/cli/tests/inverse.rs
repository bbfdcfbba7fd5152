//! `gyroflex inverse` and `gyroflex compare` through the binary.

mod process;

use process::{folder, gyroflex, is_complete, project};
use serde_json::Value;

fn scenario(name: &str) -> String {
    project(&format!("robots/lwr/{name}")).display().to_string()
}

#[test]
fn inverse_writes_a_log_and_says_what_it_needs() {
    let here = folder("inverse");
    let step = scenario("step.yaml");
    let ended = gyroflex(&here, &["inverse", &step, "--duration", "0.1", "--json", "--csv", "step.csv"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(is_complete(&here.join("step.inverse.mcap")) && here.join("step.csv").exists());
    let summary: Value = serde_json::from_str(&ended.out).unwrap_or_else(|e| panic!("{e}: {}", ended.out));
    assert_eq!(summary["joints"][0]["derivatives_needed"], 6);
    assert_eq!(summary["joints"][0]["derivatives_given"], 8);
    assert_eq!(summary["stability"]["verdict"], "stable");
    assert_eq!(summary["samples"], 101);

    let reduced = gyroflex(&here, &["inverse", &step, "--duration", "0.1", "--json", "--model", "reduced"]);
    let summary: Value = serde_json::from_str(&reduced.out).unwrap_or_else(|e| panic!("{e}: {}", reduced.err));
    assert_eq!(summary["joints"][0]["derivatives_needed"], 3);
}

/// Damping in the inverse is the remedy for a robot that has none: fewer derivatives are enough.
#[test]
fn references_that_are_too_rough_are_refused_joint_by_joint() {
    let here = folder("rough");
    let undamped = project("robots/lwr/undamped.yaml").display().to_string();
    let text = format!(
        "robot: {undamped}\nduration: 0.05\nreference:\n  default: {{type: filtered_step, from: 0, to: 1, order: 7, cutoff: 2}}\n"
    );
    std::fs::write(here.join("rough.yaml"), text).expect("the folder can be written");
    let ended = gyroflex(&here, &["inverse", "rough.yaml"]);
    assert_eq!(ended.code, Some(1));
    for part in ["`joint1` needs 10 and has 7", "`joint7` needs 10 and has 7", "remedy:", "damping"] {
        assert!(ended.err.contains(part), "{part}: {}", ended.err);
    }
    let damped = gyroflex(&here, &["inverse", "rough.yaml", "--damping", "15"]);
    assert_eq!(damped.code, Some(0), "{}", damped.err);
    assert!(damped.out.contains("internal dynamics: stable"), "{}", damped.out);
}

#[test]
fn compare_prints_a_line_a_scenario_and_the_worst_of_all_plants() {
    let here = folder("compare");
    let (pd, inverse) = (scenario("compare/pd_gravity.yaml"), scenario("compare/two_dof.yaml"));
    let ended = gyroflex(&here, &["compare", &pd, &inverse, "--stiffness", "0.8"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(
        ended.out.contains("pd_gravity ") && ended.out.contains("two_dof ") && ended.out.contains("worst of 2 plants")
    );
    let wrong = gyroflex(&here, &["compare", &pd, "--tip", "tol"]);
    assert!(wrong.code == Some(1) && wrong.err.contains("`tool`"), "{}", wrong.err);
}
