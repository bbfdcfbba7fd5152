//! A function as statements in the order in which generated code runs them.
//!
//! Sines and cosines of angles that do not wait for others come first, all at once, so that a processor computes several side by
//! side. A product that is needed once, in a sum, becomes one step with that sum: an instruction of its own on most processors.
//!
//! Everything else keeps the order of the algorithm, which is that of its meaning. Compilers order instructions themselves: statements
//! sorted by depth, by what waits for them, or depth first from the results change times by a few per cent, either way.

use crate::function::Function;
use crate::graph::{Elementary, Id, Node};

/// One step: what it computes, of which steps before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A plain operation; never a sine or cosine.
    Plain(Node),
    /// `a b + c`.
    MulAdd(Id, Id, Id),
    /// `a b − c`.
    MulSub(Id, Id, Id),
    /// `c − a b`.
    SubMul(Id, Id, Id),
}

/// What generated code does in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Statement {
    /// Sine and cosine of an angle; either may be without use.
    SinCos(Angle),
    /// A step whose result is the expression `0`.
    Let(Id, Step),
}

/// Sine and cosine of an angle, as far as they are needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle {
    /// The angle [rad].
    pub angle: Id,
    /// Its sine, if something needs it.
    pub sin: Option<Id>,
    /// Its cosine, if something needs it.
    pub cos: Option<Id>,
}

/// A function in the order of its computation.
#[derive(Clone, Debug)]
pub struct Program {
    /// What the angles of `angles` need.
    pub before: Vec<Statement>,
    /// Angles whose sines and cosines are computed side by side.
    pub angles: Vec<Angle>,
    /// Everything else.
    pub statements: Vec<Statement>,
}

impl Program {
    /// The program of a function.
    pub fn of(function: &Function) -> Self {
        let graph = &function.graph;
        let reached = graph.reached_from(function.results());
        let fused = fuse(function, &reached);
        let circular = |node: Node| matches!(node, Node::Call(Elementary::Sin | Elementary::Cos, _));

        // Which expressions wait for a sine or cosine.
        let mut late = vec![false; graph.len()];
        for (i, node) in graph.nodes().iter().enumerate() {
            late[i] = circular(*node) || node.operands().any(|o| late[o.index()]);
        }
        let mut early = graph.reached_from(graph.nodes().iter().enumerate().filter_map(|(i, node)| match node {
            Node::Call(Elementary::Sin | Elementary::Cos, angle) if reached[i] && !late[angle.index()] => Some(*angle),
            _ => None,
        }));
        let mut program = Self { before: Vec::new(), angles: Vec::new(), statements: Vec::new() };
        let mut angle_of = rustc_hash::FxHashMap::default();
        for (i, node) in graph.nodes().iter().enumerate() {
            let id = Id(i as u32);
            if !reached[i] || !node.is_operation() {
                continue;
            }
            if let Node::Call(f @ (Elementary::Sin | Elementary::Cos), angle) = *node {
                let at_once = !late[angle.index()];
                let entry = *angle_of.entry(angle).or_insert_with(|| {
                    let new = Angle { angle, sin: None, cos: None };
                    if at_once {
                        program.angles.push(new);
                        program.angles.len() - 1
                    } else {
                        program.statements.push(Statement::SinCos(new));
                        program.statements.len() - 1
                    }
                });
                let angle = match (at_once, program.statements.get_mut(entry)) {
                    (false, Some(Statement::SinCos(angle))) => angle,
                    _ => &mut program.angles[entry],
                };
                match f {
                    Elementary::Sin => angle.sin = Some(id),
                    _ => angle.cos = Some(id),
                }
                continue;
            }
            let Some(step) = fused[i] else { continue };
            let list = if std::mem::take(&mut early[i]) { &mut program.before } else { &mut program.statements };
            list.push(Statement::Let(id, step));
        }
        program
    }

    /// All statements, first to last, those of `angles` left out.
    pub fn steps(&self) -> impl Iterator<Item = (Id, Step)> + '_ {
        self.before.iter().chain(&self.statements).filter_map(|statement| match statement {
            Statement::Let(id, step) => Some((*id, *step)),
            Statement::SinCos(_) => None,
        })
    }
}

/// The step of every operation; none for products that are part of another step.
fn fuse(function: &Function, reached: &[bool]) -> Vec<Option<Step>> {
    let graph = &function.graph;
    let mut uses = vec![0_u32; graph.len()];
    for id in function.results() {
        uses[id.index()] += 2; // an output is a use, and one that a sum cannot take over
    }
    for (i, node) in graph.nodes().iter().enumerate() {
        if reached[i] {
            node.operands().for_each(|o| uses[o.index()] += 1);
        }
    }
    let mut depth = vec![0_u32; graph.len()];
    for (i, node) in graph.nodes().iter().enumerate() {
        depth[i] = node.operands().map(|o| depth[o.index()]).max().unwrap_or(0) + u32::from(node.is_operation());
    }
    let mut steps: Vec<Option<Step>> = graph.nodes().iter().map(|node| Some(Step::Plain(*node))).collect();
    for i in (0..graph.len()).rev() {
        if !reached[i] {
            continue;
        }
        let product = |id: Id| match graph.node(id) {
            Node::Mul(x, y) if uses[id.index()] == 1 => Some((x, y)),
            _ => None,
        };
        let (step, taken) = match graph.node(Id(i as u32)) {
            Node::Add(a, b) => match (product(a), product(b)) {
                // Of two products the one that is ready last.
                (Some((x, y)), other) if other.is_none() || depth[a.index()] >= depth[b.index()] => {
                    (Step::MulAdd(x, y, b), a)
                }
                (_, Some((x, y))) => (Step::MulAdd(x, y, a), b),
                _ => continue,
            },
            Node::Sub(a, b) => match (product(a), product(b)) {
                (Some((x, y)), other) if other.is_none() || depth[a.index()] >= depth[b.index()] => {
                    (Step::MulSub(x, y, b), a)
                }
                (_, Some((x, y))) => (Step::SubMul(x, y, a), b),
                _ => continue,
            },
            _ => continue,
        };
        steps[i] = Some(step);
        steps[taken.index()] = None;
    }
    steps
}
