//! A function of named arguments, as a graph and the expressions that are its results.

use crate::graph::{Elementary, Graph, Id, Node};

/// Numbers that a function takes under one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// Its name in generated code.
    pub name: String,
    /// How many numbers.
    pub len: usize,
    /// What it is, with its unit.
    pub meaning: String,
}

/// Numbers that a function gives under one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its name in generated code.
    pub name: String,
    /// Number of rows; its length, if it is a vector.
    pub rows: usize,
    /// Number of columns; none, if it is a vector.
    pub columns: Option<usize>,
    /// What it is, with its unit.
    pub meaning: String,
    /// The expressions, by rows.
    pub entries: Vec<Id>,
}

/// A function whose results are expressions of its arguments.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name in generated code.
    pub name: String,
    /// What it computes, in a sentence.
    pub meaning: String,
    /// What it takes, in order. Inputs of the graph are counted through all of them.
    pub arguments: Vec<Argument>,
    /// What it gives, in order.
    pub outputs: Vec<Output>,
    /// The expressions.
    pub graph: Graph,
}

/// How many operations of each kind a function takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions, subtractions and changes of sign.
    pub additions: usize,
    /// Multiplications.
    pub multiplications: usize,
    /// Divisions.
    pub divisions: usize,
    /// Sines and cosines, each for one.
    pub circular: usize,
    /// Square roots, exponentials, hyperbolic tangents, arcs and choices.
    pub others: usize,
}

impl Operations {
    /// All of them.
    pub fn total(&self) -> usize {
        self.additions + self.multiplications + self.divisions + self.circular + self.others
    }
}

impl Function {
    /// Number of inputs, through all arguments.
    pub fn inputs(&self) -> usize {
        self.arguments.iter().map(|a| a.len).sum()
    }

    /// All results, through all outputs.
    pub fn results(&self) -> impl Iterator<Item = Id> + '_ {
        self.outputs.iter().flat_map(|output| output.entries.iter().copied())
    }

    /// The argument and the place in it of input `k`.
    pub fn argument_of(&self, mut k: usize) -> (&Argument, usize) {
        for argument in &self.arguments {
            if k < argument.len {
                return (argument, k);
            }
            k -= argument.len;
        }
        unreachable!("the graph has an input that no argument holds")
    }

    /// Operations that its results need, each expression counted once.
    pub fn operations(&self) -> Operations {
        let reached = self.graph.reached_from(self.results());
        let mut count = Operations::default();
        for (node, _) in self.graph.nodes().iter().zip(reached).filter(|(_, reached)| *reached) {
            match node {
                Node::Constant(_) | Node::Input(_) => {}
                Node::Neg(_) | Node::Add(..) | Node::Sub(..) => count.additions += 1,
                Node::Mul(..) => count.multiplications += 1,
                Node::Div(..) => count.divisions += 1,
                Node::Call(Elementary::Sin | Elementary::Cos, _) => count.circular += 1,
                Node::Call(..) | Node::Atan2(..) | Node::Select(_) => count.others += 1,
            }
        }
        count
    }

    /// The longest chain of operations that wait for each other, each counted as one.
    pub fn depth(&self) -> usize {
        let mut depth = vec![0; self.graph.len()];
        for (i, node) in self.graph.nodes().iter().enumerate() {
            let before = node.operands().map(|id: Id| depth[id.index()]).max().unwrap_or(0);
            depth[i] = before + usize::from(node.is_operation());
        }
        self.results().map(|id| depth[id.index()]).max().unwrap_or(0)
    }

    /// Results at the given arguments, one vector per output.
    ///
    /// # Panics
    /// If `inputs` has not as many numbers as all arguments together.
    pub fn evaluate<T: gyroflex::Scalar>(&self, inputs: &[T]) -> Vec<Vec<T>> {
        assert_eq!(inputs.len(), self.inputs(), "{} takes other arguments", self.name);
        let reached = self.graph.reached_from(self.results());
        let values = self.graph.evaluate(inputs, Some(&reached));
        self.outputs.iter().map(|output| output.entries.iter().map(|id| values[id.index()]).collect()).collect()
    }
}
