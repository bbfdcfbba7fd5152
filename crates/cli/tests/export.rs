//! Robots written as source code.

mod process;

use process::{ROBOT, gyroflex, pendulum, write};

#[test]
fn rust_goes_to_standard_output_or_into_a_file() {
    let here = pendulum("export");
    let printed = gyroflex(&here, &["export", "--rust", "robot.yaml", "--scalar", "f32"]);
    assert_eq!(printed.code, Some(0), "{}", printed.err);
    assert!(printed.out.contains("pub static MODEL: Model<'static, f32>") && printed.out.contains("hinge moves bob"));

    let written = gyroflex(&here, &["export", "--rust", "robot.yaml", "--scalar", "f32", "-o", "robot.rs"]);
    assert_eq!((written.code, written.out.as_str()), (Some(0), ""), "{}", written.err);
    assert!(written.err.contains("robot.rs"), "{}", written.err);
    let text = std::fs::read_to_string(here.join("robot.rs")).expect("the file was written");
    assert_eq!(text, printed.out);
}

#[test]
fn model_scalar_and_root_are_those_asked_for() {
    let here = pendulum("export_options");
    for model in ["complete", "reduced", "rigid", "rigid_reflected"] {
        let text = gyroflex(&here, &["export", "--rust", "robot.yaml", "--model", model]).out;
        assert!(text.contains(&format!("the {model} model in f64")), "{text}");
        let elastic = matches!(model, "complete" | "reduced");
        assert_eq!(text.contains("elastic: None"), !elastic, "{text}");
    }
    let floating = gyroflex(&here, &["export", "--rust", "pendulum.urdf", "--floating"]).out;
    assert!(
        floating.contains("pub const NQ: usize = 8;") && floating.contains("pub const NV: usize = 7;"),
        "{floating}"
    );
}

#[test]
fn what_cannot_be_exported_is_refused_by_file_element_and_remedy() {
    let here = pendulum("export_refused");
    write(&here, "light.yaml", &ROBOT.replace("gear_ratio: 50", "gear_ratio: 1.0e-30"));
    for (case, args, words) in [
        ("no robot", &["nobody.yaml"][..], &["nobody.yaml"][..]),
        ("no folder", &["robot.yaml", "-o", "nowhere/robot.rs"], &["nowhere/robot.rs", "cannot be written"]),
        ("over the robot", &["robot.yaml", "-o", "robot.yaml"], &["robot.yaml", "overwritten", "another file"]),
        ("beyond f32", &["light.yaml", "--scalar", "f32"], &["light.yaml", "hinge", "beyond the range of f32", "f64"]),
    ] {
        let ended = gyroflex(&here, &[&["export", "--rust"], args].concat());
        assert_eq!((ended.code, ended.out.as_str()), (Some(1), ""), "{case}: {}", ended.err);
        for word in ["error: ", "remedy: "].iter().chain(words) {
            assert!(ended.err.contains(word), "{case}: no `{word}` in\n{}", ended.err);
        }
    }
    let robot = std::fs::read_to_string(here.join("robot.yaml")).expect("the robot is still there");
    assert_eq!(robot, ROBOT);
}
