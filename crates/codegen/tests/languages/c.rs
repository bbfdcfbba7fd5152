//! C: strict C99 without warnings, through the program that is generated with it.

use super::cases::{Case, SHIPPED, arm, mixed, shipped};
use super::toolchain::{Folder, cc, run, succeed};
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{Language, Precision, files};
use std::process::Command;

/// Compiles the files of a case and returns the program.
fn compile(folder: &Folder, case: &Case, precision: Precision, options: &[&str]) -> Command {
    let stem = format!("{}_{}", case.stem, if precision == Precision::Single { "single" } else { "double" });
    for file in files(Language::C, &case.head(), &case.functions, precision, &stem) {
        folder.write(&file.name, &file.text);
    }
    let strict = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror"];
    let sources = [format!("{stem}.c"), format!("{stem}_test.c")];
    succeed(cc().args(strict).args(options).args(sources).args(["-o", &stem]), folder);
    Command::new(folder.0.join(stem))
}

fn show(name: &str, cases: &[Case], precision: Precision, options: &[&str]) {
    let folder = Folder::new(name);
    for case in cases {
        let program = compile(&folder, case, precision, options);
        for (f, (function, points)) in case.functions.iter().zip(&case.points).enumerate() {
            let mut one = Command::new(program.get_program());
            let got = run(one.arg(&function.name), &folder, &points.inputs);
            case.assert_equal("C", f, precision, &got);
        }
    }
}

#[test]
fn arms_in_c_are_the_library() {
    let arms = [arm(Fidelity::ALL[3]), arm(Fidelity::ALL[0])];
    show("c-double", &arms, Precision::Double, &["-O2"]);
    show("c-single", &arms, Precision::Single, &["-O2"]);
}

#[test]
fn all_quantities_in_c_are_the_library() {
    show("c-all", &mixed(0..4), Precision::Double, &["-O0"]);
}

#[test]
fn robots_that_ship_are_the_library_in_c() {
    for name in SHIPPED {
        let case = [shipped(name)];
        show("c-shipped-double", &case, Precision::Double, &["-O0"]);
        show("c-shipped-single", &case, Precision::Single, &["-O0"]);
    }
}

#[test]
fn fused_products_in_c_are_the_library_too() {
    show("c-fused", &[arm(Fidelity::ALL[2])], Precision::Double, &["-O2", "-march=native"]);
}

/// Without an argument the program makes up its points; what it prints is what it gives for what it prints that it took.
#[test]
fn made_up_points_are_what_they_say() {
    let folder = Folder::new("c-made-up");
    let case = arm(Fidelity::ALL[0]);
    let mut program = compile(&folder, &case, Precision::Double, &["-O0"]);
    let output = program.output().expect("it runs");
    let text = String::from_utf8(output.stdout).expect("it is text");
    for function in &case.functions {
        let numbers = |point: usize, way: &str| -> Vec<f64> {
            let start = format!("{} {point} {way} ", function.name);
            let of_it = text.lines().filter_map(|line| line.strip_prefix(&start));
            of_it.map(|line| line.split(' ').nth(1).and_then(|x| x.parse().ok()).expect("a number")).collect()
        };
        let points: Vec<Vec<f64>> = (0..10).map(|point| numbers(point, "in")).collect();
        assert!(points.iter().all(|p| p.len() == function.inputs()), "{}", function.name);
        let got = run(Command::new(program.get_program()).arg(&function.name), &folder, &points);
        for (point, got) in got.iter().enumerate() {
            assert_eq!(got, &numbers(point, "out"), "{}, point {point}", function.name);
        }
    }
}
