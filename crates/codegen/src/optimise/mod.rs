//! Fewer operations for the same numbers, and shorter chains of them.
//!
//! Algorithms add and multiply in the order in which they find things. Sums are taken apart into terms here, equal terms are
//! added, factors that several terms share are taken out of them, and what is ready first is added first, so that less waits.

mod sums;

use crate::function::Function;

/// Rounds after which no robot's functions have been seen to get shorter.
const ROUNDS: usize = 8;

/// A function with the same results, but for rounding, from fewer operations or a shorter chain of them.
pub fn optimise(function: &Function) -> Function {
    let cost = |f: &Function| (f.operations().total(), f.depth());
    let mut best = function.clone();
    for _ in 0..ROUNDS {
        let next = sums::factored(&best);
        if cost(&next) >= cost(&best) {
            break;
        }
        best = next;
    }
    best
}
