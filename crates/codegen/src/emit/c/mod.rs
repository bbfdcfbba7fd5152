//! C99 without a library: a header, a source, and a program that runs them.
//!
//! The code asks for `<stdint.h>` alone, which compilers without an operating system have, too. Vectors are arrays; matrices are
//! arrays by rows. Results and arguments do not overlap.

mod function;
mod header;
mod source;
mod test;

use super::identifier::{comment, identifier};
use super::{File, Head, Precision, Style};
use crate::function::Function;

pub(super) fn files(head: &Head, functions: &[Function], style: Style, stem: &str) -> Vec<File> {
    let unit = Unit { head, functions, precision: style.precision, stem: &comment(stem), prefix: &identifier(stem) };
    let file = |name: String, text: String| File { name, text };
    vec![
        file(format!("{stem}.h"), header::text(&unit)),
        file(format!("{stem}.c"), source::text(&unit)),
        file(format!("{stem}_test.c"), test::text(&unit)),
    ]
}

/// What the files are about.
struct Unit<'a> {
    head: &'a Head,
    functions: &'a [Function],
    precision: Precision,
    /// Name of the files.
    stem: &'a str,
    /// What names outside the source begin with.
    prefix: &'a str,
}

impl Unit<'_> {
    fn real(&self) -> &'static str {
        match self.precision {
            Precision::Single => "float",
            Precision::Double => "double",
        }
    }

    /// The name of a function outside the source.
    fn name(&self, function: &Function) -> String {
        format!("{}_{}", self.prefix, identifier(&function.name))
    }

    /// The first comment of a file.
    fn opening(&self, more: &[&str]) -> String {
        let lines = self.head.lines(self.functions, more);
        format!("/* {} */\n", super::body::marked(&lines, "   ").trim())
    }
}

/// Lines as one comment.
fn remark(lines: &[String], indent: &str) -> String {
    let text = super::body::marked(lines, &format!("{indent}   "));
    format!("{indent}/* {} */\n", text.trim())
}
