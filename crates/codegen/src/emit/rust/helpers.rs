//! What a file of Rust brings along.

use super::super::Style;
use super::super::elementary::{Dialect, Uses};
use super::function::constant;
use crate::program::Program;

/// The functions that a file's programs call.
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
    used.map(|(_, template)| dialect.fill(template)).collect()
}
