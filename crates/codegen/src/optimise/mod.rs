//! Fewer operations for the same numbers.
//!
//! Algorithms add and multiply in the order in which they find things. Sums are taken apart into terms here, equal terms are
//! added, factors that several terms share are taken out of them, and what is left is added so that what is ready first goes
//! first.

mod sums;

use crate::function::Function;

/// A function with the same results, but for rounding, from fewer operations.
pub fn optimise(function: &Function) -> Function {
    let mut best = function.clone();
    loop {
        let next = sums::factored(&best);
        if next.operations().total() >= best.operations().total() {
            return best;
        }
        best = next;
    }
}
