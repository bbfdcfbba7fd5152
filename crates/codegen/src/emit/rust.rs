//! Rust without `std` and without dependencies.

use super::literal::literal;
use super::{File, Head, Precision};
use crate::function::Function;
use crate::graph::{Elementary, Id, Node};
use crate::program::{Angle, Program, Statement, Step};
use std::fmt::Write;

pub(super) fn files(head: &Head, functions: &[Function], precision: Precision, stem: &str) -> Vec<File> {
    let mut text = format!("// {}, {}. {}\n", head.robot, head.model, head.command);
    functions.iter().for_each(|f| text.push_str(&function(f, precision)));
    vec![File { name: format!("{stem}.rs"), text }]
}

/// Writes one function.
fn function(function: &Function, precision: Precision) -> String {
    let program = Program::of(function);
    let scalar = match precision {
        Precision::Single => "f32",
        Precision::Double => "f64",
    };
    let mut text = String::new();
    let _ = write!(text, "/// {}\n#[inline]\npub fn {}(", function.meaning, function.name);
    for argument in &function.arguments {
        let _ = write!(text, "{}: &[{scalar}; {}], ", argument.name, argument.len);
    }
    for output in &function.outputs {
        let _ = write!(text, "{}: &mut [{scalar}; {}], ", output.name, output.entries.len());
    }
    text.truncate(text.len() - 2);
    text.push_str(") {\n");
    let name = |id: Id| match function.graph.node(id) {
        Node::Constant(bits) => {
            let x = f64::from_bits(bits);
            if x < 0.0 { format!("({})", literal(x, precision)) } else { literal(x, precision) }
        }
        Node::Input(k) => {
            let (argument, k) = function.argument_of(k as usize);
            format!("{}[{k}]", argument.name)
        }
        _ => format!("t{}", id.index()),
    };
    let statement = |text: &mut String, statement: &Statement| {
        let _ = match statement {
            Statement::Let(id, step) => writeln!(text, "    let {} = {};", name(*id), expression(*step, &name)),
            Statement::SinCos(angle) => {
                writeln!(text, "    let {} = sin_cos([{}]);", pattern(&[*angle], &name), name(angle.angle))
            }
        };
    };
    program.before.iter().for_each(|s| statement(&mut text, s));
    if !program.angles.is_empty() {
        let angles: Vec<String> = program.angles.iter().map(|a| name(a.angle)).collect();
        let _ = writeln!(text, "    let {} = sin_cos([{}]);", pattern(&program.angles, &name), angles.join(", "));
    }
    program.statements.iter().for_each(|s| statement(&mut text, s));
    for output in &function.outputs {
        let entries: Vec<String> = output.entries.iter().map(|id| name(*id)).collect();
        let _ = writeln!(text, "    *{} = [{}];", output.name, entries.join(", "));
    }
    text.push_str("}\n");
    text
}

fn pattern(angles: &[Angle], name: &impl Fn(Id) -> String) -> String {
    let list = |of: fn(&Angle) -> Option<Id>| {
        let names: Vec<String> = angles.iter().map(|a| of(a).map_or("_".to_owned(), name)).collect();
        format!("[{}]", names.join(", "))
    };
    format!("({}, {})", list(|a| a.sin), list(|a| a.cos))
}

fn expression(step: Step, name: &impl Fn(Id) -> String) -> String {
    match step {
        Step::MulAdd(a, b, c) => format!("mul_add({}, {}, {})", name(a), name(b), name(c)),
        Step::MulSub(a, b, c) => format!("mul_add({}, {}, -{})", name(a), name(b), name(c)),
        Step::SubMul(a, b, c) => format!("mul_add(-{}, {}, {})", name(a), name(b), name(c)),
        Step::Plain(node) => match node {
            Node::Constant(_) | Node::Input(_) => unreachable!("what is no operation is no step"),
            Node::Neg(a) => format!("-{}", name(a)),
            Node::Add(a, b) => format!("{} + {}", name(a), name(b)),
            Node::Sub(a, b) => format!("{} - {}", name(a), name(b)),
            Node::Mul(a, b) => format!("{} * {}", name(a), name(b)),
            Node::Div(a, b) => format!("{} / {}", name(a), name(b)),
            Node::Call(f @ (Elementary::Sin | Elementary::Cos), _) => unreachable!("{} is part of a pair", f.name()),
            Node::Call(f, a) => format!("{}({})", f.name(), name(a)),
            Node::Atan2(a, b) => format!("atan2({}, {})", name(a), name(b)),
            Node::Select([a, b, c, d]) => {
                format!("if {} < {} {{ {} }} else {{ {} }}", name(a), name(b), name(c), name(d))
            }
        },
    }
}
