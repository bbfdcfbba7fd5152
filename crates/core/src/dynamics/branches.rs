//! Symmetric matrices with the sparsity of a tree: `M_ij = 0` unless one joint supports the other. `M = Lᵀ D L` then fills in
//! nothing (RBDA §6.5, tables 6.3 to 6.5).

use crate::Scalar;
use crate::dispatch::Over;
use crate::model::Model;

/// `M = Lᵀ D L` in place, from the lower triangle: `L` below the diagonal, `D⁻¹` on it.
#[inline(always)]
pub(super) fn factorise<T: Scalar, F: Over<T>>(model: &Model<T::Param>, m: &mut [T]) {
    let nv = model.nv;
    for k in (0..nv).rev() {
        let d_inv = F::one() / F::load(m[k * nv + k]);
        m[k * nv + k] = d_inv.store();
        let mut i = supporting(model, k);
        while let Some(row) = i {
            let l = F::load(m[k * nv + row]) * d_inv;
            let mut j = Some(row);
            while let Some(column) = j {
                let entry = (-l).mul_add(F::load(m[k * nv + column]), F::load(m[row * nv + column]));
                m[row * nv + column] = entry.store();
                j = supporting(model, column);
            }
            m[k * nv + row] = l.store();
            i = supporting(model, row);
        }
    }
}

/// `B ← M⁻¹ B` for the factorised `m`; `b` has `nv` rows of `width` entries.
#[inline(always)]
pub(super) fn solve<T: Scalar, F: Over<T>>(model: &Model<T::Param>, m: &[T], b: &mut [T], width: usize) {
    let nv = model.nv;
    // B ← D⁻¹ L⁻ᵀ B, tips to base
    for k in (0..nv).rev() {
        let (above, rest) = b.split_at_mut(k * width);
        let row_k = &mut rest[..width];
        let mut i = supporting(model, k);
        while let Some(row) = i {
            subtract::<T, F>(&mut above[row * width..][..width], F::load(m[k * nv + row]), row_k);
            i = supporting(model, row);
        }
        let d_inv = F::load(m[k * nv + k]);
        for x in row_k {
            *x = (F::load(*x) * d_inv).store();
        }
    }
    // B ← L⁻¹ B, base to tips
    for k in 0..nv {
        let (above, rest) = b.split_at_mut(k * width);
        let row_k = &mut rest[..width];
        let mut i = supporting(model, k);
        while let Some(row) = i {
            subtract::<T, F>(row_k, F::load(m[k * nv + row]), &above[row * width..][..width]);
            i = supporting(model, row);
        }
    }
}

/// `b ← D^-½ L⁻ᵀ b` for the factorised `m`, so that its square is `bᵀ M⁻¹ b`.
pub(super) fn half_solve<T: Scalar>(model: &Model<T::Param>, m: &[T], b: &mut [T]) {
    let nv = model.nv;
    for k in (0..nv).rev() {
        let mut i = supporting(model, k);
        while let Some(row) = i {
            b[row] = (-m[k * nv + row]).mul_add(b[k], b[row]);
            i = supporting(model, row);
        }
        b[k] = b[k] * m[k * nv + k].sqrt();
    }
}

/// `a ← a − s b`.
#[inline(always)]
pub(super) fn subtract<T: Scalar, F: Over<T>>(a: &mut [T], s: F, b: &[T]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a = (-s).mul_add(F::load(*b), F::load(*a)).store();
    }
}

/// The velocity coordinate next to `k` on the way to the base.
#[inline(always)]
pub(super) fn supporting<P: Scalar>(model: &Model<P>, k: usize) -> Option<usize> {
    let extra = if model.floating { 5 } else { 0 };
    if k <= extra {
        return k.checked_sub(1).filter(|_| model.floating);
    }
    let body = model.bodies.get(k - extra)?;
    let parent = body.parent()?;
    // Along a chain, the processor need not wait for the record of the parent.
    if body.placement.branch.is_none() {
        return Some(k - 1);
    }
    let base = model.bodies.get(parent)?;
    Some(base.v_index() + base.joint.nv() - 1)
}
