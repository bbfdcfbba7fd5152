//! The calculator against reference cases of two independent derivations (see their README), through URDF, drives YAML and
//! JSON lines, motor side.

use gyroflex::model::Fidelity;
use gyroflex_sim::eval::{Evaluator, Options};
use gyroflex_sim::load::{LoadOptions, load_urdf_text};
use serde_json::{Map, Value, json};
use std::path::PathBuf;

const TOLERANCE: f64 = 1e-9;
const ROBOTS: [&str; 2] = ["r2", "r6_gyro"];

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../testkit/tests/reference")
}

fn case(robot: &str, kind: &str) -> Value {
    let path = folder().join(format!("{robot}__{kind}.json"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

fn list(v: &Value) -> &[Value] {
    v.as_array().unwrap_or_else(|| panic!("{v} is a list"))
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("{v} is a number"))
}

/// The drives YAML that says what a case says; JSON is YAML.
fn drives_yaml(case: &Value) -> String {
    let robot = &case["robot"];
    let friction = |f: &Value| match f {
        Value::Null => json!({}),
        f => json!({"viscous": f["viscous"], "coulomb": f["coulomb"], "smoothing_velocity": f["tanh_velocity"]}),
    };
    let mut drives = Map::new();
    for a in list(&robot["actuators"]) {
        let mut rotor = json!({
            "inertia": a["rotor_inertia_axial"],
            "mass": a["rotor_mass"],
            "transverse_inertia": a["rotor_inertia_transverse"],
        });
        if !a["mount"].is_null() {
            rotor["mount"] = json!({"xyz": a["mount"]["xyz"], "rpy": a["mount"]["rpy"], "axis": a["axis"]});
        }
        let mut transmission =
            json!({"stiffness": a["stiffness"], "cubic": a["cubic_stiffness"], "damping": a["damping"]});
        let error = &a["transmission_error"];
        if !error.is_null() {
            transmission["error"] = json!({
                "amplitude": error["amplitude"],
                "cycles_per_rotor_turn": error["multiplier"],
                "phase": error["phase"],
            });
        }
        let drive = json!({
            "rotor": rotor,
            "gear_ratio": a["gear_ratio"],
            "transmission": transmission,
            "friction": {"motor": friction(&a["motor_friction"]), "link": friction(&a["link_friction"])},
        });
        drives.insert(a["joint"].as_str().expect("a joint has a name").to_owned(), drive);
    }
    json!({"urdf": "robot.urdf", "gravity": robot["gravity"], "drives": drives}).to_string()
}

fn evaluator(case: &Value, options: Options) -> Evaluator {
    let file = case["robot"]["urdf_file"].as_str().expect("a case names its URDF");
    let urdf = std::fs::read_to_string(folder().join(file)).expect("the URDF is beside the cases");
    let robot = load_urdf_text(&urdf, file, Some(&drives_yaml(case)), &LoadOptions::default());
    Evaluator::new(robot.unwrap_or_else(|e| panic!("{e}")), Options { motor_side: true, ..options })
        .unwrap_or_else(|e| panic!("{e}"))
}

fn answer(evaluator: &mut Evaluator, line: Value) -> Value {
    let answer = evaluator.evaluate_line(&line.to_string()).unwrap_or_else(|e| panic!("{e}"));
    serde_json::from_str(&answer).expect("answers are JSON")
}

/// Numbers of nested lists in order, relative to the largest.
fn assert_same(given: &Value, expected: &Value, what: &str) {
    fn flat(v: &Value) -> Vec<f64> {
        v.as_array().map_or_else(|| vec![number(v)], |l| l.iter().flat_map(flat).collect())
    }
    let (given, expected) = (flat(given), flat(expected));
    assert_eq!(given.len(), expected.len(), "{what}");
    let scale = expected.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in given.iter().zip(&expected) {
        assert!((a - b).abs() <= TOLERANCE * scale, "{what}: {given:?} {expected:?}");
    }
}

fn state(sample: &Value) -> Value {
    json!({"q": sample["q"], "qd": sample["qd"], "theta": sample["theta_m"], "thetad": sample["thetad_m"]})
}

#[test]
fn forward_dynamics_of_all_models_equals_the_reference() {
    for robot in ROBOTS {
        let case = case(robot, "forward");
        for fidelity in Fidelity::ALL {
            let label = match fidelity {
                Fidelity::Complete => "complete_consistent",
                Fidelity::Reduced => "reduced_consistent",
                Fidelity::Rigid => "rigid_full",
                Fidelity::RigidReflected => "rigid_diag",
            };
            let options = Options { fidelity: Some(fidelity), matrices: !fidelity.is_elastic(), ..Options::default() };
            let mut evaluator = evaluator(&case, options);
            for sample in list(&case["samples"]) {
                let mut line = state(sample);
                line["tau"] = sample["u"].clone();
                line["tau_ext"] = sample["d_l"].clone();
                let (given, expected) = (answer(&mut evaluator, line), &sample["expected"][label]);
                assert_same(&given["qdd"], &expected["qdd"], &format!("{robot} {label} qdd"));
                if fidelity.is_elastic() {
                    assert_same(&given["thetadd"], &expected["thetadd_m"], &format!("{robot} {label} thetadd"));
                    assert_same(&given["tau_j"], &expected["tau_J"], &format!("{robot} {label} tau_j"));
                } else {
                    assert_same(&given["M"], &expected["M"], &format!("{robot} {label} M"));
                }
            }
        }
    }
}

#[test]
fn inverse_dynamics_equals_the_reference_and_its_transmission_torque_is_that_of_the_spring() {
    for robot in ROBOTS {
        let case = case(robot, "inverse_point");
        let mut evaluator = evaluator(&case, Options::default());
        for sample in list(&case["samples"]) {
            let expected = &sample["expected"]["consistent"];
            let mut line = state(sample);
            line["tau_ext"] = expected["d_l"].clone();
            let mut forward = line.clone();
            forward["tau"] = expected["u"].clone();
            line["qdd"] = sample["qdd"].clone();
            line["thetadd"] = sample["thetadd_m"].clone();
            let inverse = answer(&mut evaluator, line);
            assert_same(&inverse["tau"], &expected["u"], &format!("{robot} tau"));
            let forward = answer(&mut evaluator, forward);
            assert_same(&inverse["tau_j"], &forward["tau_j"], &format!("{robot} tau_j"));
        }
    }
}

#[test]
fn matrices_energies_and_significance_equal_the_reference() {
    for robot in ROBOTS {
        let case = case(robot, "matrices");
        let options = Options { matrices: true, energy: true, significance: true, ..Options::default() };
        let mut evaluator = evaluator(&case, options);
        let mut heights = Vec::new();
        for sample in list(&case["samples"]) {
            let (given, expected) = (answer(&mut evaluator, state(sample)), &sample["expected"]);
            for (ours, theirs) in [("M", "M_l"), ("S", "M_ml"), ("B", "M_m")] {
                assert_same(&given[ours], &expected[theirs], &format!("{robot} {ours}"));
            }
            let (energy, reference) = (&given["energy"], &expected["energy"]);
            assert_same(&energy["kinetic"], &reference["kinetic"], &format!("{robot} kinetic energy"));
            assert_same(&energy["elastic"], &reference["spring"], &format!("{robot} elastic energy"));
            heights.push(number(&energy["gravity"]) - number(&reference["gravity"]));

            let (ours, theirs) = (&given["significance"], &expected["significance"]);
            for (our_key, their_key) in [
                ("r_s", "r_s"),
                ("sigma_S", "sigma_M_ml_N"),
                ("sigma_M_l", "sigma_M_l"),
                ("bound_singular_values", "bound_singular_values"),
                ("r_s_min", "r_s_min"),
                ("r_s_max", "r_s_max"),
            ] {
                assert_same(&ours[our_key], &theirs[their_key], &format!("{robot} {our_key}"));
            }
        }
        // The zero of the gravity energy is free: the reference counts the rotor on the base.
        assert!(heights.windows(2).all(|w| (w[0] - w[1]).abs() < 1e-9 * w[0].abs().max(1.0)), "{robot} {heights:?}");
    }
}
