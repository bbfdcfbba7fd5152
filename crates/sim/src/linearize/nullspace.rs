//! States that a linear model leaves where they are, and how many of its eigenvalues they account for.

use nalgebra::DMatrix;

/// Singular values below this share of the largest count as zero: above the rounding of the derivatives, below the stiffness of
/// gravity against that of gears.
const RANK: f64 = 1e-11;
/// Cosines below this between states at rest and the constraints that keep them there.
const DEFECT: f64 = 1e-8;

/// The null space of a matrix.
pub(super) struct Nullspace {
    /// A basis, in the form with as many zeros as elimination can make; each vector has a largest entry of 1.
    pub(super) basis: Vec<Vec<f64>>,
    /// How often zero is an eigenvalue.
    pub(super) multiplicity: usize,
}

impl Nullspace {
    /// Of a square matrix, already balanced.
    pub(super) fn of(a: &DMatrix<f64>) -> Self {
        let n = a.nrows();
        let svd = a.clone().svd(true, true);
        let (Some(u), Some(v_t)) = (&svd.u, &svd.v_t) else { return Self { basis: Vec::new(), multiplicity: 0 } };
        let small = RANK * svd.singular_values.max();
        let zeros: Vec<usize> = (0..n).filter(|i| svd.singular_values[*i] <= small).collect();
        let r = zeros.len();
        if r == 0 {
            return Self { basis: Vec::new(), multiplicity: 0 };
        }
        // A Jordan block of two has a left null vector across from the null space: a motion without friction.
        let across = DMatrix::from_fn(r, r, |i, j| u.column(zeros[i]).dot(&v_t.row(zeros[j]).transpose()));
        let coupled = across.singular_values().iter().filter(|s| **s > DEFECT).count();
        let rows = DMatrix::from_fn(r, n, |i, j| v_t[(zeros[i], j)]);
        Self { basis: reduced(rows), multiplicity: r + (r - coupled) }
    }
}

/// Gauss-Jordan elimination with the largest pivot of each row.
fn reduced(mut rows: DMatrix<f64>) -> Vec<Vec<f64>> {
    for i in 0..rows.nrows() {
        let pivot = rows.row(i).iamax_full().1;
        let value = rows[(i, pivot)];
        if value == 0.0 {
            continue;
        }
        rows.row_mut(i).unscale_mut(value);
        for other in (0..rows.nrows()).filter(|o| *o != i) {
            let share = rows[(other, pivot)];
            let row = rows.row(i).into_owned();
            let mut target = rows.row_mut(other);
            target -= row * share;
        }
    }
    rows.row_iter().map(|row| row.iter().copied().collect()).collect()
}
