//! The modes of one link, eliminated one by one.
//!
//! A mode is to its link what a joint is to its parent: it has a column of force `U_j` per unit of its acceleration, an apparent
//! inertia `d_j`, and what is left of its own force. But the modes of a link act on one another, too. So the modal inertia matrix is
//! factored, `L D Lᵀ`, with `U_j ← U_j − Σ l_jk U_k` beside it, and the link's inertia loses `U_j U_jᵀ / d_j` for each.

use super::scratch::FlexibleMode;
use crate::Scalar;
use crate::spatial::{ArticulatedInertia, Force, Motion};

/// Eliminates the modes of a link: `ia` and `p` become those of a link whose modes are free. `matrix` is the modal inertia matrix by
/// rows, of which the lower triangle is read, and becomes `L`.
pub(super) fn eliminate<T: Scalar>(
    modes: &mut [FlexibleMode<T>],
    matrix: &mut [T],
    ia: &mut ArticulatedInertia<T>,
    p: &mut Force<T>,
) {
    let n = modes.len();
    for j in 0..n {
        let (before, this) = modes.split_at_mut(j);
        let mode = &mut this[0];
        // l_jk d_k = M_jk − Σ_m l_jm d_m l_km: the products are kept until row j is done with them.
        let mut d = matrix[j * n + j];
        for k in 0..j {
            let mut product = matrix[j * n + k];
            for m in 0..k {
                product -= matrix[j * n + m] * matrix[k * n + m];
            }
            matrix[j * n + k] = product;
        }
        for (k, other) in before.iter().enumerate() {
            let product = matrix[j * n + k];
            let l = product * other.d_inv;
            matrix[j * n + k] = l;
            d -= l * product;
            mode.u_cap = mode.u_cap.plus_scaled(-l, other.u_cap);
            mode.p -= l * other.p;
        }
        mode.d_inv = T::one() / d;
        *ia = ia.minus_outer(mode.u_cap, mode.d_inv);
        *p = p.plus_scaled(-(mode.p * mode.d_inv), mode.u_cap);
    }
}

/// `η̈` of the modes of a link of acceleration `a`.
pub(super) fn substitute<T: Scalar>(modes: &mut [FlexibleMode<T>], matrix: &[T], a: Motion<T>) {
    let n = modes.len();
    for j in (0..n).rev() {
        // η̈_j = −(p_j + U_j·a)/d_j − Σ_{k > j} l_kj η̈_k
        let mode = &modes[j];
        let mut etadd = -((mode.p + a.dot(mode.u_cap)) * mode.d_inv);
        for (k, other) in modes.iter().enumerate().skip(j + 1) {
            etadd -= matrix[k * n + j] * other.etadd;
        }
        modes[j].etadd = etadd;
    }
}
