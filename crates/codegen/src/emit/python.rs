//! Python with NumPy, many states at once.
//!
//! An argument is an array whose last axis is the vector; the axes before it are states, and those of all arguments are broadcast
//! against each other. A result has these axes, and then its own: one, or rows and columns. Arithmetic is that of the arrays: of
//! single precision, if all are.

use super::body::{Body, Named, Syntax, body, marked};
use super::head::{about, cost};
use super::identifier::identifier;
use super::{File, Head, Precision, literal};
use crate::function::Function;
use crate::graph::Elementary;
use crate::program::Program;
use std::fmt::Write;

const ABOUT: &[&str] = &[
    "The last axis of an argument is the vector, the axes before it are states, which are broadcast. Results are tuples",
    "with names; a result has the axes of the states, and then its own. Single precision in, single precision out.",
];

pub(super) fn files(head: &Head, functions: &[Function], stem: &str) -> Vec<File> {
    let mut text = format!("\"\"\"{}\"\"\"\n\n", marked(&head.lines(functions, ABOUT), ""));
    text.push_str("from typing import NamedTuple\n\nimport numpy as np\n");
    functions.iter().for_each(|f| text.push_str(&function(f)));
    text.push_str(include_str!("python.txt"));
    vec![File { name: format!("{stem}.py"), text }]
}

/// A function, and the type of its results.
fn function(function: &Function) -> String {
    let (name, class) = (identifier(&function.name), class(&function.name));
    let mut text = format!("\n\nclass {class}(NamedTuple):\n    \"\"\"Results of {name}.\"\"\"\n\n");
    for output in &function.outputs {
        let _ = writeln!(text, "    {}: np.ndarray", identifier(&output.name));
    }
    let arguments: Vec<String> = function.arguments.iter().map(|a| identifier(&a.name)).collect();
    let mut lines = about(function);
    lines.extend([String::new(), cost(function) + "."]);
    let _ = write!(text, "\n\ndef {name}({}):\n", arguments.join(", "));
    let _ = write!(text, "    \"\"\"{}    \"\"\"\n", marked(&lines, "    ").trim_start());
    let lengths: Vec<String> =
        function.arguments.iter().map(|a| format!("({}, {}, \"{}\")", identifier(&a.name), a.len, a.name)).collect();
    let list = arguments.iter().map(|a| format!("{a}, ")).collect::<String>();
    let _ = writeln!(text, "    ({list}), states, number = _arrays([{}])", lengths.join(", "));
    let Body { lines, results } = body(function, &Program::of(function), &Python);
    text.push_str(&marked(&lines, "    "));
    let _ = writeln!(text, "    return {class}(");
    for (output, entries) in function.outputs.iter().zip(&results) {
        let shape = output.columns.map_or(format!("({},)", output.rows), |c| format!("({}, {c})", output.rows));
        let _ = writeln!(text, "        _result(states, number, {shape}, [{}]),", entries.join(", "));
    }
    text.push_str("    )\n");
    text
}

/// `forward_dynamics` as `ForwardDynamics`.
fn class(name: &str) -> String {
    let capital = |word: &str| word[..1].to_ascii_uppercase() + &word[1..];
    identifier(name).split('_').filter(|word| !word.is_empty()).map(capital).collect()
}

struct Python;

impl Syntax for Python {
    fn number(&self, x: f64) -> String {
        match x {
            x if x.is_finite() => literal::literal(x, Precision::Double),
            x if x.is_nan() => "np.nan".to_owned(),
            x if x > 0.0 => "np.inf".to_owned(),
            _ => "-np.inf".to_owned(),
        }
    }

    fn input(&self, argument: &str, k: usize) -> String {
        format!("{argument}[..., {k}]")
    }

    fn mul_add(&self, [a, b, c]: [&str; 3]) -> String {
        format!("{a} * {b} + {c}")
    }

    fn mul_sub(&self, [a, b, c]: [&str; 3]) -> String {
        format!("{a} * {b} - {c}")
    }

    fn neg_mul_add(&self, [a, b, c]: [&str; 3]) -> String {
        format!("{c} - {a} * {b}")
    }

    fn call(&self, f: Elementary, a: &str) -> String {
        format!("np.{}({a})", f.name())
    }

    fn atan2(&self, y: &str, x: &str) -> String {
        format!("np.arctan2({y}, {x})")
    }

    fn select(&self, [a, b, c, d]: [&str; 4]) -> String {
        format!("np.where({a} < {b}, {c}, {d})")
    }

    fn assign(&self, name: &str, value: &str) -> String {
        format!("{name} = {value}")
    }

    fn sin_cos(&self, angle: &Named) -> Vec<String> {
        let of = |name: &Option<String>, f| name.as_ref().map(|name| format!("{name} = np.{f}({})", angle.angle));
        [of(&angle.sin, "sin"), of(&angle.cos, "cos")].into_iter().flatten().collect()
    }

    fn sin_cos_each(&self, angles: &[Named]) -> Vec<String> {
        angles.iter().flat_map(|angle| self.sin_cos(angle)).collect()
    }
}
