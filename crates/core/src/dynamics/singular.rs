//! Singular values of a few rows, by rotations that make them orthogonal (Hestenes 1958): as many sweeps for every matrix.

use crate::Scalar;

/// How far a robot is from a pose in which the frame cannot move in all directions.
#[derive(Clone, Copy, Debug)]
pub struct SingularValues<T> {
    /// The smallest singular value of `J` in the task's directions [m/rad and –, mixed as the rows are].
    pub smallest: T,
    /// The largest.
    pub largest: T,
    /// The smallest singular value of `T` in `ω = T φ̇`: 0 where the angles do not describe rotation, 1 for the geometric rates.
    pub representation: T,
}

/// At most six rows of a matrix.
pub(super) struct Rows<'a, T> {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) entries: &'a mut [T],
}

/// Six rows are orthogonal to rounding after five; convergence is quadratic.
const SWEEPS: usize = 8;

/// Turns `A` into `U A` with orthogonal rows, whose lengths are the singular values; `turned`, if given, becomes `U turned` and has as many rows
/// and columns as `A` has rows.
pub(super) fn orthogonalise<T: Scalar>(a: &mut Rows<'_, T>, mut turned: Option<&mut [T]>) -> SingularValues<T> {
    let (rows, columns) = (a.rows, a.columns);
    for _ in 0..SWEEPS {
        for p in 0..rows {
            for q in p + 1..rows {
                let product = |i: usize, j: usize| {
                    (0..columns)
                        .fold(T::zero(), |sum, c| a.entries[i * columns + c].mul_add(a.entries[j * columns + c], sum))
                };
                // tan 2φ = 2 p·q / (p·p − q·q)
                let (difference, twice) = (product(p, p) - product(q, q), product(p, q) + product(p, q));
                let (sin, cos) = (T::from_f64(0.5) * twice.atan2(difference)).sin_cos();
                turn(a.entries, columns, (p, q), (sin, cos));
                if let Some(turned) = &mut turned {
                    turn(turned, rows, (p, q), (sin, cos));
                }
            }
        }
    }
    let length = |i: usize| {
        (0..columns)
            .fold(T::zero(), |sum, c| a.entries[i * columns + c].mul_add(a.entries[i * columns + c], sum))
            .sqrt()
    };
    let mut values = SingularValues { smallest: T::zero(), largest: T::zero(), representation: T::one() };
    for i in 0..rows {
        let value = length(i);
        values.largest = value.select_less(values.largest, values.largest, value);
        values.smallest = if i == 0 { value } else { value.select_less(values.smallest, value, values.smallest) };
    }
    values
}

fn turn<T: Scalar>(entries: &mut [T], columns: usize, (p, q): (usize, usize), (sin, cos): (T, T)) {
    for c in 0..columns {
        let (x, y) = (entries[p * columns + c], entries[q * columns + c]);
        entries[p * columns + c] = cos * x + sin * y;
        entries[q * columns + c] = cos * y - sin * x;
    }
}
