//! Functions that come along with the code: those of the platform to the last places.

use super::rust::{Crate, results};
use super::toolchain::{Folder, cc, run, succeed};
use gyroflex_codegen::emit::{Head, Language, Precision, Style, files};
use gyroflex_codegen::function::{Argument, Function, Output};
use gyroflex_codegen::graph::{Elementary, Graph};
use std::process::Command;

/// Units in the last place that they may be off.
const UNITS: f64 = 2.5;

/// One function of everything: of an ordinate and an abscissa.
fn everything() -> Function {
    let mut g = Graph::new();
    let (y, x) = (g.input(0), g.input(1));
    let all = [Elementary::Sqrt, Elementary::Exp, Elementary::Tanh].map(|f| g.call(f, y));
    let (sin, cos) = g.sin_cos(y);
    let (arc, choice) = (g.atan2(y, x), g.select_less(y, x, y, x));
    let entries = all.into_iter().chain([sin, cos, arc, choice]).collect();
    Function {
        name: "everything".to_owned(),
        meaning: "Everything.".to_owned(),
        arguments: vec![Argument { name: "in".to_owned(), len: 2, meaning: "an ordinate and an abscissa".to_owned() }],
        outputs: vec![Output { name: "out".to_owned(), rows: 7, columns: None, meaning: "all".to_owned(), entries }],
        graph: g,
    }
}

/// Points of all sizes and signs, and the corners.
fn points(precision: Precision) -> Vec<Vec<f64>> {
    let sizes: Vec<f64> = (-40..=12).map(|k| 10_f64.powf(f64::from(k) / 4.0)).collect();
    let mut numbers: Vec<f64> = sizes.iter().flat_map(|x| [*x, -x]).chain([0.0, 1.0, -1.0]).collect();
    numbers.extend((0..400).map(|k| f64::from(k) / 20.0 - 10.0));
    let round = |x: f64| if precision == Precision::Single { f64::from(x as f32) } else { x };
    let n = numbers.len();
    (0..5 * n).map(|k| vec![round(numbers[k % n]), round(numbers[(k * 7 + k / n) % n])]).collect()
}

/// The same by the platform, in double precision, with what one unit in the last place is.
fn expected(point: &[f64], precision: Precision) -> Vec<(f64, f64)> {
    let (y, x) = (point[0], point[1]);
    let values = [y.sqrt(), y.exp(), y.tanh(), y.sin(), y.cos(), y.atan2(x), if y < x { y } else { x }];
    let unit = |k: usize, value: f64| {
        // Sines and cosines are so to one.
        let size = if k == 3 || k == 4 { 1.0 } else { value.abs() };
        match precision {
            Precision::Single => f64::from(f32::EPSILON) * size.max(f64::from(f32::MIN_POSITIVE)),
            Precision::Double => f64::EPSILON * size.max(f64::MIN_POSITIVE),
        }
    };
    values.iter().enumerate().map(|(k, v)| (*v, unit(k, *v))).collect()
}

fn check(language: &str, precision: Precision, points: &[Vec<f64>], got: &[Vec<f64>]) {
    assert_eq!(points.len(), got.len());
    for (point, got) in points.iter().zip(got) {
        for (k, (got, (want, unit))) in got.iter().zip(expected(point, precision)).enumerate() {
            let beyond = precision == Precision::Single && want > f64::from(f32::MAX);
            let want = if beyond { f64::INFINITY } else { want };
            let equal = *got == want || (got.is_nan() && want.is_nan()) || (got - want).abs() <= UNITS * unit;
            assert!(equal, "{language}, {precision:?}: function {k} at {point:?} gives {got:e}, not {want:e}");
        }
    }
}

fn head() -> Head {
    Head { robot: "*/ \"\"\" \n none".to_owned(), model: "none".to_owned(), command: "a test".to_owned() }
}

const PRECISIONS: [(Precision, &str); 2] = [(Precision::Double, "double"), (Precision::Single, "single")];

#[test]
fn functions_that_come_along_are_those_of_the_platform() {
    let function = [everything()];
    for (name, options) in [("plain", &[][..]), ("fused", &["-C", "target-cpu=native"])] {
        let (folder, mut all) = (Folder::new(&format!("rust-elementary-{name}")), Crate::default());
        for (precision, stem) in PRECISIONS {
            for (lanes, stem) in [(None, stem.to_owned()), (Some(8), format!("{stem}_lanes"))] {
                let style = Style { precision, lanes };
                all.add(&folder, &files(Language::Rust, &head(), &function, style, &stem)[0], &function, style);
            }
        }
        all.compile(&folder, options);
        for (precision, stem) in PRECISIONS {
            for module in [stem.to_owned(), format!("{stem}_lanes")] {
                let points = points(precision);
                check(
                    &format!("Rust, {name}, {module}"),
                    precision,
                    &points,
                    &results(&folder, &module, "everything", &points),
                );
            }
        }
    }
}

#[test]
fn functions_that_come_along_in_c_are_those_of_the_platform() {
    let folder = Folder::new("c-elementary");
    for (precision, stem) in PRECISIONS {
        for file in files(Language::C, &head(), &[everything()], precision, stem) {
            folder.write(&file.name, &file.text);
        }
        for options in [&["-O2"][..], &["-O2", "-march=native"]] {
            let strict = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror"];
            let sources = [format!("{stem}.c"), format!("{stem}_test.c")];
            succeed(cc().args(strict).args(options).args(sources).args(["-o", stem]), &folder);
            let points = points(precision);
            let got = run(Command::new(folder.0.join(stem)).arg("everything"), &folder, &points);
            check(&format!("C, {options:?}"), precision, &points, &got);
        }
    }
}
