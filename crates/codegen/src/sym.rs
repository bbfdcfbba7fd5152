//! Numbers without a value: the scalar that turns an algorithm into a graph.

use crate::graph::{Elementary, Graph, Id};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use gyroflex::Scalar;
use std::cell::RefCell;

thread_local! {
    /// The graph that this thread's symbols belong to: a scalar is `Copy` and has nowhere to keep it.
    static GRAPH: RefCell<Graph> = RefCell::new(Graph::new());
}

/// An expression. Every algorithm of the core runs on it unchanged, and what it leaves in its results are formulas.
///
/// Every operation is a subroutine: algorithms that are inlined to the last operation would be compiled for minutes otherwise.
///
/// A symbol is of use inside the [`trace`] in which it was made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sym(Id);

/// Runs `build` on symbols of an empty graph: what it returns, and the graph.
pub fn trace<R>(build: impl FnOnce() -> R) -> (R, Graph) {
    let outside = GRAPH.replace(Graph::new());
    let result = build();
    (result, GRAPH.replace(outside))
}

fn on<R>(f: impl FnOnce(&mut Graph) -> R) -> R {
    GRAPH.with_borrow_mut(f)
}

impl Sym {
    /// Input number `k` of the function that is traced.
    pub fn input(k: usize) -> Self {
        Self(on(|g| g.input(k)))
    }

    /// The expression in the graph that [`trace`] returns.
    pub fn id(self) -> Id {
        self.0
    }

    /// Its number, if it is one.
    pub fn number(self) -> Option<f64> {
        on(|g| g.number(self.0))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $assign:ident, $assign_method:ident) => {
        operator!($trait, $method);
        impl $assign for Sym {
            #[inline(never)]
            fn $assign_method(&mut self, b: Self) {
                *self = $trait::$method(*self, b);
            }
        }
    };
    ($trait:ident, $method:ident) => {
        impl $trait for Sym {
            type Output = Self;
            #[inline(never)]
            fn $method(self, b: Self) -> Self {
                Self(on(|g| g.$method(self.0, b.0)))
            }
        }
    };
}
operator!(Add, add, AddAssign, add_assign);
operator!(Sub, sub, SubAssign, sub_assign);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Sym {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Self(on(|g| g.neg(self.0)))
    }
}

impl Scalar for Sym {
    type Param = Self;

    fn from_param(x: Self) -> Self {
        x
    }
    #[inline(never)]
    fn from_f64(x: f64) -> Self {
        Self(on(|g| g.constant(x)))
    }
    #[inline(never)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    fn is_finite(self) -> bool {
        true
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        Self(on(|g| g.call(Elementary::Sqrt, self.0)))
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = on(|g| g.sin_cos(self.0));
        (Self(sin), Self(cos))
    }
    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        Self(on(|g| g.atan2(self.0, x.0)))
    }
    #[inline(never)]
    fn tanh(self) -> Self {
        Self(on(|g| g.call(Elementary::Tanh, self.0)))
    }
    #[inline(never)]
    fn exp(self) -> Self {
        Self(on(|g| g.call(Elementary::Exp, self.0)))
    }
    #[inline(never)]
    fn select_less(self, threshold: Self, less: Self, otherwise: Self) -> Self {
        Self(on(|g| g.select_less(self.0, threshold.0, less.0, otherwise.0)))
    }
}
