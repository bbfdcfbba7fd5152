//! Wrong files end with exit code 1 and one message that names file, element and remedy. Nothing panics, nothing hangs.

mod process;

use process::{Ended, PENDULUM, ROBOT, SCENARIO, folder, gyroflex, write};

/// Refused, with all the words in its message.
fn refused(ended: &Ended, words: &[&str], case: &str) {
    assert_eq!(ended.code, Some(1), "{case}: {}{}", ended.out, ended.err);
    assert!(ended.out.is_empty(), "{case}: {}", ended.out);
    assert_eq!(ended.err.matches("error: ").count(), 1, "{case}: {}", ended.err);
    for word in ["remedy: "].iter().chain(words) {
        assert!(ended.err.contains(word), "{case}: no `{word}` in\n{}", ended.err);
    }
}

/// What `info` makes of the pendulum's URDF after a change.
fn urdf(case: &str, from: &str, to: &str, words: &[&str]) {
    let here = folder(&format!("bad_urdf_{}", case.replace(' ', "_")));
    assert!(PENDULUM.contains(from), "{case}: nothing to change");
    write(&here, "pendulum.urdf", &PENDULUM.replace(from, to));
    let ended = gyroflex(&here, &["info", "pendulum.urdf"]);
    refused(&ended, &[&["pendulum.urdf"], words].concat(), case);
}

/// What `info` makes of the pendulum's drives after a change.
fn robot(case: &str, from: &str, to: &str, words: &[&str]) {
    let here = folder(&format!("bad_robot_{}", case.replace(' ', "_")));
    assert!(ROBOT.contains(from), "{case}: nothing to change");
    write(&here, "pendulum.urdf", PENDULUM);
    write(&here, "robot.yaml", &ROBOT.replace(from, to));
    let ended = gyroflex(&here, &["info", "robot.yaml"]);
    refused(&ended, &[&["robot.yaml"], words].concat(), case);
}

/// What `simulate` makes of the pendulum's scenario after a change.
fn scenario(case: &str, from: &str, to: &str, words: &[&str]) {
    let here = folder(&format!("bad_scenario_{}", case.replace(' ', "_")));
    assert!(SCENARIO.contains(from), "{case}: nothing to change");
    write(&here, "pendulum.urdf", PENDULUM);
    write(&here, "robot.yaml", ROBOT);
    write(&here, "scenario.yaml", &SCENARIO.replace(from, to));
    let ended = gyroflex(&here, &["simulate", "scenario.yaml"]);
    refused(&ended, &[&["scenario.yaml"], words].concat(), case);
    assert!(!here.join("scenario.mcap").exists(), "{case}: a log of nothing");
}

const MASS: &str = r#"<mass value="1"/>"#;
const INERTIA: &str = r#"<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>"#;
const HINGE: &str =
    r#"<joint name="hinge" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint>"#;

#[test]
fn a_urdf_that_is_no_tree_is_refused() {
    urdf("cycle", r#"<parent link="base"/>"#, r#"<parent link="bob"/>"#, &["bob", "loop"]);
    let two = r#"<joint name="a" type="continuous"><parent link="bob"/><child link="base"/><axis xyz="0 1 0"/></joint>
        <joint name="b" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint>"#;
    urdf("ring", HINGE, two, &[]);
    urdf("islands", r#"<link name="base"/>"#, r#"<link name="base"/><link name="island"/>"#, &["island"]);
    let parents =
        r#"<link name="base"/><joint name="second" type="fixed"><parent link="base"/><child link="bob"/></joint>"#;
    urdf("two parents", r#"<link name="base"/>"#, parents, &["bob"]);
    urdf("no such link", r#"<parent link="base"/>"#, r#"<parent link="bse"/>"#, &["hinge", "bse", "base"]);
    urdf("two of a name", r#"<link name="base"/>"#, r#"<link name="base"/><link name="bob"/>"#, &["bob"]);
}

#[test]
fn a_urdf_that_is_no_physics_is_refused() {
    urdf("negative mass", MASS, r#"<mass value="-1"/>"#, &["bob", "mass"]);
    urdf("no inertia", "<inertial><origin xyz=\"0 0 -0.5\"/>", "<visual><origin xyz=\"0 0 -0.5\"/>", &[]);
    let point = r#"<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>"#;
    let zero = format!("{MASS}{INERTIA}");
    urdf("massless tip", &zero, &format!("<mass value=\"0\"/>{point}"), &["bob"]);
    urdf("negative inertia", INERTIA, &INERTIA.replace("iyy=\"0.01\"", "iyy=\"-0.01\""), &["bob"]);
    urdf("zero axis", r#"<axis xyz="0 1 0"/>"#, r#"<axis xyz="0 0 0"/>"#, &["hinge", "axis"]);
    for bad in ["nan", "inf", "-inf", "1e999", "one", ""] {
        urdf(&format!("mass {bad}"), MASS, &format!("<mass value=\"{bad}\"/>"), &["bob"]);
    }
    urdf("short vector", r#"<axis xyz="0 1 0"/>"#, r#"<axis xyz="0 1"/>"#, &["hinge"]);
    urdf("unknown joint type", "continuous", "wobbly", &["hinge", "wobbly"]);
}

#[test]
fn a_urdf_that_is_no_xml_is_refused_quickly() {
    let here = folder("no_xml");
    let deep = format!("<robot name=\"deep\">{}{}</robot>", "<a>".repeat(10_000), "</a>".repeat(10_000));
    let laughs = r#"<!DOCTYPE r [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;"><!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;">
        <!ENTITY d "&c;&c;&c;&c;&c;&c;&c;&c;&c;&c;"><!ENTITY e "&d;&d;&d;&d;&d;&d;&d;&d;&d;&d;"><!ENTITY f "&e;&e;&e;&e;&e;&e;&e;&e;&e;&e;">
        <!ENTITY g "&f;&f;&f;&f;&f;&f;&f;&f;&f;&f;"><!ENTITY h "&g;&g;&g;&g;&g;&g;&g;&g;&g;&g;"><!ENTITY i "&h;&h;&h;&h;&h;&h;&h;&h;&h;&h;">]>
        <robot name="&i;"/>"#;
    for (case, text) in [
        ("deep", deep.as_str()),
        ("laughs", laughs),
        ("empty", ""),
        ("text", "hello"),
        ("cut", &PENDULUM[..PENDULUM.len() / 2]),
        ("other", "<sdf version=\"1.7\"/>"),
    ] {
        write(&here, "bad.urdf", text);
        refused(&gyroflex(&here, &["info", "bad.urdf"]), &["bad.urdf"], case);
    }
    std::fs::write(here.join("bad.urdf"), b"<robot name=\"\xff\xfe\"/>").expect("written");
    refused(&gyroflex(&here, &["info", "bad.urdf"]), &["bad.urdf"], "not UTF-8");
}

#[test]
fn drives_that_are_no_physics_are_refused() {
    robot("gear ratio zero", "gear_ratio: 50", "gear_ratio: 0", &["hinge", "gear_ratio"]);
    robot("stiffness zero", "stiffness: 500", "stiffness: 0", &["hinge", "stiffness"]);
    robot("stiffness negative", "stiffness: 500", "stiffness: -5", &["hinge", "stiffness"]);
    robot("damping negative", "damping: 1", "damping: -1", &["hinge", "damping"]);
    robot("inertia zero", "inertia: 1.0e-4", "inertia: 0", &["hinge", "inertia"]);
    for bad in [".nan", ".inf", "-.inf", "soft", "[1]", "1e999"] {
        robot(&format!("stiffness {bad}"), "stiffness: 500", &format!("stiffness: {bad}"), &["stiffness"]);
    }
}

#[test]
fn drives_for_nothing_are_refused() {
    robot("unknown joint", "hinge:", "hing:", &["hing", "hinge"]);
    robot("unknown key", "stiffness: 500", "stifness: 500", &["stifness", "stiffness"]);
    robot("unknown drive key", "gear_ratio", "gear_ration", &["gear_ration", "gear_ratio"]);
    robot("missing urdf", "pendulum.urdf", "pendul.urdf", &["pendul.urdf"]);
    robot("doubled key", "gear_ratio: 50", "gear_ratio: 50\n    gear_ratio: 60", &["gear_ratio"]);
}

#[test]
fn contradictory_gear_ratios_are_refused_unless_told_which() {
    let here = folder("contradiction");
    let tag = r#"<transmission name="t"><type>transmission_interface/SimpleTransmission</type><joint name="hinge"/>
        <actuator name="m"><mechanicalReduction>40</mechanicalReduction></actuator></transmission></robot>"#;
    write(&here, "pendulum.urdf", &PENDULUM.replace("</robot>", tag));
    write(&here, "robot.yaml", ROBOT);
    refused(
        &gyroflex(&here, &["info", "robot.yaml"]),
        &["robot.yaml", "hinge", "gear_ratio", "50", "40"],
        "contradiction",
    );
    write(&here, "robot.yaml", &ROBOT.replace("gear_ratio: 50", "gear_ratio: 50\n    override_urdf: true"));
    let ended = gyroflex(&here, &["info", "robot.yaml", "--json"]);
    assert!(ended.code == Some(0) && ended.out.contains("\"gear_ratio\": 50.0"), "{}", ended.err);
}

#[test]
fn yaml_that_is_no_mapping_is_refused_quickly() {
    let here = folder("no_mapping");
    write(&here, "pendulum.urdf", PENDULUM);
    let deep = format!("urdf: {}{}", "[".repeat(10_000), "]".repeat(10_000));
    let blocks: String = (0..10_000).map(|i| format!("{}a:\n", " ".repeat(i))).collect();
    let mut laughs = "a: &a [ha, ha, ha, ha, ha, ha, ha, ha, ha]\n".to_owned();
    for (old, new) in "abcdefghi".chars().zip("bcdefghij".chars()) {
        laughs += &format!("{new}: &{new} [*{old}, *{old}, *{old}, *{old}, *{old}, *{old}, *{old}, *{old}, *{old}]\n");
    }
    let texts = [
        "",
        "3",
        "- a\n- b\n",
        "hello",
        "urdf: [",
        "\t",
        "---\n---\nurdf: a\n",
        "urdf: pendulum.urdf\n: :\n",
        "{",
        &deep,
        &blocks,
        &laughs,
    ];
    for (i, text) in texts.into_iter().enumerate() {
        for command in ["info", "simulate"] {
            write(&here, "bad.yaml", text);
            refused(&gyroflex(&here, &[command, "bad.yaml"]), &["bad.yaml"], &format!("{command} of text {i}"));
        }
    }
}

#[test]
fn scenarios_that_cannot_be_run_are_refused_before_a_log_is_made() {
    scenario("unknown key", "duration", "duratoin", &["duratoin", "duration"]);
    scenario("no duration", "duration: 0.2\n", "", &["duration"]);
    scenario("negative duration", "duration: 0.2", "duration: -1", &["duration"]);
    scenario("duration nan", "duration: 0.2", "duration: .nan", &["duration"]);
    scenario("unknown joint", "hinge:", "hing:", &["hing", "hinge"]);
    scenario("unknown reference", "type: sine", "type: sinus", &["sinus", "sine"]);
    scenario("unknown controller", "type: pd", "type: pid", &["pid", "pd"]);
    scenario("step zero", "step: 1.0e-4", "step: 0", &["step"]);
    let rare = "controller: {type: none}\nlog: {rate: 1}\nintegrator: {method: rk4, step: 0.2}\n";
    let tail = SCENARIO.find("controller").map_or(SCENARIO, |at| &SCENARIO[at..]);
    scenario("step too large", tail, rare, &["step", "Hz"]);
    scenario("missing robot", "robot: robot.yaml", "robot: ghost.yaml", &["ghost.yaml"]);
    scenario("missing csv", "reference: {", "reference: {csv: ghost.csv} #", &["ghost.csv"]);
    scenario(
        "unknown link",
        "duration: 0.2",
        "duration: 0.2\nwrenches: [{link: bib, force: [0, 0, 1]}]",
        &["bib", "bob"],
    );
}

#[test]
fn a_missing_mesh_and_a_strange_inertia_are_only_warnings() {
    let here = folder("warnings");
    let mesh =
        r#"<link name="base"><visual><geometry><mesh filename="package://ghost/base.stl"/></geometry></visual></link>"#;
    let strange = INERTIA.replace("izz=\"0.01\"", "izz=\"0.5\"");
    let text = PENDULUM.replace(r#"<link name="base"/>"#, mesh).replace(INERTIA, &strange);
    write(&here, "pendulum.urdf", &text);
    let ended = gyroflex(&here, &["eval", "pendulum.urdf", "--matrices"]);
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    for word in ["warning: ", "mesh", "ghost", "triangle inequality", "bob"] {
        assert!(ended.err.contains(word), "no {word} in {}", ended.err);
    }
}
