//! States that a linear model leaves where they are, and what is left of the model without them.

use nalgebra::DMatrix;

/// Singular values below this share of the largest count as zero: above the rounding of the derivatives, below the stiffness of
/// gravity against that of gears.
const RANK: f64 = 1e-13;

/// A square matrix taken apart: its null space, and a smaller matrix with all its other eigenvalues.
pub(super) struct Nullspace {
    /// A basis, in the form with as many zeros as elimination can make; each vector has a largest entry of 1.
    pub(super) basis: Vec<Vec<f64>>,
    /// A matrix with the eigenvalues that are not zero.
    pub(super) rest: DMatrix<f64>,
}

impl Nullspace {
    /// Of a square matrix. To balance it first would raise rounding to the size of small stiffnesses.
    ///
    /// Without friction a robot at rest moves on once it is pushed: zero is then an eigenvalue more often than there are states at
    /// rest, and rounding would scatter it. So null spaces are split off one after the other (Kublanovskaya's staircase, Golub and
    /// Wilkinson, SIAM Review 18, 1976): with `V` orthogonal to the null space, `Vᵀ A V` has the other eigenvalues.
    pub(super) fn of(a: &DMatrix<f64>) -> Self {
        let mut rest = a.clone();
        let mut basis = None;
        let size = a.norm();
        while rest.nrows() > 0 {
            let svd = rest.clone().svd(false, true);
            let Some(v_t) = &svd.v_t else { break };
            let (still, moving): (Vec<usize>, Vec<usize>) =
                (0..rest.nrows()).partition(|i| svd.singular_values[*i] <= RANK * size);
            basis.get_or_insert_with(|| reduced(v_t.select_rows(&still)));
            if still.is_empty() {
                break;
            }
            let others = v_t.select_rows(&moving);
            rest = &others * rest * others.transpose();
        }
        Self { basis: basis.unwrap_or_default(), rest }
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
