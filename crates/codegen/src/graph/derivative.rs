//! Derivatives of expressions.

use super::{Elementary, Graph, Id, Node};

impl Graph {
    /// Derivatives of every node by one of them, `by`, in the order of the nodes that were there before: forward, one rule an
    /// operation. `wanted` says whose derivatives are of interest.
    pub fn derivatives(&mut self, by: Id, wanted: &[bool]) -> Vec<Id> {
        let zero = self.constant(0.0);
        let one = self.constant(1.0);
        let mut of = vec![zero; wanted.len()];
        for i in 0..wanted.len() {
            let id = Id(i as u32);
            if id == by {
                of[i] = one;
                continue;
            }
            let node = self.node(id);
            if !wanted[i] || node.operands().all(|operand| of[operand.index()] == zero) {
                continue;
            }
            let d = |id: Id| of[id.index()];
            of[i] = match node {
                Node::Constant(_) | Node::Input(_) => zero,
                Node::Neg(a) => self.neg(d(a)),
                Node::Add(a, b) => self.add(d(a), d(b)),
                Node::Sub(a, b) => self.sub(d(a), d(b)),
                Node::Mul(a, b) => {
                    let (x, y) = (self.mul(d(a), b), self.mul(a, d(b)));
                    self.add(x, y)
                }
                Node::Div(a, b) => {
                    // (a' − (a/b) b')/b
                    let part = self.mul(id, d(b));
                    let rest = self.sub(d(a), part);
                    self.div(rest, b)
                }
                Node::Call(f, a) => {
                    let slope = self.slope(f, a, id);
                    self.mul(slope, d(a))
                }
                Node::Atan2(y, x) => {
                    // (x y' − y x')/(x² + y²)
                    let (xx, yy) = (self.mul(x, x), self.mul(y, y));
                    let (p, q) = (self.mul(x, d(y)), self.mul(y, d(x)));
                    let (square, rest) = (self.add(xx, yy), self.sub(p, q));
                    self.div(rest, square)
                }
                Node::Select([a, b, c, e]) => self.select_less(a, b, d(c), d(e)),
            };
        }
        of
    }

    /// `f'(a)`, where `f(a)` is `value`.
    fn slope(&mut self, f: Elementary, a: Id, value: Id) -> Id {
        match f {
            Elementary::Sin => self.call(Elementary::Cos, a),
            Elementary::Cos => {
                let sin = self.call(Elementary::Sin, a);
                self.neg(sin)
            }
            Elementary::Sqrt => {
                let half = self.constant(0.5);
                self.div(half, value)
            }
            Elementary::Tanh => {
                let (one, square) = (self.constant(1.0), self.mul(value, value));
                self.sub(one, square)
            }
            Elementary::Exp => value,
        }
    }
}
