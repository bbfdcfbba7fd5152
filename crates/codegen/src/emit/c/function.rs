//! One function of C.

use super::super::Precision;
use super::super::body::{Named, Syntax, body, marked, reads};
use super::super::identifier::identifier;
use super::super::literal::{is_finite, literal};
use super::Unit;
use crate::function::{Function, Output};
use crate::graph::Elementary;
use crate::program::Program;
use std::fmt::Write;

/// C in a precision.
struct C<'a> {
    precision: Precision,
    real: &'a str,
}

/// A constant.
pub(super) fn constant(x: f64, precision: Precision) -> String {
    let zero = if precision == Precision::Single { "0.0f" } else { "0.0" };
    if is_finite(x, precision) {
        let suffix = if precision == Precision::Single { "f" } else { "" };
        return literal(x, precision) + suffix;
    }
    let over = if x.is_nan() {
        zero
    } else if x > 0.0 {
        "1"
    } else {
        "-1"
    };
    format!("({over} / {zero})")
}

/// A function without what follows its parameters.
pub(super) fn signature(unit: &Unit, function: &Function) -> String {
    let real = unit.real();
    let arguments =
        function.arguments.iter().map(|a| format!("const {real} *GYROFLEX_RESTRICT {}", identifier(&a.name)));
    let results = function.outputs.iter().map(|o| format!("{real} *GYROFLEX_RESTRICT {}", result_name(function, o)));
    let all: Vec<String> = arguments.chain(results).collect();
    format!("void {}({})", unit.name(function), all.join(", "))
}

pub(super) fn definition(unit: &Unit, function: &Function, program: &Program) -> String {
    let language = C { precision: unit.precision, real: unit.real() };
    let mut text = format!("{}\n{{\n", signature(unit, function));
    for (i, argument) in function.arguments.iter().enumerate() {
        if !reads(function, i) {
            let _ = writeln!(text, "    (void){};", identifier(&argument.name));
        }
    }
    let body = body(function, program, &language);
    text.push_str(&marked(&body.lines, "    "));
    for (output, entries) in function.outputs.iter().zip(&body.results) {
        let name = result_name(function, output);
        for (k, entry) in entries.iter().enumerate() {
            let _ = writeln!(text, "    {name}[{k}] = {entry};");
        }
    }
    text.push_str("}\n");
    text
}

/// The name of an output, other than that of every argument.
fn result_name(function: &Function, output: &Output) -> String {
    let name = identifier(&output.name);
    if function.arguments.iter().any(|a| identifier(&a.name) == name) { format!("{name}_out") } else { name }
}

impl Syntax for C<'_> {
    fn number(&self, x: f64) -> String {
        constant(x, self.precision)
    }

    fn input(&self, argument: &str, k: usize) -> String {
        format!("{argument}[{k}]")
    }

    fn call(&self, f: Elementary, a: &str) -> String {
        // The names of the standard library mean its functions, even where it is not there.
        let name = match f {
            Elementary::Sqrt => "square_root",
            Elementary::Exp => "exponential",
            Elementary::Tanh => "hyperbolic_tangent",
            Elementary::Sin | Elementary::Cos => unreachable!("they are part of a pair"),
        };
        format!("{name}({a})")
    }

    fn atan2(&self, y: &str, x: &str) -> String {
        format!("angle_of({y}, {x})")
    }

    fn select(&self, [a, b, c, d]: [&str; 4]) -> String {
        format!("{a} < {b} ? {c} : {d}")
    }

    fn assign(&self, name: &str, value: &str) -> String {
        format!("const {} {name} = {value};", self.real)
    }

    fn sin_cos(&self, angle: &Named) -> Vec<String> {
        // What is not needed is computed all the same, and goes nowhere.
        let (sin, cos) = match (&angle.sin, &angle.cos) {
            (Some(sin), Some(cos)) => (sin.clone(), cos.clone()),
            (Some(sin), None) => (sin.clone(), format!("no_{sin}")),
            (None, Some(cos)) => (format!("no_{cos}"), cos.clone()),
            (None, None) => return Vec::new(),
        };
        vec![format!("{} {sin}, {cos};", self.real), format!("sin_cos({}, &{sin}, &{cos});", angle.angle)]
    }

    fn sin_cos_each(&self, angles: &[Named]) -> Vec<String> {
        let (n, real) = (angles.len(), self.real);
        let list: Vec<&str> = angles.iter().map(|a| a.angle.as_str()).collect();
        let mut lines = vec![
            format!("const {real} angles[{n}] = {{{}}};", list.join(", ")),
            format!("{real} sines[{n}], cosines[{n}];"),
            format!("for (int i = 0; i < {n}; i++)"),
            "    sin_cos(angles[i], &sines[i], &cosines[i]);".to_owned(),
        ];
        for (i, angle) in angles.iter().enumerate() {
            lines.extend(angle.sin.iter().map(|name| format!("const {real} {name} = sines[{i}];")));
            lines.extend(angle.cos.iter().map(|name| format!("const {real} {name} = cosines[{i}];")));
        }
        lines
    }
}
