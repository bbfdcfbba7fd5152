//! Laws of the robot's description.

mod arm;

use arm::{RATIOS, arm};
use gyroflex::dynamics::MAX_COEFFICIENTS;
use gyroflex::model::{Fidelity, TransmissionSpec};
use gyroflex::spatial::Vec3;
use gyroflex_sim::Robot;
use gyroflex_sim::info::Info;
use gyroflex_sim::inverse::{InverseModel, SmoothnessTable};

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

/// The shoulder of the arm again and again, about these axes, each rotor in its joint.
fn chain(axes: &[Vec3<f64>], damping: f64) -> Robot {
    let mut robot = arm(false);
    let (joint, body) = (robot.joints[0].clone(), robot.bodies[0]);
    (robot.joints, robot.bodies) = (Vec::new(), Vec::new());
    robot.links.truncate(1);
    for (i, axis) in axes.iter().enumerate() {
        let (mut joint, mut body) = (joint.clone(), body);
        joint.name = format!("joint{i}");
        body.parent = i.checked_sub(1);
        body.axis = *axis;
        body.placement.rot = gyroflex::spatial::Mat3::identity();
        if let Some(drive) = &mut body.drive {
            (drive.rotor.mount.body, drive.rotor.mount.axis) = (body.parent, *axis);
            drive.rotor.mount.placement = body.placement;
            if let TransmissionSpec::Elastic { damping: of_joint, .. } = &mut drive.transmission {
                *of_joint = damping;
            }
        }
        robot.joints.push(joint);
        robot.bodies.push(body);
    }
    robot
}

fn smoothness(robot: &Robot) -> SmoothnessTable {
    Info::of(robot).expect("the robot is physical").smoothness.expect("it has elastic joints")
}

/// De Luca & Tomei 1996: `2 (n + 1)` derivatives without damping, `n + 2` with it, which parallel axes need; 4 and 3 for the reduced
/// model. The table has no end where the inverse has one.
#[test]
fn parallel_axes_need_the_published_bounds_however_many_they_are() {
    for n in [1, 4, 15] {
        for damping in [0.0, 3.0] {
            let robot = chain(&vec![Vec3::z_axis(); n], damping);
            let table = smoothness(&robot);
            let bounds = (2 * (n + 1), n + 2);
            assert_eq!((usize::from(table.undamped), usize::from(table.damped)), bounds, "{n} joints");
            let most = if damping > 0.0 { bounds.1 } else { bounds.0 };
            let last = table.joints.last().expect("there are joints");
            assert_eq!(usize::from(last.complete), most, "{n} joints, damping {damping}");
            let reduced = if damping > 0.0 { 3 } else { 4 };
            assert!(table.joints.iter().all(|j| j.reduced == reduced), "{:?}", table.joints);
            assert_eq!(table.without_slight_couplings, None);
            let beyond = most - 1 > MAX_COEFFICIENTS;
            assert_eq!(InverseModel::new(&robot, Fidelity::Complete, 0).is_err(), beyond, "{n} joints");
        }
    }
}

/// Axes a hundred-thousandth of a radian from right angles ask for more than right angles do, and the table says what those would.
#[test]
fn couplings_of_rounded_angles_are_told_apart() {
    let axes = |slip: f64| -> Vec<_> {
        (0..5).map(|i| if i % 2 == 0 { Vec3::z_axis() } else { Vec3::new(0.0, 1.0, slip) }).collect()
    };
    let highest = |table: &SmoothnessTable| table.joints.iter().map(|j| j.complete).max();
    let (exact, rounded) = (smoothness(&chain(&axes(0.0), 0.0)), smoothness(&chain(&axes(1e-5), 0.0)));
    assert_eq!(exact.without_slight_couplings, None);
    assert!(highest(&rounded) > highest(&exact), "{rounded:?}");
    assert_eq!(rounded.without_slight_couplings, highest(&exact));
    let text = Info::of(&chain(&axes(1e-5), 0.0)).expect("it is physical").to_string();
    assert!(text.contains("without couplings below a thousandth"), "{text}");
}

#[test]
fn text_and_json_have_the_derivatives_of_every_joint() {
    for floating in [false, true] {
        let info = Info::of(&arm(floating)).expect("the arm is physical");
        let table = info.smoothness.clone().expect("the shoulder is elastic");
        assert_eq!(table.joints.len(), info.joints.len());
        let json: serde_json::Value = serde_json::from_str(&info.to_json().expect("plain names")).expect("JSON");
        let text = info.to_string();
        let rows: Vec<Vec<&str>> = text
            .lines()
            .skip_while(|l| !l.starts_with("Derivatives of q(t)"))
            .skip(2)
            .map(|l| l.split_whitespace().collect())
            .collect();
        for (i, joint) in table.joints.iter().enumerate() {
            assert_eq!(joint.joint, info.joints[i].name);
            assert_eq!(rows[i], [joint.joint.as_str(), &joint.complete.to_string(), &joint.reduced.to_string()]);
            let entry = &json["smoothness"]["joints"][i];
            assert_eq!((&entry["joint"], &entry["complete"]), (&joint.joint.as_str().into(), &joint.complete.into()));
        }
        assert_eq!(json["smoothness"]["undamped"], table.undamped);
    }
}

#[test]
fn a_robot_without_elastic_joints_has_no_such_table_and_says_why() {
    let mut robot = arm(false);
    for drive in robot.bodies.iter_mut().filter_map(|b| b.drive.as_mut()) {
        drive.transmission = TransmissionSpec::Rigid;
    }
    let info = Info::of(&robot).expect("the arm is physical");
    assert_eq!(info.smoothness, None);
    assert!(info.to_string().contains("accelerations are enough: no joint is elastic"));
}
