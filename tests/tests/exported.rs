//! Robots as Rust source: compiled, they give what the loaded robots give, to the last bit.

mod exported {
    include!("exported/probe.rs");
}

use exported::probe;
use gyroflex::model::{Body, Fidelity, Friction, Knot, Model, SpringSpec, TransmissionError, TransmissionSpec};
use gyroflex::spatial::Vec3;
use gyroflex_sim::error::ErrorKind;
use gyroflex_sim::export::{Precision, rust};
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::robot::Robot;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

fn robot(file: &str, floating: bool) -> Robot {
    let path = project("robots").join(file);
    load(&path, &LoadOptions { floating, ..LoadOptions::default() }).unwrap_or_else(|e| panic!("{e}"))
}

fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// A robot with all that a record can hold: dry friction, a spring table, an imperfect gear.
fn rich() -> Robot {
    let mut robot = robot("iiwa14/robot.yaml", false);
    robot.spring_tables = vec![[0.0, 0.0], [0.002, 15.0], [0.005, 60.0]];
    let dry = Friction::coulomb(0.2, 0.7, 0.02).with_stribeck(0.3, 0.1);
    for body in &mut robot.bodies {
        body.friction = dry;
        let drive = body.drive.as_mut().expect("every joint of the arm has a drive");
        drive.friction = dry;
        drive.transmission = TransmissionSpec::Elastic {
            spring: SpringSpec::Table { first: 0, len: 3 },
            damping: 2.5,
            error: TransmissionError { amplitude: 2e-4, cycles_per_rotor_turn: 2.0, phase: 0.3 },
        };
    }
    robot
}

/// Robots by the names of their modules.
fn robots() -> Vec<(&'static str, Robot)> {
    vec![
        ("iiwa14", robot("iiwa14/robot.yaml", false)),
        ("manutec_r3", robot("manutec_r3/robot.yaml", false)),
        ("planar_3r", robot("planar_3r/robot.yaml", false)),
        ("puma560", robot("puma560/robot.yaml", false)),
        ("iiwa14_floating", robot("iiwa14/iiwa14.urdf", true)),
        ("rich", rich()),
        ("single_link", robot("single_link/robot.yaml", false)),
    ]
}

/// The loaded robot's results.
fn want(robot: &Robot, fidelity: Fidelity, precision: Precision) -> String {
    let owned = robot.model(fidelity).unwrap_or_else(|e| panic!("{e}"));
    let model = owned.view();
    match precision {
        Precision::Double => probe(&model),
        Precision::Single => {
            let bodies: Vec<Body<f32>> = model.bodies().iter().map(Body::cast).collect();
            let knots: Vec<Knot<f32>> = model.knots().iter().map(Knot::cast).collect();
            let gravity = model.gravity();
            probe(&Model::new(&bodies, &knots, Vec3::new(gravity.x as f32, gravity.y as f32, gravity.z as f32)))
        }
    }
}

#[test]
fn compiled_robots_equal_the_loaded_ones_bit_for_bit() {
    let package = Path::new(env!("CARGO_TARGET_TMPDIR")).join("exported");
    let source = package.join("src");
    std::fs::create_dir_all(&source).expect("the folder for temporary files can be written");
    let (mut wanted, mut modules, mut calls) = (String::new(), String::new(), String::new());
    for (name, robot) in robots() {
        for fidelity in Fidelity::ALL {
            for precision in [Precision::Single, Precision::Double] {
                let module = format!("{name}_{}_{}", fidelity.name(), precision.name());
                let text = rust(&robot, fidelity, precision).unwrap_or_else(|e| panic!("{module}: {e}"));
                std::fs::write(source.join(format!("{module}.rs")), text).expect("the folder can be written");
                let _ = writeln!(modules, "mod {module};");
                let _ = writeln!(calls, "    println!(\"{module} {{}}\", probe(&{module}::MODEL));");
                let _ = writeln!(wanted, "{module} {}", want(&robot, fidelity, precision));
            }
        }
    }
    let probe = include_str!("exported/probe.rs");
    let main = format!("#![deny(warnings)]\n{modules}\n{probe}\nfn main() {{\n{calls}}}\n");
    std::fs::write(source.join("main.rs"), main).expect("the folder can be written");
    let core = project("crates/core").canonicalize().expect("the core is there");
    let manifest = format!(
        "[package]\nname = \"exported\"\nedition = \"2024\"\n[workspace]\n[dependencies]\ngyroflex.path = {:?}\n",
        core.display().to_string()
    );
    std::fs::write(package.join("Cargo.toml"), manifest).expect("the folder can be written");
    // The same versions as here, so that nothing needs to be fetched.
    std::fs::copy(project("Cargo.lock"), package.join("Cargo.lock")).expect("the lock file can be copied");
    let run = Command::new(env!("CARGO"))
        .args(["run", "-q", "--offline"])
        .current_dir(&package)
        .env("CARGO_TARGET_DIR", package.join("target"))
        .output()
        .expect("cargo starts");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let got = String::from_utf8(run.stdout).expect("numbers are plain text");
    assert_eq!(got.lines().count(), wanted.lines().count());
    for (got, want) in got.lines().zip(wanted.lines()) {
        assert!(!got.contains("NaN"), "{got}");
        assert_eq!(got, want);
    }
}

#[test]
fn the_head_says_what_it_is_and_how_to_make_it_again() {
    let robot = robot("planar_3r/robot.yaml", false);
    let text = rust(&robot, Fidelity::Reduced, Precision::Single).unwrap_or_else(|e| panic!("{e}"));
    let head: String = text.lines().take_while(|l| l.starts_with("//")).collect();
    for word in ["planar_3r", "robot.yaml", "reduced", "f32", "SI units", env!("CARGO_PKG_VERSION"), "--scalar f32"] {
        assert!(head.contains(word), "no `{word}` in\n{head}");
    }
    for joint in &robot.joints {
        assert!(text.contains(&format!("// {} moves {}\n", joint.name, joint.child_link)), "{}", joint.name);
    }
}

#[test]
fn a_number_beyond_single_precision_is_refused_by_its_joint_and_field() {
    let mut robot = robot("single_link/robot.yaml", false);
    let drive = robot.bodies[0].drive.as_mut().expect("the joint has a drive");
    drive.gear_ratio = 1e-30;
    let error = rust(&robot, Fidelity::Complete, Precision::Single).expect_err("1 / N² J is beyond f32");
    assert_eq!((error.kind, error.element.as_str()), (ErrorKind::Model, robot.joints[0].name.as_str()));
    assert!(error.problem.contains("f32") && error.problem.contains("drive"), "{error}");
    assert!(error.remedy.contains("--scalar f64") && error.file.contains("robot.yaml"), "{error}");
    rust(&robot, Fidelity::Complete, Precision::Double).unwrap_or_else(|e| panic!("{e}"));
}
