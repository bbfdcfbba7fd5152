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
            // The row just written comes last.
            for k in (i + 1..nv).rev() {
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

/// Which part of a product is computed: `rows` rows of `width` entries, of which the first `columns`.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) width: usize,
}

/// `out ← Aᵀ B`, or `out + Aᵀ B` where `ONTO`. `A` is square with rows of `stride` entries, `B` and `out` have rows of `part.width`;
/// `terms(end)` says how many rows of `A` count for the rows of `out` before `end`.
#[inline(always)]
pub(super) fn transposed_times<T: Scalar, F: Over<T>, const ONTO: bool>(
    (a, stride): (&[T], usize),
    terms: impl Fn(usize) -> usize,
    b: &[T],
    out: &mut [T],
    part: Part,
) {
    let (mut row, nv) = (0, part.rows);
    while row + 4 <= nv {
        rows::<T, F, 4, ONTO>((a, stride), terms(row + 4), b, out, (row, part));
        row += 4;
    }
    match nv - row {
        3 => rows::<T, F, 3, ONTO>((a, stride), terms(nv), b, out, (row, part)),
        2 => rows::<T, F, 2, ONTO>((a, stride), terms(nv), b, out, (row, part)),
        1 => rows::<T, F, 1, ONTO>((a, stride), terms(nv), b, out, (row, part)),
        _ => {}
    }
}

/// `R` rows of a product from `row` on.
#[inline(always)]
fn rows<T: Scalar, F: Over<T>, const R: usize, const ONTO: bool>(
    a: (&[T], usize),
    terms: usize,
    b: &[T],
    out: &mut [T],
    (row, Part { columns, width, .. }): (usize, Part),
) {
    let tile = |out: &[T], column| tile::<T, F, R, COLUMNS, ONTO>(a, terms, b, out, (row, width), column);
    let whole = columns - columns % COLUMNS;
    // The last group reaches back, so that it is whole: taken first, put last.
    let last = (whole < columns && whole > 0).then(|| tile(out, columns - COLUMNS));
    for column in (0..whole).step_by(COLUMNS) {
        let sums = tile(out, column);
        put(out, (row, width), column, sums);
    }
    match last {
        Some(last) => put(out, (row, width), columns - COLUMNS, last),
        None => {
            for column in whole..columns {
                let sums = self::tile::<T, F, R, 1, ONTO>(a, terms, b, out, (row, width), column);
                put(out, (row, width), column, sums);
            }
        }
    }
}

/// `R` rows and `N` columns of a product: every row of `B` is read once for all of them.
#[inline(always)]
fn tile<T: Scalar, F: Over<T>, const R: usize, const N: usize, const ONTO: bool>(
    (a, stride): (&[T], usize),
    terms: usize,
    b: &[T],
    out: &[T],
    (row, width): (usize, usize),
    column: usize,
) -> [[F; N]; R] {
    let mut sums = core::array::from_fn(|r| if ONTO { load(out, (row + r) * width + column) } else { [F::zero(); N] });
    for k in 0..terms {
        let from: [F; N] = load(b, k * width + column);
        let Some(factors) = a.get(k * stride + row..).and_then(|a| a.first_chunk::<R>()) else { break };
        for (sum, factor) in sums.iter_mut().zip(factors) {
            *sum = plus_scaled(*sum, F::load(*factor), from);
        }
    }
    sums
}

#[inline(always)]
fn put<T: Scalar, F: Over<T>, const R: usize, const N: usize>(
    out: &mut [T],
    (row, width): (usize, usize),
    column: usize,
    sums: [[F; N]; R],
) {
    for (r, sum) in sums.into_iter().enumerate() {
        store(out, (row + r) * width + column, sum);
    }
}

#[inline(always)]
fn plus_scaled<F: Scalar, const N: usize>(sum: [F; N], s: F, x: [F; N]) -> [F; N] {
    let mut out = sum;
    for i in 0..N {
        out[i] = s.mul_add(x[i], sum[i]);
    }
    out
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
