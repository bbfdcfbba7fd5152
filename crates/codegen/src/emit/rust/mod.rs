//! Rust without `std` and without dependencies: a file that is a module of a program or a crate by itself.

mod function;
mod helpers;

use super::body::marked;
use super::{File, Head, Precision, Style};
use crate::function::Function;
use crate::program::Program;
use function::Rust;

pub(super) fn files(head: &Head, functions: &[Function], style: Style, stem: &str) -> Vec<File> {
    let programs: Vec<Program> = functions.iter().map(Program::of).collect();
    let language = Rust { style };
    let mut about = vec!["A module without `std` and without dependencies; nothing in it allocates or panics."];
    let several = style.lanes.map(|lanes| {
        format!("Every number is one of {lanes} states side by side: entry `k` of state `l` of an argument is `argument[k][l]`.")
    });
    about.extend(several.as_deref());
    about.push("Sums of products are fused where the build's target has an instruction for it (`-C target-cpu`).");
    let mut text = marked(&head.lines(functions, &about), "// ");
    for (function, program) in functions.iter().zip(&programs) {
        text.push('\n');
        text.push_str(&language.function(function, program));
    }
    text.push_str(&helpers::helpers(&programs, style));
    vec![File { name: format!("{stem}.rs"), text }]
}

fn scalar(precision: Precision) -> &'static str {
    match precision {
        Precision::Single => "f32",
        Precision::Double => "f64",
    }
}
