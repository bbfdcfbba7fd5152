//! What parts cost, and what is gained by running them side by side.

use crate::function::Function;
use crate::graph::{Elementary, Graph, Id, Node};

/// What it costs to hand work to other processors and to wait for it, in additions [–]: some two microseconds, in which a core
/// adds and multiplies twenty thousand numbers of straight-line code.
pub const HAND_OVER: f64 = 20_000.0;

/// What to expect of a function in parts, in additions.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// The whole function on one processor.
    pub whole: f64,
    /// The longest chain of operations that wait for each other: no number of processors is faster.
    pub critical_path: f64,
    /// What is computed before the parts.
    pub shared: f64,
    /// Each part.
    pub parts: Vec<f64>,
}

impl Prediction {
    /// Of parts that compute these entries, what several need being computed once before them or by each.
    pub(super) fn of(function: &Function, cost: &[f64], parts: &[Vec<(usize, usize)>], together: bool) -> Self {
        let graph = &function.graph;
        let entries: Vec<Vec<Id>> =
            parts.iter().map(|places| places.iter().map(|&(o, e)| function.outputs[o].entries[e]).collect()).collect();
        let sum = |marked: &[bool]| marked.iter().zip(cost).filter(|(m, _)| **m).fold(0.0, |sum, (_, c)| sum + c);
        let shared = if together { shared(graph, &entries) } else { vec![false; graph.len()] };
        let part = |entries: &Vec<Id>| {
            let mut reached = graph.reached_from(entries.iter().copied());
            reached.iter_mut().zip(&shared).for_each(|(r, s)| *r &= !s);
            sum(&reached)
        };
        Self {
            whole: sum(&graph.reached_from(function.results())),
            critical_path: critical_path(function, cost),
            shared: sum(&shared),
            parts: entries.iter().map(part).collect(),
        }
    }

    /// Until the last part has ended, handing over not counted.
    pub fn parallel(&self) -> f64 {
        self.shared + self.parts.iter().copied().fold(0.0, f64::max)
    }

    /// How many times as fast the parts are, if handing over work cost nothing.
    pub fn ideal_speed_up(&self) -> f64 {
        self.whole / self.parallel().max(1.0)
    }

    /// How many times as fast the parts are; below one where splitting does not pay.
    pub fn speed_up(&self) -> f64 {
        self.whole / (self.parallel() + HAND_OVER)
    }
}

/// What each node costs, in additions.
pub(super) fn costs(graph: &Graph) -> Vec<f64> {
    let cost = |node: &Node| match node {
        Node::Constant(_) | Node::Input(_) => 0.0,
        Node::Neg(_) | Node::Add(..) | Node::Sub(..) | Node::Mul(..) => 1.0,
        Node::Div(..) | Node::Call(Elementary::Sqrt, _) => 6.0,
        // A pair of them is some twenty operations, and several pairs run side by side.
        Node::Call(Elementary::Sin | Elementary::Cos, _) => 8.0,
        Node::Select(_) => 2.0,
        Node::Call(..) | Node::Atan2(..) => 30.0,
    };
    graph.nodes().iter().map(cost).collect()
}

/// Marks what the results of more than one part are made of.
pub(super) fn shared(graph: &Graph, parts: &[Vec<Id>]) -> Vec<bool> {
    let mut count = vec![0_u16; graph.len()];
    for entries in parts {
        let reached = graph.reached_from(entries.iter().copied());
        count.iter_mut().zip(reached).for_each(|(count, reached)| *count += u16::from(reached));
    }
    let operation = |i: usize| graph.nodes()[i].is_operation();
    (0..graph.len()).map(|i| count[i] > 1 && operation(i)).collect()
}

fn critical_path(function: &Function, cost: &[f64]) -> f64 {
    let mut until = vec![0.0; cost.len()];
    for (i, node) in function.graph.nodes().iter().enumerate() {
        let before = node.operands().map(|o: Id| until[o.index()]).fold(0.0, f64::max);
        until[i] = before + cost[i];
    }
    function.results().map(|id| until[id.index()]).fold(0.0, f64::max)
}
