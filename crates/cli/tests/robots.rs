//! The shipped robots through the binary.

mod process;

use process::{folder, gyroflex, is_complete, project, with_input};
use serde_json::{Value, json};

/// Start pose of the Manutec r3 and the holding torques there, from `robots/manutec_r3/README.md`.
const START_POSE: [f64; 6] = [-60.0, 20.0, 90.0, 0.0, -110.0, 0.0];
const HOLDING_TORQUES: [(usize, f64); 2] = [(1, -460.5734), (2, -256.4001)];

#[test]
fn without_arguments_the_puma_560_is_simulated_from_the_binary_alone() {
    let here = folder("builtin");
    let ended = gyroflex(&here, &["simulate", "--duration", "0.2"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.out.contains("puma560.mcap") && ended.err.contains("next: open puma560.mcap"), "{}", ended.err);
    assert!(is_complete(&here.join("puma560.mcap")));
}

#[test]
fn the_manutec_r3_is_held_by_the_published_torques() {
    let robot = project("robots/manutec_r3/robot.yaml");
    let q: Vec<f64> = START_POSE.iter().map(|degrees| degrees.to_radians()).collect();
    let rest = [0.0; 6];
    let line = json!({"q": q, "qd": rest, "qdd": rest, "theta": q, "thetad": rest, "thetadd": rest});
    let ended = with_input(&folder("manutec"), &["eval", &robot.display().to_string()], &format!("{line}\n"));
    let answer: Value = serde_json::from_str(&ended.out).unwrap_or_else(|e| panic!("{e}: {}", ended.err));
    for (joint, published) in HOLDING_TORQUES {
        for key in ["tau_j", "tau"] {
            let torque = answer[key][joint].as_f64().expect("a torque is a number");
            assert!((torque - published).abs() < 5e-5, "{key} of joint {}: {torque}, published {published}", joint + 1);
        }
    }
}

#[test]
fn info_lists_every_joint_in_coordinate_order_with_its_drive() {
    let here = folder("info");
    let robot = project("robots/manutec_r3/robot.yaml").display().to_string();
    let ended = gyroflex(&here, &["info", &robot, "--json"]);
    let info: Value = serde_json::from_str(&ended.out).unwrap_or_else(|e| panic!("{e}: {}", ended.err));
    let joints = info["joints"].as_array().expect("a list");
    let names: Vec<&str> = joints.iter().filter_map(|j| j["name"].as_str()).collect();
    assert_eq!(names, ["joint1", "joint2", "joint3", "joint4", "joint5", "joint6"]);
    assert_eq!(joints[0]["drive"]["gear_ratio"], -105.0);
    assert_eq!(joints[1]["drive"]["transmission"]["stiffness"], 352_800.0);
    assert!(joints[3]["drive"]["transmission"].is_null(), "joint 4 has a rigid gear");
    let turns = |j: &Value| j["type"] == "revolute" || j["type"] == "continuous";
    assert!(joints.iter().enumerate().all(|(i, j)| j["v_index"] == i && turns(j)));

    let urdf = project("robots/puma560/puma560.urdf").display().to_string();
    let ended = gyroflex(&here, &["info", &urdf, "--json", "--floating"]);
    let info: Value = serde_json::from_str(&ended.out).unwrap_or_else(|e| panic!("{e}: {}", ended.err));
    assert_eq!((info["nq"].as_u64(), info["nv"].as_u64()), (Some(13), Some(12)));
    assert_eq!(info["joints"][0]["type"], "floating");
    assert!(info["joints"][1]["drive"].is_null(), "a URDF alone has no drives");
}

#[test]
fn info_for_people_names_every_joint_link_and_source() {
    let robot = project("robots/puma560/robot.yaml").display().to_string();
    let text = gyroflex(&folder("info_text"), &["info", &robot]).out;
    for word in
        ["joint1", "joint6", "link3", "tool", "gear ratio", "robot.yaml:", "frequency", "moving mass", "107.815"]
    {
        assert!(text.contains(word), "no {word} in\n{text}");
    }
}
