//! Whether an inertia matrix is one, and what torques do to it.

use super::Motion;
use crate::explicit::ExplicitModel;

/// Cholesky's factor of `[[M_l, S], [Sᵀ, B]]` over coordinates and elastic motors; none if it is not positive definite.
pub(super) struct Factor {
    /// Which equations have a row: coordinates, and motors as `n` and more.
    rows: Vec<usize>,
    lower: Vec<f64>,
}

impl Factor {
    pub(super) fn of(model: &ExplicitModel, at: &Motion) -> Option<Self> {
        let (n, layout, inputs) = (model.nv(), model.layout(), at.inputs(model));
        let motors = (0..n).filter(|i| model.reflected_inertia(*i).is_some()).map(|i| n + i);
        let rows: Vec<usize> = (0..n).chain(motors).collect();
        let entry = |r: usize, c: usize| match (r.checked_sub(n), c.checked_sub(n)) {
            (None, None) => model.mass(r, c).value(layout, &inputs),
            (Some(motor), None) => model.coupling(c, motor).value(layout, &inputs),
            (Some(motor), _) if r == c => model.reflected_inertia(motor).map_or(0.0, |b| b.value(layout, &inputs)),
            _ => 0.0,
        };
        let size = rows.len();
        let mut lower = vec![0.0; size * size];
        for i in 0..size {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| lower[i * size + k] * lower[j * size + k]).sum();
                let whole = entry(rows[i], rows[j]);
                let rest = whole - known;
                if i != j {
                    lower[i * size + j] = rest / lower[j * size + j];
                } else if rest > 4.0 * f64::EPSILON * whole.abs() {
                    lower[i * size + i] = rest.sqrt();
                } else {
                    return None;
                }
            }
        }
        Some(Self { rows, lower })
    }

    /// The accelerations that torques cause, of coordinates, then of motors.
    pub(super) fn solved(&self, torques: &[f64]) -> Vec<f64> {
        let size = self.rows.len();
        let mut x: Vec<f64> = self.rows.iter().map(|r| torques[*r]).collect();
        let l = |i: usize, j: usize| self.lower[i * size + j];
        for i in 0..size {
            let known: f64 = (0..i).map(|k| l(i, k) * x[k]).sum();
            x[i] = (x[i] - known) / l(i, i);
        }
        for i in (0..size).rev() {
            let known: f64 = (i + 1..size).map(|k| l(k, i) * x[k]).sum();
            x[i] = (x[i] - known) / l(i, i);
        }
        let mut all = vec![0.0; torques.len()];
        self.rows.iter().zip(x).for_each(|(r, x)| all[*r] = x);
        all
    }
}
