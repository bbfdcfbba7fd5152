//! Sums of terms with common factors.

use crate::function::Function;
use crate::graph::{Graph, Id, Node};
use rustc_hash::FxHashMap;

/// `coefficient · Π factors`; none stands for one.
#[derive(Clone, Debug)]
struct Term {
    coefficient: f64,
    factors: Vec<Id>,
}

/// The function with every sum rewritten.
pub(super) fn factored(function: &Function) -> Function {
    let old = &function.graph;
    let reached = old.reached_from(function.results());
    let mut uses = vec![0_u32; old.len()];
    function.results().for_each(|id| uses[id.index()] += 2);
    for (i, node) in old.nodes().iter().enumerate() {
        if reached[i] {
            node.operands().for_each(|o| uses[o.index()] += 1);
        }
    }
    let mut at = Rewriting { old, uses, new: Graph::new(), depth: Vec::new(), image: vec![None; old.len()] };
    for i in 0..old.len() {
        let id = Id(i as u32);
        // What a sum or a product takes in is written there.
        if reached[i] && !at.is_taken_in(id) {
            at.image[i] = Some(at.written(id));
        }
    }
    let image = |id: &Id| at.image[id.index()].expect("results are written");
    let outputs = function.outputs.iter().map(|output| {
        let mut output = output.clone();
        output.entries = output.entries.iter().map(image).collect();
        output
    });
    Function { outputs: outputs.collect(), graph: at.new, ..function.clone() }
}

struct Rewriting<'a> {
    old: &'a Graph,
    uses: Vec<u32>,
    new: Graph,
    /// Longest chain of operations before each new node.
    depth: Vec<u32>,
    image: Vec<Option<Id>>,
}

impl Rewriting<'_> {
    /// Whether the only use of an expression is a sum or a product that opens it.
    fn is_taken_in(&self, id: Id) -> bool {
        let opened = matches!(self.old.node(id), Node::Add(..) | Node::Sub(..) | Node::Neg(_) | Node::Mul(..));
        opened && self.uses[id.index()] == 1
    }

    /// The new expression of an old one.
    fn written(&mut self, id: Id) -> Id {
        match self.old.node(id) {
            Node::Add(..) | Node::Sub(..) | Node::Neg(_) | Node::Mul(..) => {
                let mut terms = Vec::new();
                self.open(id, 1.0, &mut terms, true);
                let sum = self.sum(terms);
                self.value(sum)
            }
            node => {
                let mut operands = [None; 4];
                for (slot, operand) in operands.iter_mut().zip(node.operands()) {
                    *slot = Some((operand, self.of(operand)));
                }
                let map = |id: Id| operands.iter().flatten().find(|(old, _)| *old == id).expect("an operand").1;
                let id = self.new.rebuild(node, map);
                self.note();
                id
            }
        }
    }

    /// The new expression of an operand, written now if it was left to its user.
    fn of(&mut self, id: Id) -> Id {
        match self.image[id.index()] {
            Some(new) => new,
            None => {
                let new = self.written(id);
                self.image[id.index()] = Some(new);
                new
            }
        }
    }

    /// Terms of `coefficient · id`: sums that nothing else uses are opened, and the `first` one.
    fn open(&mut self, id: Id, coefficient: f64, terms: &mut Vec<Term>, first: bool) {
        if !first && self.uses[id.index()] != 1 {
            let of = self.of(id);
            terms.push(self.term(coefficient, of));
            return;
        }
        match self.old.node(id) {
            Node::Add(a, b) => {
                self.open(a, coefficient, terms, false);
                self.open(b, coefficient, terms, false);
            }
            Node::Sub(a, b) => {
                self.open(a, coefficient, terms, false);
                self.open(b, -coefficient, terms, false);
            }
            Node::Neg(a) => self.open(a, -coefficient, terms, false),
            Node::Mul(..) => {
                let mut term = Term { coefficient, factors: Vec::new() };
                self.factors(id, &mut term, true);
                terms.push(term);
            }
            _ => {
                let of = self.of(id);
                terms.push(self.term(coefficient, of));
            }
        }
    }

    fn term(&self, coefficient: f64, id: Id) -> Term {
        match self.new.node(id) {
            Node::Constant(bits) => Term { coefficient: coefficient * f64::from_bits(bits), factors: Vec::new() },
            Node::Neg(a) => Term { coefficient: -coefficient, factors: vec![a] },
            _ => Term { coefficient, factors: vec![id] },
        }
    }

    /// Factors of a product: products that nothing else uses are opened, and the `first` one.
    fn factors(&mut self, id: Id, term: &mut Term, first: bool) {
        match self.old.node(id) {
            Node::Mul(a, b) if first || self.uses[id.index()] == 1 => {
                self.factors(a, term, false);
                self.factors(b, term, false);
            }
            Node::Neg(a) if self.uses[id.index()] == 1 => {
                term.coefficient = -term.coefficient;
                self.factors(a, term, false);
            }
            _ => {
                let of = self.of(id);
                let one = self.term(1.0, of);
                term.coefficient *= one.coefficient;
                term.factors.extend(one.factors);
            }
        }
    }

    /// Adds terms, the most common factor taken out first.
    fn sum(&mut self, terms: Vec<Term>) -> (f64, Id) {
        // Equal terms are one.
        let mut alike: FxHashMap<Vec<Id>, usize> = FxHashMap::default();
        let mut distinct: Vec<Term> = Vec::new();
        for mut term in terms {
            term.factors.sort_unstable();
            match alike.get(&term.factors) {
                Some(k) => distinct[*k].coefficient += term.coefficient,
                None => {
                    alike.insert(term.factors.clone(), distinct.len());
                    distinct.push(term);
                }
            }
        }
        distinct.retain(|term| term.coefficient != 0.0);
        let mut parts: Vec<(f64, Id)> = Vec::new();
        while let Some(factor) = most_common(&distinct) {
            let (mut inside, rest): (Vec<Term>, Vec<Term>) =
                distinct.into_iter().partition(|t| t.factors.contains(&factor));
            distinct = rest;
            for term in &mut inside {
                let at = term.factors.iter().position(|f| *f == factor).expect("it contains the factor");
                term.factors.remove(at);
            }
            let (c, sum) = self.sum(inside);
            parts.push((c, self.times(factor, sum)));
        }
        for term in distinct {
            let product = self.product(term.factors);
            parts.push((term.coefficient, product));
        }
        self.add_up(parts)
    }

    fn times(&mut self, a: Id, b: Id) -> Id {
        let id = self.new.mul(a, b);
        self.note();
        id
    }

    fn number(&mut self, x: f64) -> Id {
        let id = self.new.constant(x);
        self.note();
        id
    }

    /// A product, what is ready first multiplied first.
    fn product(&mut self, mut factors: Vec<Id>) -> Id {
        if factors.is_empty() {
            return self.number(1.0);
        }
        while factors.len() > 1 {
            factors.sort_by_key(|f| std::cmp::Reverse((self.depth[f.index()], f.index())));
            let (a, b) = (factors.pop().expect("two"), factors.pop().expect("two"));
            let product = self.times(a, b);
            factors.push(product);
        }
        factors[0]
    }

    /// `Σ c x` as a coefficient and an expression, what is ready first added first.
    fn add_up(&mut self, mut parts: Vec<(f64, Id)>) -> (f64, Id) {
        if parts.is_empty() {
            return (1.0, self.number(0.0));
        }
        if let [one] = parts[..] {
            return one;
        }
        // A sum all of whose terms have the same number before them is that number times a sum.
        let common = parts[0].0.abs();
        let outside = if parts.iter().all(|(c, _)| c.abs() == common) { common } else { 1.0 };
        parts.iter_mut().for_each(|(c, _)| *c /= outside);
        let mut terms: Vec<(bool, Id)> = Vec::new();
        for (c, x) in parts {
            let scaled = self.new.scaled(c.abs(), x);
            self.note();
            terms.push((c < 0.0, scaled));
        }
        while terms.len() > 1 {
            terms.sort_by_key(|(_, x)| std::cmp::Reverse((self.depth[x.index()], x.index())));
            let (a, b) = (terms.pop().expect("two"), terms.pop().expect("two"));
            let (negative, sum) = match (a.0, b.0) {
                (false, false) => (false, self.new.add(a.1, b.1)),
                (true, true) => (true, self.new.add(a.1, b.1)),
                (false, true) => (false, self.new.sub(a.1, b.1)),
                (true, false) => (false, self.new.sub(b.1, a.1)),
            };
            self.note();
            terms.push((negative, sum));
        }
        let (negative, sum) = terms[0];
        (if negative { -outside } else { outside }, sum)
    }

    fn value(&mut self, (c, x): (f64, Id)) -> Id {
        let value = self.new.scaled(c, x);
        self.note();
        value
    }

    /// Keeps the depth of the nodes that have been made since.
    fn note(&mut self) {
        for i in self.depth.len()..self.new.len() {
            let node = self.new.nodes()[i];
            let before = node.operands().map(|o| self.depth[o.index()]).max().unwrap_or(0);
            self.depth.push(before + u32::from(node.is_operation()));
        }
    }
}

/// The factor that most terms have, if two have one.
fn most_common(terms: &[Term]) -> Option<Id> {
    let mut count: FxHashMap<Id, usize> = FxHashMap::default();
    for term in terms {
        let mut last = None;
        for factor in &term.factors {
            if last != Some(factor) {
                *count.entry(*factor).or_default() += 1;
            }
            last = Some(factor);
        }
    }
    count.into_iter().filter(|(_, n)| *n > 1).max_by_key(|(id, n)| (*n, id.index())).map(|(id, _)| id)
}
