//! The value of expressions at numbers.

use super::{Elementary, Graph, Id, Node};
use gyroflex::Scalar;

impl Graph {
    /// Values of all nodes at the given inputs, in the order of the nodes: of any scalar, so that a graph can be
    /// interpreted in `f32`, in lanes, or traced again. Nodes not marked in `wanted` are left at zero.
    pub fn evaluate<T: Scalar>(&self, inputs: &[T], wanted: Option<&[bool]>) -> Vec<T> {
        let mut values: Vec<T> = vec![T::zero(); self.len()];
        for (i, node) in self.nodes().iter().enumerate() {
            if wanted.is_some_and(|wanted| !wanted[i]) {
                continue;
            }
            let at = |id: Id| values[id.index()];
            values[i] = match *node {
                Node::Constant(bits) => T::from_f64(f64::from_bits(bits)),
                Node::Input(k) => inputs[k as usize],
                Node::Neg(a) => -at(a),
                Node::Add(a, b) => at(a) + at(b),
                Node::Sub(a, b) => at(a) - at(b),
                Node::Mul(a, b) => at(a) * at(b),
                Node::Div(a, b) => at(a) / at(b),
                Node::Call(Elementary::Sin, a) => at(a).sin_cos().0,
                Node::Call(Elementary::Cos, a) => at(a).sin_cos().1,
                Node::Call(Elementary::Sqrt, a) => at(a).sqrt(),
                Node::Call(Elementary::Tanh, a) => at(a).tanh(),
                Node::Call(Elementary::Exp, a) => at(a).exp(),
                Node::Atan2(a, b) => at(a).atan2(at(b)),
                Node::Select([a, b, c, d]) => at(a).select_less(at(b), at(c), at(d)),
            };
        }
        values
    }
}
