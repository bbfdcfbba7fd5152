//! Dense matrices by rows, computed eight columns side by side, from the rows that went before: no entry is read again soon after it
//! was written.

use crate::Scalar;
use crate::dispatch::Over;

/// How many columns are computed side by side: they fill a register of the widest processors.
const COLUMNS: usize = 8;

/// Entries from one row to the next of a square matrix for [`invert`]: its columns fill whole groups.
pub(super) const fn stride(nv: usize) -> usize {
    nv.next_multiple_of(COLUMNS)
}

/// `M⁻¹` of a symmetric positive definite `m`, given below and on the diagonal; `m` and `pivots` are used up. Both matrices have
/// rows of [`stride`] entries.
///
/// `Lᵀ D L = M` (RBDA table 6.3), with `L⁻ᵀ` beside it; `M⁻¹ = L⁻¹ D⁻¹ L⁻ᵀ`.
#[inline(always)]
pub(super) fn invert<T: Scalar, F: Over<T>>(nv: usize, m: &mut [T], pivots: &mut [T], inverse: &mut [T]) {
    let stride = stride(nv);
    // Row i of D L: M_i − Σ L_ki (D L)_k over k > i;  of L⁻ᵀ: e_i − Σ L_ki (L⁻ᵀ)_k
    for i in (0..nv).rev() {
        for column in (0..stride).step_by(COLUMNS) {
            let mut left: [F; COLUMNS] = load(m, i * stride + column);
            let mut right = [F::zero(); COLUMNS];
            if let Some(one) = i.checked_sub(column).and_then(|at| right.get_mut(at)) {
                *one = F::one();
            }
            for k in i + 1..nv {
                let l = -at::<T, F>(m, k * stride + i) * at(pivots, k);
                left = plus_scaled(left, l, load(m, k * stride + column));
                right = plus_scaled(right, l, load(inverse, k * stride + column));
            }
            store(m, i * stride + column, left);
            store(inverse, i * stride + column, right);
        }
        if let Some(pivot) = pivots.get_mut(i) {
            *pivot = (F::one() / at(m, i * stride + i)).store();
        }
    }
    // Row i of M⁻¹: Σ (L⁻ᵀ)_ki / D_k (L⁻ᵀ)_k over k ⩽ i, in the place of row i of L⁻ᵀ
    for i in (0..nv).rev() {
        for column in (0..stride).step_by(COLUMNS) {
            let own = load(inverse, i * stride + column);
            let mut sum = plus_scaled([F::zero(); COLUMNS], at(pivots, i), own);
            for k in 0..i {
                let factor = at::<T, F>(inverse, k * stride + i) * at(pivots, k);
                sum = plus_scaled(sum, factor, load(inverse, k * stride + column));
            }
            store(inverse, i * stride + column, sum);
        }
    }
}

/// `out ← a B`: one row of a product. `B` has rows as long as `out`, of which those beyond the entries of `a` are left out.
#[inline(always)]
pub(super) fn row_times<T: Scalar, F: Over<T>>(a: &[T], b: &[T], out: &mut [T]) {
    let width = out.len();
    let mut column = 0;
    while column + COLUMNS <= width {
        store(out, column, group::<T, F, COLUMNS>(a, b, width, column));
        column += COLUMNS;
    }
    if column < width && width >= COLUMNS {
        // The last group reaches back, so that it is whole.
        store(out, width - COLUMNS, group::<T, F, COLUMNS>(a, b, width, width - COLUMNS));
        return;
    }
    for column in column..width {
        store(out, column, group::<T, F, 1>(a, b, width, column));
    }
}

/// `N` entries of `a B`, from a column on.
#[inline(always)]
fn group<T: Scalar, F: Over<T>, const N: usize>(a: &[T], b: &[T], width: usize, column: usize) -> [F; N] {
    let mut sum = [F::zero(); N];
    for (k, factor) in a.iter().enumerate() {
        sum = plus_scaled(sum, F::load(*factor), load(b, k * width + column));
    }
    sum
}

#[inline(always)]
fn plus_scaled<F: Scalar, const N: usize>(sum: [F; N], s: F, x: [F; N]) -> [F; N] {
    core::array::from_fn(|i| s.mul_add(x[i], sum[i]))
}

#[inline(always)]
fn at<T: Scalar, F: Over<T>>(entries: &[T], at: usize) -> F {
    entries.get(at).map_or(F::zero(), |entry| F::load(*entry))
}

#[inline(always)]
fn load<T: Scalar, F: Over<T>, const N: usize>(entries: &[T], at: usize) -> [F; N] {
    match entries.get(at..).and_then(|entries| entries.first_chunk::<N>()) {
        Some(from) => from.map(F::load),
        None => [F::zero(); N],
    }
}

#[inline(always)]
fn store<T: Scalar, F: Over<T>, const N: usize>(entries: &mut [T], at: usize, x: [F; N]) {
    if let Some(to) = entries.get_mut(at..).and_then(|entries| entries.first_chunk_mut::<N>()) {
        *to = x.map(F::store);
    }
}
