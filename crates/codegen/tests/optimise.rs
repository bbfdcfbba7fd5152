//! Optimised functions: the same numbers from fewer operations.

mod common;

use common::{functions, inputs, seeds};
use gyroflex_codegen::optimise::optimise;

#[test]
fn optimised_functions_have_the_same_results() {
    for seed in seeds(100) {
        for function in functions(seed) {
            let x = inputs(&function, seed);
            let (plain, short) = (function.evaluate(&x), optimise(&function).evaluate(&x));
            for (plain, short) in plain.iter().zip(&short) {
                let size = plain.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
                for (a, b) in plain.iter().zip(short) {
                    assert!((a - b).abs() <= 1e-10 * size, "seed {seed}, {}: {a} and {b} of {size}", function.name);
                }
            }
        }
    }
}

#[test]
fn optimised_functions_take_no_more_operations() {
    let (mut before, mut after) = (0, 0);
    for seed in seeds(100) {
        for function in functions(seed) {
            let short = optimise(&function);
            let (a, b) = (function.operations().total(), short.operations().total());
            assert!(b <= a, "seed {seed}, {}: {b} operations in place of {a}", function.name);
            (before, after) = (before + a, after + b);
        }
    }
    assert!(after < before, "no function became shorter");
}
