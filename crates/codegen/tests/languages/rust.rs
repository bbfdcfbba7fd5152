//! Rust: a crate without `std` and without warnings, and a program on it.

use super::cases::{Case, SHIPPED, arm, mixed, shipped};
use super::toolchain::{Folder, run, rustc, succeed};
use gyroflex::model::Fidelity;
use gyroflex_codegen::emit::{File, Language, Precision, Style, files};
use gyroflex_codegen::function::Function;
use std::fmt::Write;
use std::process::Command;

/// Modules of one crate, and the lines of a program that calls their functions by name.
#[derive(Default)]
pub struct Crate {
    modules: String,
    calls: String,
}

impl Crate {
    /// Writes a module and calls of its functions.
    pub fn add(&mut self, folder: &Folder, file: &File, functions: &[Function], style: Style) {
        let module = file.name.trim_end_matches(".rs");
        folder.write(&file.name, &file.text);
        writeln!(self.modules, "pub mod {module};").expect("strings take all");
        for function in functions {
            self.calls.push_str(&call(module, function, style));
        }
    }

    /// Compiles all of it; `options` are the compiler's.
    pub fn compile(&self, folder: &Folder, options: &[&str]) {
        // What is said of the modules by themselves: no library, no warning, documentation everywhere.
        let header = "//! Generated.\n#![no_std]\n#![forbid(unsafe_code)]\n#![deny(warnings, missing_docs)]\n";
        let modules = self.modules.replace("pub mod", "#[allow(missing_docs)]\npub mod");
        folder.write("generated.rs", &format!("{header}{modules}"));
        let main = include_str!("main.txt").replace("@calls@", &self.calls);
        folder.write("run.rs", &main);
        let edition = ["--edition", "2024", "-C", "opt-level=1"];
        succeed(rustc().args(edition).args(options).args(["--crate-type", "rlib", "generated.rs"]), folder);
        let link = ["--extern", "generated=libgenerated.rlib", "run.rs"];
        succeed(rustc().args(edition).args(options).args(link), folder);
    }
}

/// Results at points, by the name of a module and a function.
pub fn results(folder: &Folder, module: &str, function: &str, points: &[Vec<f64>]) -> Vec<Vec<f64>> {
    run(Command::new(folder.0.join("run")).arg(format!("{module}::{function}")), folder, points)
}

/// An arm of a match: arguments from a row of numbers, results to another. All lanes get the same.
fn call(module: &str, function: &Function, style: Style) -> String {
    let float = if style.precision == Precision::Single { "f32" } else { "f64" };
    let number = style.lanes.map_or(float.to_owned(), |lanes| format!("[{float}; {lanes}]"));
    let (mut text, mut names) = (format!("\"{module}::{}\" => {{\n", function.name), Vec::new());
    let mut line = |line: String| text.push_str(&(line + "\n"));
    for (i, a) in function.arguments.iter().enumerate() {
        let value = style.lanes.map_or("x".to_owned(), |lanes| format!("[x; {lanes}]"));
        line(format!(
            "let a{i}: [{number}; {}] = std::array::from_fn(|_| {{ let x = input.next().unwrap() as {float}; {value} }});",
            a.len
        ));
        names.push(format!("&a{i}"));
    }
    for (i, o) in function.outputs.iter().enumerate() {
        let zero = style.lanes.map_or("0.0".to_owned(), |lanes| format!("[0.0; {lanes}]"));
        line(match o.columns {
            None => format!("let mut o{i} = [{zero}; {}];", o.rows),
            Some(columns) => format!("let mut o{i} = [[{zero}; {columns}]; {}];", o.rows),
        });
        names.push(format!("&mut o{i}"));
    }
    line(format!("generated::{module}::{}({});", function.name, names.join(", ")));
    for (i, o) in function.outputs.iter().enumerate() {
        let flat = if o.columns.is_some() { ".as_flattened()" } else { "" };
        let value = match style.lanes {
            None => "f64::from(*x)",
            Some(_) => "{ assert!(x.iter().all(|y| y.to_bits() == x[0].to_bits())); f64::from(x[0]) }",
        };
        line(format!("out.extend(o{i}{flat}.iter().map(|x| {value}));"));
    }
    text + "}\n"
}

fn style(precision: Precision, lanes: Option<usize>) -> Style {
    Style { precision, lanes }
}

/// The styles in which a robot's functions are shown.
const STYLES: [(&str, Precision, Option<usize>); 3] =
    [("double", Precision::Double, None), ("single", Precision::Single, None), ("lanes", Precision::Double, Some(4))];

fn show(name: &str, cases: &[Case], styles: &[(&str, Precision, Option<usize>)], options: &[&str]) {
    let (folder, mut all) = (Folder::new(name), Crate::default());
    for case in cases {
        for (suffix, precision, lanes) in styles {
            let (style, stem) = (style(*precision, *lanes), format!("{}_{suffix}", case.stem));
            let files = files(Language::Rust, &case.head(), &case.functions, style, &stem);
            files.iter().for_each(|file| all.add(&folder, file, &case.functions, style));
        }
    }
    all.compile(&folder, options);
    for case in cases {
        for (suffix, precision, _) in styles {
            let module = format!("{}_{suffix}", case.stem);
            for (f, (function, points)) in case.functions.iter().zip(&case.points).enumerate() {
                let got = results(&folder, &module, &function.name, &points.inputs);
                case.assert_equal(&format!("Rust, {suffix}"), f, *precision, &got);
            }
        }
    }
}

#[test]
fn arms_in_rust_are_the_library() {
    show("rust-arm", &[arm(Fidelity::ALL[3]), arm(Fidelity::ALL[0])], &STYLES, &[]);
}

#[test]
fn all_quantities_in_rust_are_the_library() {
    show("rust-all", &mixed(0..4), &STYLES[..1], &[]);
}

#[test]
fn robots_that_ship_are_the_library_in_rust() {
    for name in SHIPPED {
        show("rust-shipped", &[shipped(name)], &STYLES[..2], &[]);
    }
}

#[test]
fn fused_products_are_the_library_too() {
    show("rust-fused", &[arm(Fidelity::ALL[2])], &STYLES[..1], &["-C", "target-cpu=native"]);
}
