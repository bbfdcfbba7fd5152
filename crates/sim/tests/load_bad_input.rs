//! Bad input ends in one error that names file, element and remedy, or in a warning; never in a panic.

use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::load::{Embedded, LoadOptions, Mimic, load, load_from, load_urdf_text};
use std::path::Path;

const LINK: &str =
    r#"<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"#;
const JOINT: &str = r#"<parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>"#;

/// Two links and the joint `shoulder` between them, its inner elements and those of the arm as given; more at the end.
fn urdf(arm: &str, joint: &str, more: &str) -> String {
    format!(
        "<robot name=\"r\">\n<link name=\"base\"/>\n<link name=\"arm\">{arm}</link>\n\
         <joint name=\"shoulder\" type=\"revolute\">{joint}</joint>\n{more}\n</robot>\n"
    )
}

fn good() -> String {
    urdf(LINK, JOINT, "")
}

fn refuse_with(urdf: &str, yaml: Option<&str>, options: &LoadOptions) -> Error {
    let e = load_urdf_text(urdf, "r.urdf", yaml, options).expect_err("this must be refused");
    assert!(!e.file.is_empty() && !e.problem.is_empty() && !e.remedy.is_empty(), "{e:?}");
    e
}

fn refuse(urdf: &str) -> Error {
    refuse_with(urdf, None, &LoadOptions::default())
}

fn refuse_drives(drives: &str) -> Error {
    let yaml = format!("urdf: r.urdf\ndrives:\n{drives}");
    refuse_with(&good(), Some(&yaml), &LoadOptions::default())
}

/// Whether an error is at a place and says all of the words.
#[track_caller]
fn assert_says(e: &Error, file: &str, words: &[&str]) {
    assert_eq!(e.file, file, "{e}");
    let text = e.to_string();
    for word in words {
        assert!(text.contains(word), "no {word:?} in: {text}");
    }
}

#[test]
fn the_plain_robot_of_these_tests_loads() {
    let robot = load_urdf_text(&good(), "r.urdf", None, &LoadOptions::default()).unwrap();
    assert_eq!((robot.joints.len(), robot.warnings.len()), (1, 0));
}

#[test]
fn what_is_not_xml_or_not_urdf_is_refused() {
    for text in
        ["", "   \n", "not xml", "<robot", "<robot><link name='a'></robot>", "<robot><link name=a/></robot>", "\u{0}"]
    {
        let e = refuse(text);
        assert!(e.file.starts_with("r.urdf:"), "{e}");
    }
    assert_says(&refuse("<sdf version='1.7'/>"), "r.urdf:1", &["<sdf>", "SDFormat"]);
    assert_says(&refuse("<mujoco/>"), "r.urdf:1", &["MJCF"]);
    assert_says(&refuse("<robot name='r'/>"), "r.urdf:1", &["no links"]);
    let xacro = "<robot xmlns:xacro='http://ros.org/wiki/xacro'>\n<xacro:include filename='a'/></robot>";
    assert_says(&refuse(xacro), "r.urdf:2", &["xacro:include", "expand"]);
    let property = urdf(&LINK.replace("value=\"1\"", "value=\"${mass}\""), JOINT, "");
    assert_says(&refuse(&property), "r.urdf:3", &["link `arm`", "xacro"]);
}

#[test]
fn deep_and_swelling_xml_ends_in_an_error() {
    let deep = format!("<robot>{}{}</robot>", "<a>".repeat(10_000), "</a>".repeat(10_000));
    assert_says(&refuse(&deep), "r.urdf:1", &["deep"]);
    refuse(&format!("<robot>{}", "<a>".repeat(10_000)));
    let mut laughs = String::from("<!DOCTYPE robot [<!ENTITY a0 \"lol\">");
    for i in 1..10 {
        laughs += &format!("<!ENTITY a{i} \"{}\">", format!("&a{};", i - 1).repeat(10));
    }
    laughs += "]>\n<robot name='&a9;'><link name='a'/></robot>";
    assert_says(&refuse(&laughs), "r.urdf:1", &["document type"]);
}

#[test]
fn a_tree_that_is_none_is_refused() {
    let e = refuse(&urdf(LINK, JOINT, r#"<link name="other"/>"#));
    assert_says(&e, "r.urdf:5", &["link `other`", "`base`", "in pieces", "fixed joint"]);
    let back = r#"<joint name="back" type="fixed"><parent link="arm"/><child link="base"/></joint>"#;
    assert_says(&refuse(&urdf(LINK, JOINT, back)), "r.urdf:1", &["loop"]);
    let ring = "<link name='a'/><link name='b'/>\
        <joint name='ab' type='fixed'><parent link='a'/><child link='b'/></joint>\
        <joint name='ba' type='fixed'><parent link='b'/><child link='a'/></joint>";
    assert_says(&refuse(&urdf(LINK, JOINT, ring)), "r.urdf:5", &["link `a`", "loop"]);
    let second = r#"<joint name="again" type="fixed"><parent link="base"/><child link="arm"/></joint>"#;
    assert_says(&refuse(&urdf(LINK, JOINT, second)), "r.urdf:5", &["joint `again`", "`arm`", "`shoulder`", "loop"]);
    let own = r#"<parent link="arm"/><child link="arm"/>"#;
    refuse(&urdf(LINK, own, ""));
    let lost = JOINT.replace("\"arm\"", "\"arn\"");
    assert_says(&refuse(&urdf(LINK, &lost, "")), "r.urdf:4", &["joint `shoulder`", "`arn`", "`arm`"]);
    assert_says(&refuse(&urdf(LINK, JOINT, "<link name='arm'/>")), "r.urdf:5", &["link `arm`", "r.urdf:3"]);
    let twin = format!("<link name='x'/><joint name='shoulder' type='fixed'>{}</joint>", JOINT.replace("arm", "x"));
    assert_says(&refuse(&urdf(LINK, JOINT, &twin)), "r.urdf:5", &["joint `shoulder`", "r.urdf:4"]);
    assert_says(&refuse(&urdf(LINK, "<parent link='base'/>", "")), "r.urdf:4", &["<child>"]);
}

#[test]
fn masses_and_inertias_that_no_body_has_are_refused() {
    let arm = |from: &str, to: &str| urdf(&LINK.replace(from, to), JOINT, "");
    let negative = refuse(&arm("mass value=\"1\"", "mass value=\"-1\""));
    assert_says(&negative, "r.urdf:3", &["link `arm`", "negative", "-1"]);
    assert_eq!(negative.kind, ErrorKind::Model);
    assert_says(&refuse(&urdf("", JOINT, "")), "r.urdf:4", &["joint `shoulder`", "`arm`", "mass"]);
    assert_says(&refuse(&arm("ixx=\"1\"", "ixx=\"-1\"")), "r.urdf:3", &["link `arm`", "negative principal moment"]);
    assert_says(&refuse(&arm("ixy=\"0\"", "ixy=\"3\"")), "r.urdf:3", &["negative principal moment", "products"]);
    for bad in ["nan", "inf", "-inf", "NaN", "1e999", "1,5", "", "1.0f", "1 2", "O"] {
        let e = refuse(&arm("ixx=\"1\"", &format!("ixx=\"{bad}\"")));
        assert_says(&e, "r.urdf:3", &["link `arm`", "`ixx`"]);
    }
    assert_says(&refuse(&arm("ixx=\"1\"", "")), "r.urdf:3", &["`ixx`"]);
    assert_says(&refuse(&arm("<mass value=\"1\"/>", "")), "r.urdf:3", &["<mass>"]);
}

#[test]
fn an_inertia_against_the_triangle_inequality_is_a_warning_with_its_principal_moments() {
    let text = urdf(&LINK.replace("ixx=\"1\"", "ixx=\"2.5\""), JOINT, "");
    let robot = load_urdf_text(&text, "r.urdf", None, &LoadOptions::default()).unwrap();
    let warning = robot.warnings.iter().find(|w| w.message.contains("triangle")).unwrap();
    assert_eq!((warning.file.as_str(), warning.element.as_str()), ("r.urdf:3", "link `arm`"));
    assert!(warning.message.contains("2.5") && warning.message.contains("well posed"), "{warning}");
    assert_eq!(robot.bodies[0].inertia.rotational.xx, 2.5);
}

#[test]
fn what_does_not_move_needs_no_mass() {
    let text = good().replace(
        "<link name=\"base\"/>",
        "<link name=\"base\"><inertial><mass value=\"-5\"/>\
        <inertia ixx=\"-1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>",
    );
    load_urdf_text(&text, "r.urdf", None, &LoadOptions::default()).unwrap();
    let floating = LoadOptions { floating: true, ..LoadOptions::default() };
    assert_says(&refuse_with(&text, None, &floating), "r.urdf:2", &["link `base`", "negative"]);
}

#[test]
fn joints_that_cannot_be_simulated_are_refused() {
    let joint = |from: &str, to: &str| refuse(&good().replace(from, to));
    assert_says(&joint("xyz=\"0 0 1\"", "xyz=\"0 0 0\""), "r.urdf:4", &["joint `shoulder`", "axis is zero"]);
    assert_says(&joint("xyz=\"0 0 1\"", "xyz=\"0 0\""), "r.urdf:4", &["joint `shoulder`", "needs 3"]);
    assert_says(&joint("xyz=\"0 0 1\"", "xyz=\"0 0 z 1\""), "r.urdf:4", &["joint `shoulder`", "0 0 z 1"]);
    assert_says(&joint("xyz=\"0 0 1\"", "xyz=\"0 0 nan\""), "r.urdf:4", &["joint `shoulder`", "finite"]);
    assert_says(&joint("revolute", "revolut"), "r.urdf:4", &["`revolut`", "`revolute`"]);
    assert_says(&joint("type=\"revolute\"", ""), "r.urdf:4", &["`type`"]);
    assert_says(&joint("revolute", "planar"), "r.urdf:4", &["`planar`", "not supported"]);
    assert_says(&joint("revolute", "floating"), "r.urdf:4", &["`floating`", "root"]);
    let negative = joint("<axis", "<limit effort=\"-1\" velocity=\"1\"/><axis");
    assert_says(&negative, "r.urdf:4", &["joint `shoulder`", "effort"]);
    let friction = joint("<axis", "<dynamics damping=\"-1\"/><axis");
    assert_says(&friction, "r.urdf:4", &["joint `shoulder`", "friction", "-1"]);
}

#[test]
fn a_mimic_joint_is_refused_or_set_free_on_demand_and_never_ignored() {
    let more = format!(
        "<link name='tip'>{LINK}</link><joint name='wrist' type='continuous'><parent link='arm'/><child link='tip'/>\
         <mimic joint='shoulder' multiplier='2'/></joint>"
    );
    let text = urdf(LINK, JOINT, &more);
    assert_says(&refuse(&text), "r.urdf:5", &["joint `wrist`", "`shoulder`", "mimic: independent"]);
    let free = LoadOptions { mimic: Some(Mimic::Independent), ..LoadOptions::default() };
    let robot = load_urdf_text(&text, "r.urdf", None, &free).unwrap();
    assert_eq!(robot.joints.len(), 2);
    assert!(robot.warnings.iter().any(|w| w.element == "joint `wrist`" && w.message.contains("dropped")));
    let yaml = load_urdf_text(&text, "r.urdf", Some("urdf: r.urdf\nmimic: independent\n"), &LoadOptions::default());
    assert_eq!(yaml.unwrap().joints.len(), 2);
    let fixed = load_urdf_text(&text.replace("continuous", "fixed"), "r.urdf", None, &LoadOptions::default()).unwrap();
    assert!(fixed.warnings.iter().any(|w| w.element == "joint `wrist`" && w.message.contains("no effect")));
}

#[test]
fn drives_that_cannot_be_are_refused_at_their_key() {
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4}\n    gear_ratio: 0\n");
    assert_says(&e, "robot.yaml:5", &["joint `shoulder`", "gear ratio is zero"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4}\n    transmission: {stiffness: 0.0}\n");
    assert_says(&e, "robot.yaml:5", &["stiffness", "positive", "rigid"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4}\n    transmission: {stiffness: -2}\n");
    assert_says(&e, "robot.yaml:5", &["stiffness", "-2"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4}\n    gear_ratio: .nan\n");
    assert_says(&e, "robot.yaml:5", &["drives.shoulder.gear_ratio", "finite"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4}\n    gear_ration: 5\n");
    assert_says(&e, "robot.yaml:5", &["drives.shoulder.gear_ration", "`gear_ratio`"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4, mount: {lnk: base}}\n");
    assert_says(&e, "robot.yaml:4", &["drives.shoulder.rotor.mount.lnk", "`link`"]);
    let e = refuse_drives(
        "  shoulder:\n    rotor: {inertia: 1e-4}\n    transmission: {stiffness: 1, error: {amplitud: 1}}\n",
    );
    assert_says(&e, "robot.yaml:5", &["transmission.error.amplitud", "`amplitude`"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4}\n    transmission: stiff\n");
    assert_says(&e, "robot.yaml:5", &["drives.shoulder.transmission", "`rigid`"]);
    let e = refuse_drives("  sholder:\n    rotor: {inertia: 1e-4}\n");
    assert_says(&e, "robot.yaml:3", &["`sholder`", "`shoulder`"]);
    let e = refuse_drives("  shoulder:\n    gear_ratio: 5\n");
    assert_says(&e, "robot.yaml:4", &["drives.shoulder.gear_ratio", "inertia of its rotor"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4, transverse_inertia: 1e-4}\n");
    assert_says(&e, "robot.yaml:4", &["transverse_inertia", "rotor.mass"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4, mount: {link: bas}}\n");
    assert_says(&e, "robot.yaml:4", &["`bas`", "`base`"]);
    let e =
        refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4, mount: {link: arm, xyz: [0, 0, 0], axis: [0, 0, 1]}}\n");
    assert_says(&e, "robot.yaml:4", &["joint `shoulder`", "rotor.mount", "parent"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4, mount: {xyz: [0, 0, 1]}}\n");
    assert_says(&e, "robot.yaml:4", &["rotor.mount", "axis"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4, mount: {axis: [0, 0, 0]}}\n");
    assert_says(&e, "robot.yaml:4", &["rotor.mount.axis", "zero"]);
    let e = refuse_drives(
        "  shoulder:\n    rotor: {inertia: 1e-4}\n    transmission: {stiffness: 1, table: [[0, 0], [1, 1]]}\n",
    );
    assert_says(&e, "robot.yaml:5", &["stiffness", "table"]);
    let e =
        refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4}\n    transmission: {table: [[0, 0], [1, 1], [2, 1]]}\n");
    assert_says(&e, "robot.yaml:5", &["strictly increasing"]);
    let e = refuse_drives("  shoulder:\n    rotor: {inertia: 1e-4}\n    transmission: {damping: 1}\n");
    assert_says(&e, "robot.yaml:5", &["`stiffness`"]);
    let e = refuse_drives("  shoulder:\n    friction: {link: {smoothing_velocity: 1}}\n");
    assert_says(&e, "robot.yaml:4", &["friction.link.smoothing_velocity", "coulomb"]);
    let e = refuse_drives("  shoulder:\n    max_torque: -3\n");
    assert_says(&e, "robot.yaml:4", &["max_torque", "positive"]);
}

#[test]
fn a_drive_on_a_fixed_joint_is_refused() {
    let more = "<link name='tip'/><joint name='weld' type='fixed'><parent link='arm'/><child link='tip'/></joint>";
    let yaml = "urdf: r.urdf\ndrives:\n  weld: {rotor: {inertia: 1}}\n";
    let e = refuse_with(&urdf(LINK, JOINT, more), Some(yaml), &LoadOptions::default());
    assert_says(&e, "robot.yaml:3", &["`weld`", "fixed", "r.urdf:5", "`shoulder`"]);
}

#[test]
fn a_missing_file_is_named_where_it_is_asked_for() {
    let e = load(Path::new("/nowhere/robot.yaml"), &LoadOptions::default()).unwrap_err();
    assert_eq!(e.kind, ErrorKind::Io);
    assert_says(&e, "/nowhere/robot.yaml", &["no such file"]);
    const FILES: Embedded =
        Embedded(&[("bots/robot.yaml", "gravity: [0, 0, -1]\nurdf: arm.urdf\n"), ("bots/list.yaml", "- a\n")]);
    let e = load_from(&FILES, Path::new("bots/robot.yaml"), &LoadOptions::default()).unwrap_err();
    assert_says(&e, "robot.yaml:2", &["urdf", "bots/arm.urdf", "no such file"]);
    let e = load_from(&FILES, Path::new("bots/list.yaml"), &LoadOptions::default()).unwrap_err();
    assert_says(&e, "list.yaml", &["must be a mapping"]);
}

#[test]
fn missing_meshes_are_warnings_and_an_unknown_package_is_one_warning() {
    const TEXT: &str = "<robot name='r'><link name='a'>\n<visual><geometry><mesh filename='package://lost/a.dae'/></geometry></visual>\n\
        <visual><geometry><mesh filename='package://lost/b.dae'/></geometry></visual>\n\
        <visual><geometry><mesh filename='meshes/c.dae'/></geometry></visual>\n\
        <visual><geometry><mesh filename='meshes/here.dae'/></geometry></visual>\n\
        <visual><geometry><mesh filename='package://known/meshes/here.dae'/></geometry></visual></link></robot>";
    const FILES: Embedded = Embedded(&[("known/r.urdf", TEXT), ("known/meshes/here.dae", "")]);
    let robot = load_from(&FILES, Path::new("known/r.urdf"), &LoadOptions::default()).unwrap();
    let meshes: Vec<_> = robot.warnings.iter().filter(|w| w.message.contains("mesh")).collect();
    assert_eq!(meshes.len(), 2, "{meshes:#?}");
    assert!(meshes[0].message.contains("meshes/c.dae") && meshes[0].file == "r.urdf:4", "{}", meshes[0]);
    assert!(meshes[1].message.contains("lost") && meshes[1].file == "r.urdf:2", "{}", meshes[1]);
}
