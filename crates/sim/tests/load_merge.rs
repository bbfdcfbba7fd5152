//! Where numbers come from: the YAML over the URDF's tags over defaults, and the table that says so.

use gyroflex::model::{DriveSpec, Fidelity, SpringSpec, TransmissionSpec};
use gyroflex_sim::load::{LoadOptions, load_urdf_text, robot_schema};
use gyroflex_sim::{Error, Robot};

const LINK: &str =
    r#"<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>"#;

/// An arm of one joint, `j`, with tags inside the joint and after it.
fn urdf(in_joint: &str, after: &str) -> String {
    format!(
        "<robot name='r'>\n<link name='base'/>\n<link name='arm'>{LINK}</link>\n\
         <joint name='j' type='revolute'><parent link='base'/><child link='arm'/><axis xyz='0 0 2'/>\n{in_joint}</joint>\n\
         {after}\n</robot>\n"
    )
}

fn load(urdf: &str, drive: &str) -> Result<Robot, Error> {
    let yaml = format!("urdf: r.urdf\ndrives:\n  j:\n{drive}");
    load_urdf_text(urdf, "r.urdf", (!drive.is_empty()).then_some(&yaml), &LoadOptions::default())
}

fn drive(robot: &Robot) -> DriveSpec {
    robot.bodies[0].drive.expect("joint `j` has a drive")
}

fn row(robot: &Robot, key: &str) -> (String, String) {
    let row = robot.table.iter().find(|r| r.joint == "j" && r.key == key).unwrap_or_else(|| panic!("no row {key}"));
    (row.value.clone(), row.source.clone())
}

fn transmission(inside: &str) -> String {
    format!(
        "<transmission name='t'><type>transmission_interface/SimpleTransmission</type>\n\
         <joint name='j'><hardwareInterface>x</hardwareInterface></joint>\n<actuator name='m'>\n{inside}\n</actuator></transmission>"
    )
}

#[test]
fn a_joint_without_words_about_motors_has_no_drive() {
    let robot = load(&urdf("", ""), "").unwrap();
    assert!(robot.bodies[0].drive.is_none() && robot.table.is_empty() && robot.warnings.is_empty());
    assert_eq!(robot.fidelity, Fidelity::Complete);
    assert_eq!(robot.gravity.to_array(), [0.0, 0.0, -9.81]);
}

#[test]
fn transmissions_and_drakes_tags_make_a_rigid_drive() {
    let ros = load(
        &urdf("", &transmission("<mechanicalReduction>-50</mechanicalReduction><motorInertia>2e-4</motorInertia>")),
        "",
    );
    let tags = "<drake:rotor_inertia value='2e-4'/><drake:gear_ratio value='-50'/>";
    let drake = load(&urdf("", &transmission(tags)), "");
    let in_joint = load(&urdf(&format!("<actuator>{tags}</actuator>"), ""), "");
    let bare = load(&urdf(tags, ""), "");
    for robot in [ros, drake, in_joint, bare] {
        let robot = robot.unwrap();
        let d = drive(&robot);
        assert_eq!((d.gear_ratio, d.rotor.inertia), (-50.0, 2e-4));
        assert!(matches!(d.transmission, TransmissionSpec::Rigid) && d.rotor.body.is_none());
        assert_eq!(d.rotor.mount.axis.to_array(), [0.0, 0.0, 1.0]);
        assert!(robot.warnings.is_empty(), "{:#?}", robot.warnings);
    }
    let robot = load(&urdf("", &transmission(tags)), "").unwrap();
    assert_eq!(row(&robot, "gear_ratio"), ("-50".into(), "r.urdf:9 <drake:gear_ratio>".into()));
    assert_eq!(row(&robot, "transmission"), ("rigid".into(), "default".into()));
    assert_eq!(row(&robot, "rotor.mount").1, "default");
}

#[test]
fn a_rotor_without_a_ratio_turns_with_its_joint_and_the_table_says_so() {
    let robot = load(&urdf("", ""), "    rotor: {inertia: 0.5}\n").unwrap();
    assert_eq!(drive(&robot).gear_ratio, 1.0);
    assert_eq!(row(&robot, "gear_ratio"), ("1".into(), "default".into()));
    assert_eq!(row(&robot, "rotor.inertia"), ("0.5".into(), "robot.yaml:4".into()));
}

#[test]
fn yaml_counts_over_tags_and_the_table_tells_both() {
    let tags = "<drake:rotor_inertia value='2e-4'/><drake:gear_ratio value='50'/>";
    let text = urdf(&format!("<dynamics damping='3' friction='4'/><limit effort='7' velocity='1'/>{tags}"), "");
    let plain = load(&text, "").unwrap();
    assert_eq!((plain.bodies[0].friction.viscous, plain.bodies[0].friction.coulomb), (3.0, 4.0));
    assert_eq!((plain.joints[0].max_torque, plain.joints[0].max_velocity), (Some(7.0), Some(1.0)));
    assert_eq!(row(&plain, "friction.link.viscous").1, "r.urdf:5 <dynamics damping>");

    let yaml = "    rotor: {inertia: 1e-4}\n    friction: {link: {viscous: 0.5}}\n    max_torque: 6\n";
    let robot = load(&text, yaml).unwrap();
    let d = drive(&robot);
    assert_eq!((d.rotor.inertia, d.gear_ratio), (1e-4, 50.0));
    assert_eq!((robot.bodies[0].friction.viscous, robot.bodies[0].friction.coulomb), (0.5, 4.0));
    assert_eq!(robot.joints[0].max_torque, Some(6.0));
    let (value, source) = row(&robot, "rotor.inertia");
    assert_eq!(value, "0.0001");
    assert!(source.starts_with("robot.yaml:4, instead of 0.0002 at r.urdf:5"), "{source}");
}

#[test]
fn contradictory_gear_ratios_are_an_error_unless_the_yaml_means_it() {
    let text = urdf("", &transmission("<mechanicalReduction>1</mechanicalReduction>"));
    let e = load(&text, "    rotor: {inertia: 1e-4}\n    gear_ratio: 100\n").unwrap_err();
    assert_eq!((e.file.as_str(), e.element.as_str()), ("robot.yaml:5", "drives.j.gear_ratio"));
    for word in ["100", "1 at r.urdf:9", "override_urdf"] {
        assert!(e.to_string().contains(word), "{e}");
    }
    let opposite = load(&text, "    rotor: {inertia: 1e-4}\n    gear_ratio: -1\n");
    assert!(opposite.is_err(), "a sign is a contradiction too");
    let meant = load(&text, "    rotor: {inertia: 1e-4}\n    gear_ratio: 100\n    override_urdf: true\n").unwrap();
    assert_eq!(drive(&meant).gear_ratio, 100.0);
    assert!(row(&meant, "gear_ratio").1.contains("instead of 1"));
    let same = load(&text, "    rotor: {inertia: 1e-4}\n    gear_ratio: 1.0\n").unwrap();
    assert_eq!(drive(&same).gear_ratio, 1.0);

    let two = urdf(
        "<drake:gear_ratio value='5'/><drake:rotor_inertia value='1'/>",
        &transmission("<mechanicalReduction>6</mechanicalReduction>"),
    );
    let e = load(&two, "").unwrap_err();
    for word in ["joint `j`", "5", "6", "r.urdf:5", "r.urdf:9", "override_urdf"] {
        assert!(e.to_string().contains(word), "{e}");
    }
    let meant = load(&two, "    gear_ratio: 7\n    override_urdf: true\n").unwrap();
    assert_eq!(drive(&meant).gear_ratio, 7.0);
}

#[test]
fn every_key_of_a_drive_reaches_the_model() {
    let yaml = "    rotor: {inertia: 2e-4, mass: 0.6, mount: {link: base, xyz: [1, 2, 3], rpy: [0, 0, 1.5707963267948966], axis: [0, 3, 0]}}\n\
                \x20   gear_ratio: -80\n\
                \x20   transmission: {stiffness: 2e4, damping: 20, cubic: 5, error: {amplitude: 1e-4, cycles_per_rotor_turn: 2, phase: 0.5}}\n\
                \x20   friction:\n      motor: {viscous: 1, coulomb: 2, smoothing_velocity: 3, stribeck: 4, stribeck_velocity: 5}\n\
                \x20     link: {viscous: 6, coulomb: 7, smoothing_velocity: 8}\n\
                \x20   max_torque: 186\n";
    let robot = load(&urdf("", ""), yaml).unwrap();
    let d = drive(&robot);
    assert_eq!((d.gear_ratio, d.rotor.inertia), (-80.0, 2e-4));
    let body = d.rotor.body.unwrap();
    assert_eq!((body.mass, body.transverse_inertia), (0.6, 1e-4), "half of the spin inertia");
    let mount = d.rotor.mount;
    assert_eq!(mount.body, None, "the base is the world");
    assert_eq!(mount.placement.pos.to_array(), [1.0, 2.0, 3.0]);
    assert_eq!(
        (mount.placement.rotation() * mount.axis).to_array(),
        [-1.0, 0.0, 0.0],
        "y turned by 90 degrees about z"
    );
    let TransmissionSpec::Elastic { spring: SpringSpec::Polynomial { stiffness, cubic }, damping, error } =
        d.transmission
    else {
        panic!("an elastic transmission: {:?}", d.transmission)
    };
    assert_eq!((stiffness, cubic, damping), (2e4, 5.0, 20.0));
    assert_eq!((error.amplitude, error.cycles_per_rotor_turn, error.phase), (1e-4, 2.0, 0.5));
    let (m, l) = (d.friction, robot.bodies[0].friction);
    assert_eq!(
        [m.viscous, m.coulomb, m.smoothing_velocity, m.stribeck, m.stribeck_velocity],
        [1.0, 2.0, 3.0, 4.0, 5.0]
    );
    assert_eq!([l.viscous, l.coulomb, l.smoothing_velocity, l.stribeck], [6.0, 7.0, 8.0, 0.0]);
    assert_eq!(robot.joints[0].max_torque, Some(186.0));
    assert_eq!(robot.sources.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), ["r.urdf", "robot.yaml"]);

    let table =
        load(&urdf("", ""), "    rotor: {inertia: 1}\n    transmission: {table: [[0, 0], [1, 2], [2, 5]]}\n").unwrap();
    assert_eq!(table.spring_tables, [[0.0, 0.0], [1.0, 2.0], [2.0, 5.0]]);
    assert!(table.model(Fidelity::Complete).is_ok());
}

#[test]
fn options_count_over_the_yaml() {
    let yaml = "urdf: r.urdf\nmodel: rigid_reflected\ngravity: [1, 2, 3]\nfloating: false\n";
    let text = urdf("", "").replace("<link name='base'/>", &format!("<link name='base'>{LINK}</link>"));
    let robot = load_urdf_text(&text, "r.urdf", Some(yaml), &LoadOptions::default()).unwrap();
    assert_eq!((robot.fidelity, robot.gravity.to_array()), (Fidelity::RigidReflected, [1.0, 2.0, 3.0]));
    let options = LoadOptions {
        floating: true,
        model: Some(Fidelity::Reduced),
        gravity: Some([0.0; 3]),
        ..LoadOptions::default()
    };
    let robot = load_urdf_text(&text, "r.urdf", Some(yaml), &options).unwrap();
    assert_eq!((robot.fidelity, robot.gravity.to_array()), (Fidelity::Reduced, [0.0; 3]));
    assert!(robot.is_floating());
}

#[test]
fn what_has_no_effect_is_reported_once_a_kind() {
    let text = urdf(
        "<safety_controller k_velocity='1'/><dynamics damping='0' stiffness='5' rotor_inertia='1'/>\n",
        "<gazebo/><gazebo/>\n<gazebo/><transmission name='d'><type>x/DifferentialTransmission</type></transmission>\n\
         <transmission name='gone'><joint name='jj'/><actuator name='a'><mechanicalReduction>3</mechanicalReduction></actuator></transmission>\n\
         <transmission name='idle'><joint name='j'/><actuator name='a'><mechanicalReduction>3</mechanicalReduction></actuator></transmission>",
    );
    let robot = load(&text, "").unwrap();
    let says = |words: &[&str]| {
        let count = robot.warnings.iter().filter(|w| words.iter().all(|word| w.to_string().contains(word))).count();
        assert_eq!(count, 1, "{words:?} in {:#?}", robot.warnings);
    };
    says(&["r.urdf:7", "<gazebo>", "3 times"]);
    says(&["r.urdf:5", "safety_controller"]);
    says(&["stiffness", "series spring"]);
    says(&["rotor_inertia", "reflected"]);
    says(&["DifferentialTransmission"]);
    says(&["`jj`", "`j`"]);
    says(&["r.urdf:10", "gear ratio", "no rotor inertia"]);
    assert_eq!(robot.warnings.len(), 7, "{:#?}", robot.warnings);
}

#[test]
fn every_key_of_the_schema_is_described_and_unknown_ones_are_denied() {
    fn check(schema: &serde_json::Value, path: &str) -> usize {
        let mut count = 0;
        if let Some(properties) = schema.get("properties").and_then(|p| p.as_object()) {
            assert_eq!(schema["additionalProperties"], false, "{path}");
            for (key, value) in properties {
                assert!(value.get("description").is_some(), "{path}.{key} has no description");
                count += 1;
            }
        }
        if let Some(defs) = schema.get("$defs").and_then(|d| d.as_object()) {
            count += defs.iter().map(|(name, def)| check(def, name)).sum::<usize>();
        }
        count
    }
    let schema = robot_schema();
    assert!(check(&schema, "robot") > 25, "{schema:#}");
    assert!(schema["properties"]["drives"].is_object());
}
