//! From expressions to sums of terms, from the inputs up.

use super::sum::Collected;
use super::{Input, Layout, Monomial, NotExplicit, Sum};
use crate::graph::{Elementary, Graph, Id, Node};
use std::rc::Rc;

/// What becomes of the expressions of a graph.
pub(super) struct Expansion<'a> {
    graph: &'a Graph,
    layout: &'a Layout,
    /// Total degree in the modal coordinates at which everything is truncated.
    degree: usize,
    known: Vec<Option<Rc<Sum>>>,
}

impl<'a> Expansion<'a> {
    /// Of all that some results of a graph are made of. Angles stay angles: what is made of one outside a sine or cosine is left out.
    pub(super) fn new(
        graph: &'a Graph,
        layout: &'a Layout,
        degree: usize,
        results: impl IntoIterator<Item = Id>,
    ) -> Result<Self, NotExplicit> {
        let reached = graph.reached_from(results);
        let mut out = Self { graph, layout, degree, known: vec![None; graph.len()] };
        for (i, node) in graph.nodes().iter().enumerate().filter(|(i, _)| reached[*i]) {
            out.known[i] = out.node(*node)?.map(Rc::new);
        }
        Ok(out)
    }

    /// The sum that a result is.
    pub(super) fn of(&self, id: Id) -> Result<Sum, NotExplicit> {
        Ok(self.operand(id)?.as_ref().clone())
    }

    fn operand(&self, id: Id) -> Result<Rc<Sum>, NotExplicit> {
        self.known[id.index()].clone().ok_or(NotExplicit::BareAngle)
    }

    /// The sum of a node; none for an angle and what is made of angles by addition.
    fn node(&self, node: Node) -> Result<Option<Sum>, NotExplicit> {
        let layout = self.layout;
        let linear = matches!(node, Node::Add(..) | Node::Sub(..) | Node::Neg(_) | Node::Mul(..));
        if linear && node.operands().any(|id| self.known[id.index()].is_none()) {
            return Ok(None);
        }
        Ok(Some(match node {
            Node::Constant(bits) => Sum::constant(layout, f64::from_bits(bits)),
            Node::Input(k) => match layout.inputs[k as usize] {
                Input::Angle(_) => return Ok(None),
                Input::Variable(v) => Sum::term(Monomial::variable(layout, v), 1.0),
            },
            Node::Neg(a) => self.operand(a)?.scaled(-1.0),
            Node::Add(a, b) => self.operand(a)?.plus_scaled(1.0, self.operand(b)?.as_ref()),
            Node::Sub(a, b) => self.operand(a)?.plus_scaled(-1.0, self.operand(b)?.as_ref()),
            Node::Mul(a, b) => self.operand(a)?.times(self.operand(b)?.as_ref(), layout, self.degree),
            Node::Div(a, b) => {
                let reciprocal = self.reciprocal(self.operand(b)?.as_ref())?;
                self.operand(a)?.times(&reciprocal, layout, self.degree)
            }
            Node::Call(f @ (Elementary::Sin | Elementary::Cos), angle) => self.circular(f == Elementary::Sin, angle)?,
            Node::Call(f, _) => return Err(NotExplicit::Call(f.name())),
            Node::Atan2(..) => return Err(NotExplicit::Call("atan2")),
            Node::Select(_) => return Err(NotExplicit::Choice),
        }))
    }

    /// `1/(b + x)` with one term `b` and `x` small, which is what the modal coordinates are: `(1 − x/b + x²/b² − …)/b`.
    fn reciprocal(&self, divisor: &Sum) -> Result<Sum, NotExplicit> {
        let layout = self.layout;
        let (at_rest, small): (Vec<_>, Vec<_>) =
            divisor.terms().iter().cloned().partition(|(m, _)| m.degree(layout) == 0);
        let [(monomial, coefficient)] = at_rest.as_slice() else { return Err(NotExplicit::Quotient) };
        let inverse = monomial.inverse(layout).ok_or(NotExplicit::Quotient)?;
        let inverse = Sum::term(inverse, 1.0 / coefficient);
        let mut rest = Collected::default();
        small.into_iter().for_each(|(m, c)| rest.add(m, -c));
        let ratio = rest.sum().times(&inverse, layout, self.degree);
        let one = Sum::constant(layout, 1.0);
        let mut series = one.clone();
        for _ in 0..self.degree {
            series = one.plus_scaled(1.0, &series.times(&ratio, layout, self.degree));
        }
        Ok(series.times(&inverse, layout, self.degree))
    }

    /// Sine or cosine of whole multiples of angles and a number.
    fn circular(&self, sine: bool, angle: Id) -> Result<Sum, NotExplicit> {
        let layout = self.layout;
        let mut multiples = vec![0.0; layout.angles.len()];
        let offset = self.linear(angle, 1.0, &mut multiples)?;
        let mut whole = Vec::with_capacity(multiples.len());
        for k in multiples {
            if k != f64::round(k) || k.abs() > f64::from(i8::MAX) {
                return Err(NotExplicit::Angle);
            }
            whole.push(k as i8);
        }
        // Sine and cosine of what has been added up so far.
        let (mut s, mut c) = (Sum::constant(layout, offset.sin()), Sum::constant(layout, offset.cos()));
        for (g, range) in layout.groups.iter().enumerate() {
            let multiples = &whole[range.clone()];
            let harmonic = |sine| {
                Monomial::harmonic(layout, g, sine, multiples).map_or(Sum::zero(), |(m, sign)| Sum::term(m, sign))
            };
            let (sin, cos) = (harmonic(true), harmonic(false));
            let product = |a: &Sum, b: &Sum| a.times(b, layout, self.degree);
            (s, c) = (
                product(&s, &cos).plus_scaled(1.0, &product(&c, &sin)),
                product(&c, &cos).plus_scaled(-1.0, &product(&s, &sin)),
            );
        }
        Ok(if sine { s } else { c })
    }

    /// Adds the multiples of angles in `factor` times an expression to `multiples`; what is left is a number.
    fn linear(&self, id: Id, factor: f64, multiples: &mut [f64]) -> Result<f64, NotExplicit> {
        Ok(match self.graph.node(id) {
            Node::Constant(bits) => factor * f64::from_bits(bits),
            Node::Input(k) => match self.layout.inputs[k as usize] {
                Input::Angle(angle) => {
                    multiples[angle] += factor;
                    0.0
                }
                Input::Variable(_) => return Err(NotExplicit::Angle),
            },
            Node::Neg(a) => self.linear(a, -factor, multiples)?,
            Node::Add(a, b) => self.linear(a, factor, multiples)? + self.linear(b, factor, multiples)?,
            Node::Sub(a, b) => self.linear(a, factor, multiples)? + self.linear(b, -factor, multiples)?,
            Node::Mul(a, b) => match (self.graph.number(a), self.graph.number(b)) {
                (Some(x), _) => self.linear(b, factor * x, multiples)?,
                (_, Some(x)) => self.linear(a, factor * x, multiples)?,
                _ => return Err(NotExplicit::Angle),
            },
            _ => return Err(NotExplicit::Angle),
        })
    }
}
