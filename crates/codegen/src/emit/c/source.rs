//! Definitions, and what they bring along.

use super::super::Precision;
use super::super::elementary::{Dialect, Uses};
use super::Unit;
use super::function::{constant, definition};
use crate::program::Program;
use std::fmt::Write;

pub(super) fn text(unit: &Unit) -> String {
    let programs: Vec<Program> = unit.functions.iter().map(Program::of).collect();
    let uses = Uses::of(&programs);
    let mut text = unit.opening(&[]);
    let _ = write!(text, "#include \"{}.h\"\n", unit.stem);
    let bits = uses.sin_cos || uses.sqrt || uses.exp || uses.tanh || uses.atan2;
    if bits {
        let width = match unit.precision {
            Precision::Single => 32,
            Precision::Double => 64,
        };
        let real = unit.real();
        let _ = write!(
            text,
            "\n#include <stdint.h>\n\n/* A number and its bits. */\nunion bits {{\n    {real} number;\n    uint{width}_t bits;\n}};\n"
        );
    }
    let templates = [
        (uses.mul_add || uses.mul_sub || uses.neg_mul_add, include_str!("fuse.txt")),
        (uses.mul_add, include_str!("mul_add.txt")),
        (uses.mul_sub, include_str!("mul_sub.txt")),
        (uses.neg_mul_add, include_str!("neg_mul_add.txt")),
        (uses.sin_cos, include_str!("sin_cos.txt")),
        (uses.sqrt, include_str!("sqrt.txt")),
        (uses.exp || uses.tanh, include_str!("exp_minus_1.txt")),
        (uses.exp, include_str!("exp.txt")),
        (uses.tanh, include_str!("tanh.txt")),
        (uses.atan2, include_str!("atan2.txt")),
    ];
    let dialect = Dialect {
        precision: unit.precision,
        number: constant,
        step: |_, value| format!("p = {value};"),
        indent: "    ",
    };
    let used = templates.iter().filter(|(used, _)| *used);
    text.extend(used.map(|(_, template)| dialect.fill(template)));
    for (function, program) in unit.functions.iter().zip(&programs) {
        text.push('\n');
        text.push_str(&definition(unit, function, program));
    }
    text
}
