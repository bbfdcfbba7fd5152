//! Laws of the robot's description.

mod arm;

use arm::{RATIOS, arm};
use gyroflex_sim::info::Info;

#[test]
fn the_moving_mass_counts_links_and_the_rotors_that_move() {
    // Links of 2 kg, rotors of 0.4 kg: the shoulder's sits on the base, which moves only with a floating root.
    let mass = |floating| Info::of(&arm(floating)).expect("the arm is physical").moving_mass;
    assert!((mass(false) - (3.0 * 2.0 + 0.4)).abs() < 1e-12);
    assert!((mass(true) - (4.0 * 2.0 + 2.0 * 0.4)).abs() < 1e-12);
}

#[test]
fn joints_come_in_coordinate_order_each_with_its_drive() {
    for floating in [false, true] {
        let info = Info::of(&arm(floating)).expect("the arm is physical");
        let root = usize::from(floating);
        assert_eq!((info.nq, info.nv), (3 + 7 * root, 3 + 6 * root));
        let joints = &info.joints[root..];
        for (i, (joint, name)) in joints.iter().zip(["shoulder", "elbow", "slide"]).enumerate() {
            assert_eq!((joint.name.as_str(), joint.q_index, joint.v_index), (name, i + 7 * root, i + 6 * root));
        }
        let ratios: Vec<f64> = joints.iter().filter_map(|j| Some(j.drive.as_ref()?.gear_ratio)).collect();
        assert_eq!(ratios, RATIOS);
        let shoulder = joints[0].drive.as_ref().expect("the shoulder has a drive");
        assert_eq!(shoulder.rotor.mount_link, if floating { "base" } else { "world" });
        assert!(joints[1].drive.as_ref().is_some_and(|d| d.transmission.is_none()), "the elbow has a rigid gear");
        assert_eq!(info.modes.as_ref().map(|m| m.modes.len()), Some(1), "one transmission, one mode");
    }
}

#[test]
fn text_and_json_name_every_joint_and_link() {
    let info = Info::of(&arm(true)).expect("the arm is physical");
    let json: serde_json::Value = serde_json::from_str(&info.to_json().expect("plain names")).expect("JSON");
    assert_eq!(json["joints"].as_array().map(Vec::len), Some(4));
    assert!(json["joints"][3]["drive"].is_null(), "the slide is a plain joint");
    let text = info.to_string();
    for name in ["root", "shoulder", "elbow", "slide", "base", "upper", "lower", "tip", "tool"] {
        assert!(text.contains(name), "{name} in\n{text}");
    }
}
