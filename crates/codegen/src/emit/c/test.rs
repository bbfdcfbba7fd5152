//! A program that runs the functions at states that it reads or makes up.

use super::super::identifier::identifier;
use super::Unit;
use crate::function::Function;
use std::fmt::Write;

pub(super) fn text(unit: &Unit) -> String {
    let stem = unit.stem;
    let more = [
        "Runs them. Without an argument: every function at ten random points, what it takes and what it gives, a number a line.",
        "With the name of one: reads what it takes, in order, point by point, from the standard input, and prints what it gives,",
        "in order, a point a line. Random numbers know nothing of quaternions, which would have to be of length one.",
        "",
        &format!("    cc -std=c99 -O2 {stem}.c {stem}_test.c -o {stem}_test"),
    ];
    let mut text = unit.opening(&more);
    let _ = write!(text, "#include \"{stem}.h\"\n\n#include <stdio.h>\n#include <string.h>\n\n");
    let most = |count: fn(&Function) -> usize| unit.functions.iter().map(count).max().unwrap_or(0).max(1);
    let _ = writeln!(text, "#define MOST_IN {}\n#define MOST_OUT {}\n", most(Function::inputs), most(outputs));
    for function in unit.functions {
        text.push_str(&adapter(unit, function));
    }
    let _ = write!(
        text,
        "static const struct {{\n    const char *name;\n    int in, out;\n    void (*run)(const {0} *, {0} *);\n}} functions[] = {{\n",
        unit.real()
    );
    for function in unit.functions {
        let name = identifier(&function.name);
        let _ = writeln!(text, "    {{\"{name}\", {}, {}, run_{name}}},", function.inputs(), outputs(function));
    }
    text.push_str("};\n");
    text.push_str(&include_str!("test.txt").replace("@real@", unit.real()));
    text
}

fn outputs(function: &Function) -> usize {
    function.outputs.iter().map(|o| o.entries.len()).sum()
}

/// A function of one array in and one out.
fn adapter(unit: &Unit, function: &Function) -> String {
    let (mut parts, mut at) = (Vec::new(), 0);
    for argument in &function.arguments {
        parts.push(format!("in + {at}"));
        at += argument.len;
    }
    at = 0;
    for output in &function.outputs {
        parts.push(format!("out + {at}"));
        at += output.entries.len();
    }
    let unused = if function.arguments.is_empty() { "    (void)in;\n" } else { "" };
    format!(
        "static void run_{}(const {real} *in, {real} *out)\n{{\n{unused}    {}({});\n}}\n\n",
        identifier(&function.name),
        unit.name(function),
        parts.join(", "),
        real = unit.real()
    )
}
