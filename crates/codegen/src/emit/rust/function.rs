//! One function of Rust.

use super::super::body::{Named, Syntax, body, marked, rows};
use super::super::head::{about, cost};
use super::super::identifier::identifier;
use super::super::literal::{is_finite, literal};
use super::super::{Precision, Style};
use super::scalar;
use crate::function::{Function, Output};
use crate::program::Program;
use std::fmt::Write;

/// Rust in a style.
pub(super) struct Rust {
    pub style: Style,
}

/// A constant.
pub(super) fn constant(x: f64, precision: Precision) -> String {
    if is_finite(x, precision) {
        return literal(x, precision);
    }
    let name = if x.is_nan() {
        "NAN"
    } else if x > 0.0 {
        "INFINITY"
    } else {
        "NEG_INFINITY"
    };
    format!("{}::{name}", scalar(precision))
}

impl Rust {
    pub(super) fn function(&self, function: &Function, program: &Program) -> String {
        let mut lines = about(function);
        lines.extend([String::new(), cost(function) + "."]);
        let mut text = marked(&lines, "/// ");
        text.push_str("#[rustfmt::skip]\n#[allow(dead_code, unused_variables, rustdoc::broken_intra_doc_links)]\n");
        text.push_str("#[allow(clippy::all, clippy::pedantic, clippy::nursery)]\n");
        let number = match self.style.lanes {
            None => scalar(self.style.precision).to_owned(),
            Some(lanes) => format!("[{}; {lanes}]", scalar(self.style.precision)),
        };
        let mut arguments: Vec<String> =
            function.arguments.iter().map(|a| format!("{}: &[{number}; {}]", identifier(&a.name), a.len)).collect();
        arguments.extend(
            function.outputs.iter().map(|o| format!("{}: &mut {}", result_name(function, o), shape(o, &number))),
        );
        let _ = writeln!(text, "pub fn {}({}) {{", identifier(&function.name), arguments.join(", "));
        let body = body(function, program, self);
        text.push_str(&marked(&body.lines, "    "));
        for (output, entries) in function.outputs.iter().zip(&body.results) {
            let entries: Vec<String> = entries.iter().map(|e| self.stored(e)).collect();
            let name = result_name(function, output);
            let mut rows: Vec<String> = rows(output, &entries).map(|row| format!("[{}]", row.join(", "))).collect();
            let _ = match output.columns {
                None => writeln!(text, "    *{name} = {};", rows.pop().unwrap_or_else(|| "[]".to_owned())),
                Some(_) => writeln!(
                    text,
                    "    *{name} = [\n{}    ];",
                    marked(&rows.iter().map(|r| format!("{r},")).collect::<Vec<_>>(), "        ")
                ),
            };
        }
        text.push_str("}\n");
        text
    }

    /// An expression as it goes into an output.
    fn stored(&self, entry: &str) -> String {
        if self.style.lanes.is_some() { format!("{entry}.0") } else { entry.to_owned() }
    }
}

fn shape(output: &Output, number: &str) -> String {
    match output.columns {
        None => format!("[{number}; {}]", output.entries.len()),
        Some(columns) => format!("[[{number}; {columns}]; {}]", output.rows),
    }
}

/// The name of an output, other than that of every argument.
fn result_name(function: &Function, output: &Output) -> String {
    let mut name = identifier(&output.name);
    while function.arguments.iter().any(|a| identifier(&a.name) == name) {
        name.push_str("_out");
    }
    name
}

impl Syntax for Rust {
    fn number(&self, x: f64) -> String {
        let text = constant(x, self.style.precision);
        if self.style.lanes.is_some() { format!("all({text})") } else { text }
    }

    fn input(&self, argument: &str, k: usize) -> String {
        if self.style.lanes.is_some() { format!("Lanes({argument}[{k}])") } else { format!("{argument}[{k}]") }
    }

    fn select(&self, [a, b, c, d]: [&str; 4]) -> String {
        match self.style.lanes {
            None => format!("if {a} < {b} {{ {c} }} else {{ {d} }}"),
            Some(_) => format!("select_less({a}, {b}, {c}, {d})"),
        }
    }

    fn assign(&self, name: &str, value: &str) -> String {
        format!("let {name} = {value};")
    }

    fn sin_cos(&self, angle: &Named) -> Vec<String> {
        let name = |of: &Option<String>| of.as_deref().unwrap_or("_").to_owned();
        vec![format!("let ({}, {}) = sin_cos({});", name(&angle.sin), name(&angle.cos), angle.angle)]
    }

    fn sin_cos_each(&self, angles: &[Named]) -> Vec<String> {
        if self.style.lanes.is_some() {
            return angles.iter().flat_map(|angle| self.sin_cos(angle)).collect();
        }
        let list = |of: fn(&Named) -> &str| angles.iter().map(of).collect::<Vec<_>>().join(", ");
        let sines = list(|a| a.sin.as_deref().unwrap_or("_"));
        let cosines = list(|a| a.cos.as_deref().unwrap_or("_"));
        vec![format!("let ([{sines}], [{cosines}]) = sin_cos_each([{}]);", list(|a| &a.angle))]
    }
}
