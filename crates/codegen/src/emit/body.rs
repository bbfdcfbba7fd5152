//! The statements of a function, in the syntax of a language.

use super::identifier::identifier;
use crate::function::{Function, Output};
use crate::graph::{Elementary, Id, Node};
use crate::program::{Angle, Program, Statement, Step};

/// How a language writes what a function is made of.
pub(super) trait Syntax {
    /// A number.
    fn number(&self, x: f64) -> String;
    /// Entry `k` of an argument.
    fn input(&self, argument: &str, k: usize) -> String;
    /// `a b + c`.
    fn mul_add(&self, [a, b, c]: [&str; 3]) -> String {
        format!("mul_add({a}, {b}, {c})")
    }
    /// `a b − c`.
    fn mul_sub(&self, [a, b, c]: [&str; 3]) -> String {
        format!("mul_sub({a}, {b}, {c})")
    }
    /// `c − a b`.
    fn neg_mul_add(&self, [a, b, c]: [&str; 3]) -> String {
        format!("neg_mul_add({a}, {b}, {c})")
    }
    /// An elementary function.
    fn call(&self, f: Elementary, a: &str) -> String {
        format!("{}({a})", f.name())
    }
    /// The angle of a point.
    fn atan2(&self, y: &str, x: &str) -> String {
        format!("atan2({y}, {x})")
    }
    /// `c` where `a < b`, else `d`.
    fn select(&self, operands: [&str; 4]) -> String;
    /// The statement that gives a value a name.
    fn assign(&self, name: &str, value: &str) -> String;
    /// The statements for sine and cosine of one angle.
    fn sin_cos(&self, angle: &Named) -> Vec<String>;
    /// The statements for sines and cosines of several angles.
    fn sin_cos_each(&self, angles: &[Named]) -> Vec<String>;
}

/// An angle and what its sine and cosine are called, if they are needed.
pub(super) struct Named {
    pub angle: String,
    pub sin: Option<String>,
    pub cos: Option<String>,
}

/// A function's statements in order, and its results.
pub(super) struct Body {
    /// One statement a line, not indented.
    pub lines: Vec<String>,
    /// An expression for every entry of every output.
    pub results: Vec<Vec<String>>,
}

/// Writes the statements of a function.
pub(super) fn body(function: &Function, program: &Program, syntax: &impl Syntax) -> Body {
    let names = Names::of(function, program, syntax);
    let mut lines: Vec<String> = program.before.iter().flat_map(|s| names.statement(s)).collect();
    let angles: Vec<Named> = program.angles.iter().map(|angle| names.angle(angle)).collect();
    if !angles.is_empty() {
        lines.extend(syntax.sin_cos_each(&angles));
    }
    lines.extend(program.statements.iter().flat_map(|s| names.statement(s)));
    let entries = |o: &Output| o.entries.iter().map(|id| names.text(*id)).collect();
    Body { lines, results: function.outputs.iter().map(entries).collect() }
}

/// What every expression is called.
struct Names<'a, S> {
    function: &'a Function,
    syntax: &'a S,
    of: Vec<Option<String>>,
}

impl<'a, S: Syntax> Names<'a, S> {
    fn of(function: &'a Function, program: &Program, syntax: &'a S) -> Self {
        let mut names = Self { function, syntax, of: vec![None; function.graph.len()] };
        // Numbered in the order in which they are computed; sines and cosines after their angle.
        let mut temporaries = 0;
        names.number(&program.before, &mut temporaries);
        program.angles.iter().for_each(|angle| names.pair(angle));
        names.number(&program.statements, &mut temporaries);
        names
    }

    fn number(&mut self, statements: &[Statement], temporaries: &mut usize) {
        for statement in statements {
            match statement {
                Statement::Let(id, _) => {
                    self.of[id.index()] = Some(format!("t{temporaries}"));
                    *temporaries += 1;
                }
                Statement::SinCos(angle) => self.pair(angle),
            }
        }
    }

    fn pair(&mut self, angle: &Angle) {
        let tag = match self.function.graph.node(angle.angle) {
            Node::Input(k) => {
                let (argument, k) = self.function.argument_of(k as usize);
                format!("{}{k}", identifier(&argument.name))
            }
            _ => self.text(angle.angle),
        };
        for (id, name) in [(angle.sin, "sin"), (angle.cos, "cos")] {
            if let Some(id) = id {
                self.of[id.index()] = Some(format!("{name}_{tag}"));
            }
        }
    }

    fn text(&self, id: Id) -> String {
        match self.function.graph.node(id) {
            Node::Constant(bits) => self.syntax.number(f64::from_bits(bits)),
            Node::Input(k) => {
                let (argument, k) = self.function.argument_of(k as usize);
                self.syntax.input(&identifier(&argument.name), k)
            }
            _ => self.of[id.index()].clone().expect("operands come first"),
        }
    }

    fn angle(&self, angle: &Angle) -> Named {
        let name = |id: Option<Id>| id.map(|id| self.text(id));
        Named { angle: self.text(angle.angle), sin: name(angle.sin), cos: name(angle.cos) }
    }

    fn statement(&self, statement: &Statement) -> Vec<String> {
        match statement {
            Statement::Let(id, step) => vec![self.syntax.assign(&self.text(*id), &self.step(*step))],
            Statement::SinCos(angle) => self.syntax.sin_cos(&self.angle(angle)),
        }
    }

    fn step(&self, step: Step) -> String {
        let three = |a, b, c| [a, b, c].map(|id| self.text(id));
        match step {
            Step::MulAdd(a, b, c) => self.syntax.mul_add(three(a, b, c).each_ref().map(String::as_str)),
            Step::MulSub(a, b, c) => self.syntax.mul_sub(three(a, b, c).each_ref().map(String::as_str)),
            Step::SubMul(a, b, c) => self.syntax.neg_mul_add(three(a, b, c).each_ref().map(String::as_str)),
            Step::Plain(node) => self.plain(node),
        }
    }

    fn plain(&self, node: Node) -> String {
        let text = |id| self.text(id);
        match node {
            Node::Constant(_) | Node::Input(_) => unreachable!("what is no operation is no step"),
            Node::Neg(a) => format!("-{}", text(a)),
            Node::Add(a, b) => format!("{} + {}", text(a), text(b)),
            Node::Sub(a, b) => format!("{} - {}", text(a), text(b)),
            Node::Mul(a, b) => format!("{} * {}", text(a), text(b)),
            Node::Div(a, b) => format!("{} / {}", text(a), text(b)),
            Node::Call(f @ (Elementary::Sin | Elementary::Cos), _) => unreachable!("{} is part of a pair", f.name()),
            Node::Call(f, a) => self.syntax.call(f, &text(a)),
            Node::Atan2(a, b) => self.syntax.atan2(&text(a), &text(b)),
            Node::Select(all) => self.syntax.select(all.map(text).each_ref().map(String::as_str)),
        }
    }
}

/// Whether a function reads an argument at all.
pub(super) fn reads(function: &Function, argument: usize) -> bool {
    let first: usize = function.arguments[..argument].iter().map(|a| a.len).sum();
    let range = first..first + function.arguments[argument].len;
    let reached = function.graph.reached_from(function.results());
    let read =
        |(node, reached): (&Node, bool)| matches!(node, Node::Input(k) if reached && range.contains(&(*k as usize)));
    function.graph.nodes().iter().zip(reached).any(read)
}

/// Writes lines, each after a mark, without trailing spaces.
pub(super) fn marked(lines: &[String], mark: &str) -> String {
    lines.iter().map(|line| format!("{mark}{line}").trim_end().to_owned() + "\n").collect()
}

/// Entries of an output as rows: one, if it is a vector.
pub(super) fn rows<'a>(output: &Output, entries: &'a [String]) -> impl Iterator<Item = &'a [String]> {
    entries.chunks(output.columns.unwrap_or(entries.len()).max(1))
}
