//! Functions in parts, and what runs the parts side by side with rayon.

use super::super::body::marked;
use super::super::head::about;
use super::super::identifier::identifier;
use super::super::{File, Head, Style};
use super::function::{result_name, shape};
use super::{files, number};
use crate::function::Function;
use crate::split::Split;
use std::fmt::Write;

/// The parts of all functions, and for each function one of its own name that runs its parts.
pub(in super::super) fn parallel(head: &Head, whole: &[(Function, Split)], style: Style, stem: &str) -> Vec<File> {
    let parts: Vec<Function> =
        whole.iter().flat_map(|(_, split)| split.shared.iter().chain(&split.parts).cloned()).collect();
    let mut files = files(head, &parts, style, stem);
    for file in &mut files {
        for (function, split) in whole {
            file.text.push('\n');
            file.text.push_str(&driver(function, split, style));
        }
    }
    files
}

fn driver(function: &Function, split: &Split, style: Style) -> String {
    let number = number(style);
    let prediction = &split.prediction;
    let mut lines = about(function);
    lines.extend([
        String::new(),
        format!(
            "In {} parts side by side, with the crate `rayon`: {:.2} times as fast where handing over work costs nothing; the longest",
            split.parts.len(),
            prediction.ideal_speed_up()
        ),
        format!("chain of operations alone takes {:.0} % of the whole.", 100.0 * prediction.critical_path / prediction.whole.max(1.0)),
        "Call it on a thread of rayon's pool (`ThreadPool::install`): any other thread sleeps until it is woken.".to_owned(),
    ]);
    let mut text = marked(&lines, "/// ");
    text.push_str("#[rustfmt::skip]\n#[allow(dead_code, clippy::all, clippy::pedantic)]\n");
    let mut signature: Vec<String> =
        function.arguments.iter().map(|a| format!("{}: &[{number}; {}]", identifier(&a.name), a.len)).collect();
    signature
        .extend(function.outputs.iter().map(|o| format!("{}: &mut {}", result_name(function, o), shape(o, &number))));
    let _ = writeln!(text, "pub fn {}({}) {{", identifier(&function.name), signature.join(", "));
    let mut given: Vec<String> = function.arguments.iter().map(|a| identifier(&a.name)).collect();
    let zero = if style.lanes.is_some() { format!("[0.0; {}]", style.lanes.unwrap_or(1)) } else { "0.0".to_owned() };
    if let Some(shared) = &split.shared {
        let len = shared.outputs[0].entries.len();
        let call = [given.clone(), vec!["&mut shared".to_owned()]].concat();
        let _ = writeln!(
            text,
            "    let mut shared = [{zero}; {len}];\n    {}({});",
            identifier(&shared.name),
            call.join(", ")
        );
        given.push("&shared".to_owned());
    }
    for (k, places) in split.places.iter().enumerate() {
        let _ = writeln!(text, "    let mut part_{k} = [{zero}; {}];", places.len());
    }
    text.push_str("    rayon::scope(|side| {\n");
    let last = split.parts.len() - 1;
    for (k, part) in split.parts.iter().enumerate() {
        let call = format!("{}({}, &mut part_{k})", identifier(&part.name), given.join(", "));
        // The last part is this thread's.
        let _ = if k < last {
            writeln!(text, "        side.spawn(|_| {call});")
        } else {
            writeln!(text, "        {call};")
        };
    }
    text.push_str("    });\n");
    for (k, places) in split.places.iter().enumerate() {
        for (i, &(o, e)) in places.iter().enumerate() {
            let output = &function.outputs[o];
            let place =
                output.columns.map_or(format!("[{e}]"), |columns| format!("[{}][{}]", e / columns, e % columns));
            let _ = writeln!(text, "    {}{place} = part_{k}[{i}];", result_name(function, output));
        }
    }
    text.push_str("}\n");
    text
}
