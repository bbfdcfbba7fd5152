//! Expressions as a graph in which everything is written once.
//!
//! Nodes are hash-consed: an expression that is there already is not made again, so equal subexpressions are the same
//! [`Id`]. What the constructors can say at once they do (`simplify.rs`): numbers are folded, zeros and ones vanish, signs
//! move to where they cost nothing.

mod derivative;
mod evaluate;
mod node;
mod simplify;

pub use node::{Elementary, Id, Node};

use rustc_hash::FxHashMap;

/// Nodes, operands before what is made of them.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    known: FxHashMap<Node, Id>,
}

impl Graph {
    /// A graph without nodes.
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of nodes, of use or not.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// What an expression is.
    pub fn node(&self, id: Id) -> Node {
        self.nodes[id.index()]
    }

    /// All nodes in order.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The number that an expression is, if it is one.
    pub fn number(&self, id: Id) -> Option<f64> {
        self.node(id).as_constant()
    }

    /// The node as it is, made once.
    pub(crate) fn intern(&mut self, node: Node) -> Id {
        *self.known.entry(node).or_insert_with(|| {
            let id = Id(u32::try_from(self.nodes.len()).expect("four thousand million expressions"));
            self.nodes.push(node);
            id
        })
    }

    /// A number. Both zeros are the same.
    pub fn constant(&mut self, x: f64) -> Id {
        self.intern(Node::Constant((x + 0.0).to_bits()))
    }

    /// Input number `k` of the function.
    pub fn input(&mut self, k: usize) -> Id {
        self.intern(Node::Input(u32::try_from(k).expect("four thousand million inputs")))
    }

    /// Marks what some expressions are made of, themselves included.
    pub fn reached_from(&self, results: impl IntoIterator<Item = Id>) -> Vec<bool> {
        let mut reached = vec![false; self.len()];
        for id in results {
            reached[id.index()] = true;
        }
        for i in (0..self.len()).rev() {
            if reached[i] {
                for operand in self.nodes[i].operands() {
                    reached[operand.index()] = true;
                }
            }
        }
        reached
    }

    /// The same operation on other operands, simplified.
    pub fn rebuild(&mut self, node: Node, mut operand: impl FnMut(Id) -> Id) -> Id {
        match node {
            Node::Constant(bits) => self.constant(f64::from_bits(bits)),
            Node::Input(k) => self.input(k as usize),
            Node::Neg(a) => {
                let a = operand(a);
                self.neg(a)
            }
            Node::Add(a, b) => {
                let (a, b) = (operand(a), operand(b));
                self.add(a, b)
            }
            Node::Sub(a, b) => {
                let (a, b) = (operand(a), operand(b));
                self.sub(a, b)
            }
            Node::Mul(a, b) => {
                let (a, b) = (operand(a), operand(b));
                self.mul(a, b)
            }
            Node::Div(a, b) => {
                let (a, b) = (operand(a), operand(b));
                self.div(a, b)
            }
            Node::Call(f, a) => {
                let a = operand(a);
                self.call(f, a)
            }
            Node::Atan2(a, b) => {
                let (a, b) = (operand(a), operand(b));
                self.atan2(a, b)
            }
            Node::Select([a, b, c, d]) => {
                let (a, b, c, d) = (operand(a), operand(b), operand(c), operand(d));
                self.select_less(a, b, c, d)
            }
        }
    }
}
