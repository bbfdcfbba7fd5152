//! Laws of the calculator's input: every wrong line is refused with the key, what it holds and what it should hold.

mod arm;

use arm::arm;
use gyroflex::model::Fidelity;
use gyroflex_sim::Error;
use gyroflex_sim::eval::{Evaluator, Options};

const FORWARD: &str =
    r#"{"q": [0.1, 0.2, 0.3], "qd": [1, 2, 3], "theta": [0.1, 0, 0], "thetad": [1, 0, 0], "tau": [1, 2, 3]}"#;
const ALL: Options = Options { fidelity: None, matrices: true, energy: true, significance: true, motor_side: false };

fn evaluator(options: Options) -> Evaluator {
    Evaluator::new(arm(false), options).expect("the arm is physical")
}

fn refused(line: &str) -> Error {
    match evaluator(Options::default()).evaluate_line(line) {
        Err(error) => error,
        Ok(answer) => panic!("{line} is answered with {answer}"),
    }
}

fn json(options: Options, line: &str) -> serde_json::Value {
    let answer = evaluator(options).evaluate_line(line).unwrap_or_else(|e| panic!("{line}: {e}"));
    serde_json::from_str(&answer).expect("answers are JSON")
}

#[test]
fn a_wrong_length_names_key_given_and_expected_length() {
    for (key, wrong) in [("q", "[1]"), ("qd", "[1, 2, 3, 4]"), ("theta", "[]"), ("thetad", "[1, 2]"), ("tau", "[1, 2]")]
    {
        let mut line: serde_json::Value = serde_json::from_str(FORWARD).expect("JSON");
        line[key] = serde_json::from_str(wrong).expect("JSON");
        let given = line[key].as_array().map_or(0, Vec::len);
        let error = refused(&line.to_string());
        assert_eq!(error.element, key);
        assert!(error.problem.contains(&format!("{given} entries")) && error.problem.contains('3'), "{error}");
        assert!(error.remedy.contains("shoulder, elbow, slide"), "{error}");
    }
}

#[test]
fn an_unknown_key_is_answered_with_the_nearest_one() {
    let error = refused(r#"{"q": [0, 0, 0], "thetta": [0, 0, 0]}"#);
    assert!(error.problem.contains("`thetta`") && error.remedy.contains("`theta`"), "{error}");
    let error = refused(r#"{"q": [0, 0, 0], "wrenches": [{"link": "tool", "forc": [0, 0, 1]}]}"#);
    assert!(error.element == "wrenches[0].forc" && error.remedy.contains("`force`"), "{error}");
    let error = refused(
        r#"{"q": [0, 0, 0], "qd": [0, 0, 0], "theta": [0, 0, 0], "thetad": [0, 0, 0], "tau": [0, 0, 0],
        "wrenches": [{"link": "tol", "force": [0, 0, 1]}]}"#,
    );
    assert!(error.problem.contains("`tol`") && error.remedy.contains("`tool`"), "{error}");
}

#[test]
fn what_is_not_a_finite_number_is_refused_by_name() {
    for bad in ["NaN", "Infinity", "-Infinity", "1e999", "null", "\"1\"", "[1]", "true"] {
        let error = refused(&FORWARD.replace("\"qd\": [1, 2, 3]", &format!("\"qd\": [1, {bad}, 3]")));
        assert!(error.element.starts_with("qd"), "{bad}: {error}");
        assert!(!error.remedy.is_empty(), "{bad}: {error}");
    }
}

#[test]
fn what_is_not_an_object_is_refused() {
    for bad in ["[]", "3", "\"q\"", "null", "{", "}", "{\"q\"}", "{\"q\": [0, 0, 0]", "{} {}", "\u{feff}{}"] {
        assert!(!refused(bad).remedy.is_empty(), "{bad}");
    }
    let deep = "[".repeat(100_000);
    assert!(!refused(&deep).remedy.is_empty());
    assert!(refused(r#"{"q": [0, 0, 0], "q": [0, 0, 0]}"#).problem.contains("given twice"));
}

#[test]
fn forward_and_inverse_exclude_each_other_and_one_must_be_asked_for() {
    let both = FORWARD.replace("\"tau\"", "\"qdd\": [0, 0, 0], \"tau\"");
    assert!(refused(&both).problem.contains("both"));
    assert!(refused(r#"{"q": [0, 0, 0], "qd": [0, 0, 0]}"#).problem.contains("neither"));
}

#[test]
fn a_key_without_effect_is_refused() {
    assert_eq!(refused(&FORWARD.replace("\"tau\"", "\"thetadd\": [0, 0, 0], \"tau\"")).element, "thetadd");
    for key in ["thetadd", "tau_ext"] {
        let line = format!(r#"{{"q": [0, 0, 0], "{key}": [0, 0, 0]}}"#);
        let error = evaluator(Options { matrices: true, ..Options::default() }).evaluate_line(&line);
        assert_eq!(error.expect_err("no effect").element, key);
    }
    let on_the_base = FORWARD.replace("\"tau\"", "\"wrenches\": [{\"link\": \"base\", \"force\": [1, 0, 0]}], \"tau\"");
    assert!(refused(&on_the_base).problem.contains("does not move"));
}

#[test]
fn motor_states_are_needed_exactly_in_the_elastic_models() {
    let line = r#"{"q": [0, 0, 0], "qd": [0, 0, 0], "tau": [0, 0, 0]}"#;
    for fidelity in Fidelity::ALL {
        let answer = evaluator(Options { fidelity: Some(fidelity), ..Options::default() }).evaluate_line(line);
        assert_eq!(answer.is_err(), fidelity.is_elastic(), "{}", fidelity.name());
        if let Err(error) = answer {
            assert!(error.element == "theta" && error.problem.contains("elastic"), "{error}");
        }
    }
}

#[test]
fn motor_entries_of_joints_without_an_elastic_drive_are_ignored() {
    let other = FORWARD.replace("\"theta\": [0.1, 0, 0]", "\"theta\": [0.1, 7, -8]");
    assert_ne!(other, FORWARD);
    assert_eq!(json(ALL, FORWARD), json(ALL, &other));
}

#[test]
fn positions_alone_are_enough_for_matrices_and_significance() {
    let options = Options { energy: false, ..ALL };
    let answer = json(options, r#"{"q": [0.1, 0.2, 0.3]}"#);
    let keys: Vec<&str> = answer.as_object().expect("an object").keys().map(String::as_str).collect();
    assert_eq!(keys, ["M", "S", "B", "g", "significance"]);
    assert!(answer["significance"]["r_s"].is_null());
    let error = evaluator(ALL).evaluate_line(r#"{"q": [0.1, 0.2, 0.3]}"#).expect_err("the energy needs velocities");
    assert_eq!(error.element, "qd");
}

#[test]
fn a_floating_root_may_be_left_out_of_motor_vectors() {
    let mut evaluator = Evaluator::new(arm(true), Options::default()).expect("the arm is physical");
    let pose = "0, 0, 1, 0, 0, 0, 1";
    let line = |motors: &str| {
        format!(
            r#"{{"q": [{pose}, 0.1, 0.2, 0.3], "qd": [0, 0, 0, 0, 0, 0, 1, 2, 3], "theta": [{motors}0.1, 0, 0],
            "thetad": [{motors}1, 0, 0], "tau": [{motors}1, 2, 3]}}"#
        )
    };
    let short = evaluator.evaluate_line(&line("")).expect("short vectors");
    let long = evaluator.evaluate_line(&line("0, 0, 0, 0, 0, 0, ")).expect("long vectors");
    assert_eq!(short, long);
    let error = evaluator.evaluate_line(&line("0, ")).expect_err("neither");
    assert!(
        error.problem.contains("4 entries") && error.problem.contains('9') && error.problem.contains('3'),
        "{error}"
    );
}

#[test]
fn the_quaternion_of_a_floating_root_must_have_unit_length() {
    let mut evaluator =
        Evaluator::new(arm(true), Options { matrices: true, ..Options::default() }).expect("the arm is physical");
    let mut at = |scale: f64| {
        let [x, y, z, w] = [0.2, -0.4, 0.8, 0.4].map(|c| c * scale);
        evaluator.evaluate_line(&format!(r#"{{"q": [0, 0, 0, {x}, {y}, {z}, {w}, 0, 0, 0]}}"#))
    };
    assert!(at(1.01).expect_err("too long").problem.contains("quaternion"));
    assert!(at(0.0).is_err());
    let matrix = |line: String| {
        serde_json::from_str::<serde_json::Value>(&line).expect("JSON")["M"][0][0].as_f64().expect("a number")
    };
    let exact = matrix(at(1.0).expect("exact"));
    let rounded = matrix(at(1.0 + 4e-7).expect("rounded"));
    assert!((rounded - exact).abs() <= 1e-14 * exact.abs(), "rounding of the quaternion shows: {exact} {rounded}");
}

#[test]
fn a_result_that_is_not_finite_is_an_error_naming_the_joint() {
    let error = refused(&FORWARD.replace("\"tau\": [1, 2, 3]", "\"tau\": [1, 2, 1e308], \"tau_ext\": [0, 0, 1e308]"));
    assert!(error.element.contains("joint `") && error.problem.contains("not a finite number"), "{error}");
}

#[test]
fn no_part_of_a_line_is_answered_and_none_panics() {
    let mut evaluator = evaluator(ALL);
    let line = FORWARD.replace("\"tau\"", "\"wrenches\": [{\"link\": \"tool\", \"force\": [0, 0, 1]}], \"tau\"");
    assert!(evaluator.evaluate_line(&line).is_ok());
    for end in 0..line.len() {
        assert!(evaluator.evaluate_line(&line[..end]).is_err(), "{}", &line[..end]);
        assert!(evaluator.evaluate_line(&line[end + 1..]).is_err(), "{}", &line[end + 1..]);
    }
}
