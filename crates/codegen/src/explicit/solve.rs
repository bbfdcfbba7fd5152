//! The solution of symmetric positive definite equations in symbols.

use crate::sym::Sym;
use gyroflex::Scalar;

/// `x` of `A x = b`, `A` by rows, by `L D Lᵀ`; zeros cost nothing.
pub(super) fn solved(mut a: Vec<Sym>, mut x: Vec<Sym>) -> Vec<Sym> {
    let n = x.len();
    let mut pivots = Vec::with_capacity(n);
    for j in 0..n {
        let inverse = Sym::one() / a[j * n + j];
        pivots.push(inverse);
        for i in j + 1..n {
            let l = a[i * n + j] * inverse;
            for k in j + 1..=i {
                let product = l * a[k * n + j];
                a[i * n + k] -= product;
            }
            // Column j is needed as it was until all rows are done.
            a[j * n + i] = l;
        }
    }
    for i in 0..n {
        for j in 0..i {
            let product = a[j * n + i] * x[j];
            x[i] -= product;
        }
    }
    for (x, inverse) in x.iter_mut().zip(&pivots) {
        *x = *x * *inverse;
    }
    for i in (0..n).rev() {
        for j in i + 1..n {
            let product = a[i * n + j] * x[j];
            x[i] -= product;
        }
    }
    x
}
