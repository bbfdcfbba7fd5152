//! `gyroflex inverse` and `gyroflex compare` through the binary.

mod process;

use process::{ROBOT, folder, gyroflex, is_complete, pendulum, project, write};
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

/// The other remedy: two derivatives are enough for the motors' motion, and what the links do behind them is said.
#[test]
fn motors_are_prescribed_where_the_links_need_more_derivatives() {
    let here = folder("prescribed");
    let scenario = |name: &str, robot: &str, order: usize| {
        let robot = project(&format!("robots/lwr/{robot}.yaml")).display().to_string();
        let reference = format!("{{default: {{type: filtered_step, from: 0, to: 1, order: {order}, cutoff: 2}}}}");
        let text = format!("robot: {robot}\nduration: 0.02\nreference: {reference}\n");
        std::fs::write(here.join(name), text).expect("the folder can be written");
    };
    scenario("two.yaml", "undamped", 2);
    let refused = gyroflex(&here, &["inverse", "two.yaml"]);
    assert_eq!(refused.code, Some(1));
    assert!(
        refused.err.contains("`joint1` needs 10 and has 2") && refused.err.contains("2 are enough"),
        "{}",
        refused.err
    );

    let swinging = gyroflex(&here, &["inverse", "two.yaml", "--prescribe", "motor"]);
    assert_eq!(swinging.code, Some(0), "{}", swinging.err);
    assert!(swinging.out.contains("internal dynamics: undamped, joint `"), "{}", swinging.out);
    assert!(swinging.out.contains("2 of 2") && swinging.out.contains("`--damping`"), "{}", swinging.out);
    assert!(swinging.err.contains("warning: ") && swinging.err.contains("do not fade"), "{}", swinging.err);

    let damped = gyroflex(&here, &["inverse", "two.yaml", "--prescribe", "motor", "--damping", "15", "--json"]);
    assert_eq!(damped.code, Some(0), "{}", damped.err);
    assert!(!damped.err.contains("do not fade"), "{}", damped.err);
    let summary: Value = serde_json::from_str(&damped.out).unwrap_or_else(|e| panic!("{e}: {}", damped.out));
    assert_eq!(summary["stability"]["output"], "motor");
    assert_eq!(summary["stability"]["verdict"], "stable");
    assert!(summary["stability"]["slowest"]["zero"]["value"][0].as_f64().is_some_and(|rate| rate < 0.0));
    assert_eq!(summary["joints"][6]["derivatives_needed"], 2);

    scenario("one.yaml", "undamped", 1);
    let rough = gyroflex(&here, &["inverse", "one.yaml", "--prescribe", "motor"]);
    assert_eq!(rough.code, Some(1));
    for part in ["`joint1` needs 2 and has 1", "`joint7` needs 2 and has 1", "remedy:"] {
        assert!(rough.err.contains(part), "{part}: {}", rough.err);
    }
    let unknown = gyroflex(&here, &["inverse", "two.yaml", "--prescribe", "gear"]);
    assert_eq!(unknown.code, Some(2), "{}", unknown.err);
}

/// Without damping the links' inverse has no internal dynamics: derivatives stand in their place.
#[test]
fn inverse_of_an_undamped_robot_says_how_many_derivatives_it_takes() {
    let here = folder("undamped");
    let robot = project("robots/lwr/undamped.yaml").display().to_string();
    let reference = "{default: {type: filtered_step, from: 0, to: 0.1, order: 10, cutoff: 2}}";
    std::fs::write(here.join("ten.yaml"), format!("robot: {robot}\nduration: 0.02\nreference: {reference}\n"))
        .expect("the folder can be written");
    let ended = gyroflex(&here, &["inverse", "ten.yaml"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    for part in ["internal dynamics: none, 10 derivatives", "`--damping`", "`--prescribe motor`"] {
        assert!(ended.out.contains(part), "{part}: {}", ended.out);
    }
    assert!(!ended.err.contains("internal dynamics"), "{}", ended.err);
}

/// A pendulum whose spring is weaker than gravity falls off its motor when upright, but can be led itself.
#[test]
fn internal_dynamics_that_grow_are_warned_of() {
    let here = pendulum("unstable");
    write(&here, "robot.yaml", &ROBOT.replace("stiffness: 500, damping: 1", "stiffness: 2, damping: 1"));
    let motor = gyroflex(&here, &["inverse", "scenario.yaml", "--prescribe", "motor"]);
    assert_eq!(motor.code, Some(0), "{}", motor.err);
    for part in ["internal dynamics: unstable", "joint `hinge`, grows by", " at q = [", "`--prescribe link`"] {
        assert!(motor.out.contains(part), "{part}: {}", motor.out);
    }
    for part in ["warning: ", "`hinge` falls away", "`--prescribe link`"] {
        assert!(motor.err.contains(part), "{part}: {}", motor.err);
    }
    let link = gyroflex(&here, &["inverse", "scenario.yaml"]);
    assert!(link.code == Some(0) && !link.err.contains("warning: "), "{}", link.err);
    assert!(
        link.out.contains("internal dynamics: stable, the slowest, of joint `hinge`, fades by 2.0000e0 1/s"),
        "{}",
        link.out
    );
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
