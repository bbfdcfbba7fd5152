//! The constructors, and what they simplify at once.
//!
//! Signs are kept outside: `(−a) b` is `−(a b)`, and a sum with a negative term is a difference. A number times a number times
//! something is one number times it. Sines and cosines of an angle with a constant multiple of a right angle in it lose
//! that part, so that frames turned by right angles cost nothing; products of them that add up to those of a sum of
//! angles become these (parallel axes).

use super::{Elementary, Graph, Id, Node};
use core::f64::consts::FRAC_PI_2;

/// Fraction of a right angle below which an angle is a multiple of it [–]: offsets in files have a dozen digits and more.
const RIGHT: f64 = 1e-14;

impl Graph {
    /// `−a`.
    pub fn neg(&mut self, a: Id) -> Id {
        match self.node(a) {
            Node::Constant(bits) => self.constant(-f64::from_bits(bits)),
            Node::Neg(b) => b,
            Node::Sub(x, y) => self.sub(y, x),
            Node::Mul(x, y) => match (self.number(x), self.number(y)) {
                (Some(c), _) => self.scaled(-c, y),
                (_, Some(c)) => self.scaled(-c, x),
                _ => self.intern(Node::Neg(a)),
            },
            _ => self.intern(Node::Neg(a)),
        }
    }

    /// `a + b`.
    pub fn add(&mut self, a: Id, b: Id) -> Id {
        let (a, b) = (a.min(b), a.max(b));
        match (self.node(a), self.node(b)) {
            (Node::Constant(x), Node::Constant(y)) => self.constant(f64::from_bits(x) + f64::from_bits(y)),
            (Node::Constant(x), _) if f64::from_bits(x) == 0.0 => b,
            (_, Node::Constant(y)) if f64::from_bits(y) == 0.0 => a,
            (Node::Neg(x), Node::Neg(y)) => {
                let sum = self.add(x, y);
                self.neg(sum)
            }
            (_, Node::Neg(y)) => self.sub(a, y),
            (Node::Neg(x), _) => self.sub(b, x),
            (_, Node::Sub(x, y)) if y == a => x,
            (Node::Sub(x, y), _) if y == b => x,
            (x, y) => match self.angle_sum(x, y) {
                Some((_, angle)) => angle,
                None => self.intern(Node::Add(a, b)),
            },
        }
    }

    /// `a − b`.
    pub fn sub(&mut self, a: Id, b: Id) -> Id {
        if a == b {
            return self.constant(0.0);
        }
        match (self.node(a), self.node(b)) {
            (Node::Constant(x), Node::Constant(y)) => self.constant(f64::from_bits(x) - f64::from_bits(y)),
            (Node::Constant(x), _) if f64::from_bits(x) == 0.0 => self.neg(b),
            (_, Node::Constant(y)) if f64::from_bits(y) == 0.0 => a,
            (_, Node::Constant(y)) => {
                let y = self.constant(-f64::from_bits(y));
                self.add(a, y)
            }
            (_, Node::Neg(y)) => self.add(a, y),
            (Node::Neg(x), _) => {
                let sum = self.add(x, b);
                self.neg(sum)
            }
            (Node::Add(x, y), _) if y == b => x,
            (Node::Add(x, y), _) if x == b => y,
            (_, Node::Add(x, y)) if y == a => self.neg(x),
            (_, Node::Add(x, y)) if x == a => self.neg(y),
            (_, Node::Sub(x, y)) if x == a => y,
            (x, y) => match self.angle_difference(x, y) {
                Some(angle) => angle,
                None => self.intern(Node::Sub(a, b)),
            },
        }
    }

    /// `a b`.
    pub fn mul(&mut self, a: Id, b: Id) -> Id {
        let (a, b) = (a.min(b), a.max(b));
        match (self.node(a), self.node(b)) {
            (Node::Constant(x), _) => self.scaled(f64::from_bits(x), b),
            (_, Node::Constant(y)) => self.scaled(f64::from_bits(y), a),
            (Node::Neg(x), Node::Neg(y)) => self.mul(x, y),
            (Node::Neg(x), _) => {
                let product = self.mul(x, b);
                self.neg(product)
            }
            (_, Node::Neg(y)) => {
                let product = self.mul(a, y);
                self.neg(product)
            }
            (Node::Div(one, x), _) if self.number(one) == Some(1.0) && x == b => one,
            (_, Node::Div(one, y)) if self.number(one) == Some(1.0) && y == a => one,
            _ => self.intern(Node::Mul(a, b)),
        }
    }

    /// `c x`.
    pub fn scaled(&mut self, c: f64, x: Id) -> Id {
        match (c, self.node(x)) {
            (_, Node::Constant(bits)) => self.constant(c * f64::from_bits(bits)),
            (0.0, _) => self.constant(0.0),
            (1.0, _) => x,
            (-1.0, Node::Neg(y)) => y,
            (-1.0, Node::Sub(y, z)) => self.sub(z, y),
            (_, Node::Neg(y)) => self.scaled(-c, y),
            (_, Node::Mul(y, z)) if self.number(y).is_some() => self.scaled(c * self.number(y).unwrap_or(1.0), z),
            (_, Node::Mul(y, z)) if self.number(z).is_some() => self.scaled(c * self.number(z).unwrap_or(1.0), y),
            (-1.0, _) => self.intern(Node::Neg(x)),
            _ => {
                let c = self.constant(c);
                self.intern(Node::Mul(c.min(x), c.max(x)))
            }
        }
    }

    /// `a / b`; by a number, the product with its reciprocal.
    pub fn div(&mut self, a: Id, b: Id) -> Id {
        if a == b {
            return self.constant(1.0);
        }
        match (self.node(a), self.node(b)) {
            (_, Node::Constant(y)) if f64::from_bits(y) != 0.0 => self.scaled(1.0 / f64::from_bits(y), a),
            (Node::Constant(x), _) if f64::from_bits(x) == 0.0 => a,
            (Node::Neg(x), _) => {
                let quotient = self.div(x, b);
                self.neg(quotient)
            }
            (_, Node::Neg(y)) => {
                let quotient = self.div(a, y);
                self.neg(quotient)
            }
            _ => self.intern(Node::Div(a, b)),
        }
    }

    /// An elementary function.
    pub fn call(&mut self, f: Elementary, x: Id) -> Id {
        match (f, self.node(x)) {
            (Elementary::Sin | Elementary::Cos, _) => {
                let (sin, cos) = self.sin_cos(x);
                if f == Elementary::Sin { sin } else { cos }
            }
            (_, Node::Constant(bits)) => self.constant(f.of(f64::from_bits(bits))),
            (Elementary::Tanh, Node::Neg(y)) => {
                let tanh = self.call(f, y);
                self.neg(tanh)
            }
            _ => self.intern(Node::Call(f, x)),
        }
    }

    /// `sin x` and `cos x`.
    pub fn sin_cos(&mut self, x: Id) -> (Id, Id) {
        match self.node(x) {
            Node::Constant(bits) => {
                let (quarters, rest) = quarter_turns(f64::from_bits(bits));
                let (sin, cos) = (self.constant(rest.sin()), self.constant(rest.cos()));
                self.turned(quarters, sin, cos)
            }
            Node::Neg(y) => {
                let (sin, cos) = self.sin_cos(y);
                (self.neg(sin), cos)
            }
            Node::Add(y, z) => match (self.number(y), self.number(z)) {
                (Some(c), _) => self.sin_cos_beyond(c, z),
                (_, Some(c)) => self.sin_cos_beyond(c, y),
                _ => self.sin_cos_of(x),
            },
            _ => self.sin_cos_of(x),
        }
    }

    fn sin_cos_of(&mut self, x: Id) -> (Id, Id) {
        (self.intern(Node::Call(Elementary::Sin, x)), self.intern(Node::Call(Elementary::Cos, x)))
    }

    /// Of `c + x`.
    fn sin_cos_beyond(&mut self, c: f64, x: Id) -> (Id, Id) {
        let (quarters, rest) = quarter_turns(c);
        let rest = self.constant(rest);
        let angle = match self.number(rest) {
            Some(0.0) => x,
            _ => self.intern(Node::Add(rest.min(x), rest.max(x))),
        };
        let (sin, cos) = self.sin_cos_of(angle);
        self.turned(quarters, sin, cos)
    }

    /// Sine and cosine of an angle and so many quarter turns.
    fn turned(&mut self, quarters: u8, sin: Id, cos: Id) -> (Id, Id) {
        match quarters {
            0 => (sin, cos),
            1 => (cos, self.neg(sin)),
            2 => (self.neg(sin), self.neg(cos)),
            _ => (self.neg(cos), sin),
        }
    }

    /// `sin a cos b + cos a sin b = sin(a + b)` of two products that are added; which function, and the expression.
    fn angle_sum(&mut self, x: Node, y: Node) -> Option<(Elementary, Id)> {
        use Elementary::{Cos, Sin};
        let ((f, a), (g, b)) = self.circular_product(x)?;
        let ((h, c), (i, d)) = self.circular_product(y)?;
        match ((f, a), (g, b), (h, c), (i, d)) {
            // cos(a − b) = cos a cos b + sin a sin b
            ((Cos, a), (Cos, b), (Sin, c), (Sin, d)) | ((Sin, a), (Sin, b), (Cos, c), (Cos, d))
                if (a, b) == (c, d) || (a, b) == (d, c) =>
            {
                let angle = self.sub(a, b);
                Some((Cos, self.call(Cos, angle)))
            }
            ((Sin, a), (Cos, b), (Cos, c), (Sin, d))
            | ((Sin, a), (Cos, b), (Sin, d), (Cos, c))
            | ((Cos, b), (Sin, a), (Cos, c), (Sin, d))
            | ((Cos, b), (Sin, a), (Sin, d), (Cos, c))
                if (a, b) == (c, d) =>
            {
                let angle = self.add(a, b);
                Some((Sin, self.call(Sin, angle)))
            }
            _ => None,
        }
    }

    /// `cos a cos b − sin a sin b = cos(a + b)`, `sin a cos b − cos a sin b = sin(a − b)` of two products.
    fn angle_difference(&mut self, x: Node, y: Node) -> Option<Id> {
        use Elementary::{Cos, Sin};
        let ((f, a), (g, b)) = self.circular_product(x)?;
        let ((h, c), (i, d)) = self.circular_product(y)?;
        match ((f, a), (g, b), (h, c), (i, d)) {
            ((Cos, a), (Cos, b), (Sin, c), (Sin, d)) if (a, b) == (c, d) || (a, b) == (d, c) => {
                let angle = self.add(a, b);
                Some(self.call(Cos, angle))
            }
            ((Sin, a), (Cos, b), (Cos, c), (Sin, d))
            | ((Sin, a), (Cos, b), (Sin, d), (Cos, c))
            | ((Cos, b), (Sin, a), (Cos, c), (Sin, d))
            | ((Cos, b), (Sin, a), (Sin, d), (Cos, c))
                if (a, b) == (c, d) =>
            {
                let angle = self.sub(a, b);
                Some(self.call(Sin, angle))
            }
            _ => None,
        }
    }

    /// The factors of a product of two sines or cosines of different angles.
    fn circular_product(&self, node: Node) -> Option<((Elementary, Id), (Elementary, Id))> {
        let Node::Mul(x, y) = node else { return None };
        let factor = |id: Id| match self.node(id) {
            Node::Call(f @ (Elementary::Sin | Elementary::Cos), angle) => Some((f, angle)),
            _ => None,
        };
        let (x, y) = (factor(x)?, factor(y)?);
        (x.1 != y.1).then_some((x, y))
    }

    /// Angle [rad] of the point `(x, y)`.
    pub fn atan2(&mut self, y: Id, x: Id) -> Id {
        match (self.number(y), self.number(x)) {
            (Some(y), Some(x)) => self.constant(y.atan2(x)),
            _ => self.intern(Node::Atan2(y, x)),
        }
    }

    /// `less` where `x < threshold`, else `otherwise`.
    pub fn select_less(&mut self, x: Id, threshold: Id, less: Id, otherwise: Id) -> Id {
        match (self.number(x), self.number(threshold)) {
            _ if less == otherwise => less,
            (Some(x), Some(threshold)) => {
                if x < threshold {
                    less
                } else {
                    otherwise
                }
            }
            _ => self.intern(Node::Select([x, threshold, less, otherwise])),
        }
    }
}

/// Quarter turns in an angle, modulo four, and what is left of it: nothing where it is as good as a right angle.
fn quarter_turns(x: f64) -> (u8, f64) {
    let quarters = (x / FRAC_PI_2).round();
    let rest = x - quarters * FRAC_PI_2;
    if rest.abs() <= RIGHT * quarters.abs().max(1.0) { (quarters.rem_euclid(4.0) as u8, 0.0) } else { (0, x) }
}
