//! Declarations, and sizes as macros.

use super::super::head::{about, cost};
use super::super::identifier::identifier;
use super::function::signature;
use super::{Unit, remark};
use std::fmt::Write;

pub(super) fn text(unit: &Unit) -> String {
    let more = [
        "C99 without a library but <stdint.h>. A matrix is an array by rows. Results may not overlap with anything.",
        "Compilers must keep to IEEE arithmetic: no -ffast-math. Sums of products are fused where the target has an",
        "instruction for it; -DGYROFLEX_FUSE=0 or 1 decides otherwise.",
    ];
    let guard = format!("{}_H", unit.prefix.to_ascii_uppercase());
    let mut text = unit.opening(&more);
    let _ = write!(text, "#ifndef {guard}\n#define {guard}\n\n");
    text.push_str("#ifdef __cplusplus\nextern \"C\" {\n#endif\n\n");
    text.push_str("#ifndef GYROFLEX_RESTRICT\n#if defined(__STDC_VERSION__) && __STDC_VERSION__ >= 199901L\n");
    text.push_str("#define GYROFLEX_RESTRICT restrict\n#else\n#define GYROFLEX_RESTRICT\n#endif\n#endif\n\n");
    text.push_str("/* Sizes. */\n");
    for (name, size) in sizes(unit) {
        let _ = writeln!(text, "#define {name} {size}");
    }
    for function in unit.functions {
        let mut lines = about(function);
        lines.extend([String::new(), cost(function) + "."]);
        let _ = write!(text, "\n{}{};\n", remark(&lines, ""), signature(unit, function));
    }
    text.push_str("\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n");
    text
}

/// Names and values of the macros: for every argument and result how many numbers, for a matrix rows and columns, too.
fn sizes(unit: &Unit) -> Vec<(String, usize)> {
    let mut sizes = Vec::new();
    for function in unit.functions {
        let prefix = unit.name(function);
        let name = |of: &str, what: &str| format!("{prefix}_{}{what}", identifier(of)).to_ascii_uppercase();
        sizes.extend(function.arguments.iter().map(|a| (name(&a.name, "_IN"), a.len)));
        for output in &function.outputs {
            sizes.push((name(&output.name, "_OUT"), output.entries.len()));
            if let Some(columns) = output.columns {
                sizes.extend([(name(&output.name, "_ROWS"), output.rows), (name(&output.name, "_COLUMNS"), columns)]);
            }
        }
    }
    sizes
}
