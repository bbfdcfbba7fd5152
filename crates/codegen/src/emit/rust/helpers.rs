//! What a file of Rust brings along.

use super::super::elementary::{Dialect, Uses};
use super::super::{Precision, Style};
use super::function::constant;
use super::scalar;
use crate::program::Program;
use std::fmt::Write;

/// The functions that a file's programs call, and the type of lanes.
pub(super) fn helpers(programs: &[Program], style: Style) -> String {
    let uses = Uses::of(programs);
    let templates = [
        (uses.mul_add || uses.mul_sub || uses.neg_mul_add, include_str!("mul_add.txt")),
        (uses.mul_sub, include_str!("mul_sub.txt")),
        (uses.neg_mul_add, include_str!("neg_mul_add.txt")),
        (uses.sin_cos, include_str!("sin_cos.txt")),
        (uses.sin_cos && style.lanes.is_none(), include_str!("sin_cos_each.txt")),
        (uses.sqrt, include_str!("sqrt.txt")),
        (uses.exp || uses.tanh, include_str!("exp_minus_1.txt")),
        (uses.exp, include_str!("exp.txt")),
        (uses.tanh, include_str!("tanh.txt")),
        (uses.atan2, include_str!("atan2.txt")),
    ];
    let dialect = Dialect {
        precision: style.precision,
        number: constant,
        step: |_, value| format!("let p = {value};"),
        indent: "    ",
    };
    let used = templates.iter().filter(|(used, _)| *used);
    let text: String = used.map(|(_, template)| dialect.fill(template)).collect();
    match style.lanes {
        None => text,
        Some(lanes) => in_lanes(&uses, &text, style.precision, lanes),
    }
}

/// The same functions state by state; those of plain numbers move to a module of their own.
fn in_lanes(uses: &Uses, plain: &str, precision: Precision, lanes: usize) -> String {
    let float = scalar(precision);
    let mut text = include_str!("lanes.txt").replace("@float@", float).replace("@lanes@", &lanes.to_string());
    let functions = [
        (uses.mul_add, "mul_add", "a b + c", 3),
        (uses.mul_sub, "mul_sub", "a b - c", 3),
        (uses.neg_mul_add, "neg_mul_add", "c - a b", 3),
        (uses.sqrt, "sqrt", "Square root", 1),
        (uses.exp, "exp", "Natural exponential", 1),
        (uses.tanh, "tanh", "Hyperbolic tangent", 1),
        (uses.atan2, "atan2", "Angle of a point", 2),
    ];
    for (_, name, meaning, operands) in functions.iter().filter(|(used, ..)| *used) {
        let names = &["a", "b", "c"][..*operands];
        let (typed, names) = (names.join(": Lanes, "), names.join(", "));
        let _ = write!(
            text,
            "\n/// {meaning}, state by state.\n#[allow(dead_code)]\n#[inline(always)]\n\
             fn {name}({typed}: Lanes) -> Lanes {{\n    each([{names}], |[{names}]| one::{name}({names}))\n}}\n"
        );
    }
    if uses.sin_cos {
        let _ = write!(
            text,
            "\n/// Sine and cosine, state by state.\n#[allow(clippy::needless_range_loop)]\n#[inline(always)]\n\
             fn sin_cos(x: Lanes) -> (Lanes, Lanes) {{\n    let (mut s, mut c) = ([0.0; {lanes}], [0.0; {lanes}]);\n    \
             for lane in 0..{lanes} {{\n        (s[lane], c[lane]) = one::sin_cos(x.0[lane]);\n    }}\n    \
             (Lanes(s), Lanes(c))\n}}\n"
        );
    }
    if uses.select {
        text.push_str(
            "\n/// `c` where `a < b`, else `d`, state by state.\n#[inline(always)]\n\
             fn select_less(a: Lanes, b: Lanes, c: Lanes, d: Lanes) -> Lanes {\n    \
             each([a, b, c, d], |[a, b, c, d]| if a < b { c } else { d })\n}\n",
        );
    }
    if !plain.is_empty() {
        let plain = plain.replace("\nfn ", "\npub(super) fn ");
        let _ = write!(text, "\n/// Functions of plain numbers.\nmod one {{{plain}}}\n");
    }
    text
}
