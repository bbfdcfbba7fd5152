//! Inverse dynamics under constraints: who bears what, where there are more motors than directions to move.

use super::frames::SupportScratch;
use super::jacobian::{ConstraintMotion, constraint_motion};
use super::solve::{Regularisation, Solved, System};
use super::spec::{Constraint, ConstraintError, constraint_rows};
use crate::Scalar;
use crate::dynamics::{Acceleration, External, Inverse, RneaScratch, State, rnea};
use crate::model::{Model, SizeError};

/// How the motors and the constraints share the load: of all torques `τ_J` and multipliers that make the motion, those with the least
/// `Σ w τ_J² + Σ v (λ − λ*)²`.
///
/// Equal `w` and next to no `v` give the torques of least norm; a large `v` with `λ*` a multiplier of choice. A foot is unloaded by leaving its
/// constraint out: the motion is given.
#[derive(Clone, Copy, Debug)]
pub struct TorqueDistribution<'a, T> {
    /// `w`, above zero, `nv` entries; not read at passive velocities.
    pub torques: &'a [T],
    /// Velocities that nothing drives: those of a floating root, those of passive joints. Constraints must bear all of their load.
    pub passive: &'a [usize],
    /// `v`, one per multiplier. Zero is allowed where the torques alone determine the multipliers.
    pub multipliers: &'a [T],
    /// `λ*`, one per multiplier, or empty for zeros.
    pub wanted: &'a [T],
}

/// Entries of the matrix that [`constrained_inverse_dynamics`] works in, for so many passive velocities.
pub fn constrained_inverse_len<P: Scalar, T: Scalar>(
    model: &Model<P>,
    constraints: &[Constraint<T>],
    passive: usize,
) -> usize {
    let rows = constraint_rows(constraints);
    let all = rows + passive;
    (rows + 1) * model.nv + 2 * (all * all + all) + all
}

/// Torques of all transmissions and motors, and multipliers, that make a motion which the constraints allow. `scratch` and `supports` have one record
/// per body.
///
/// Entries of `out` at passive velocities are what no constraint bears there, zero to rounding unless the motion is impossible.
///
/// # Errors
/// A slice that does not fit, a passive velocity that the model has not, or a constraint that does not fit the model; nothing is written then.
#[expect(clippy::too_many_arguments)]
pub fn constrained_inverse_dynamics<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    accel: Acceleration<T>,
    ext: External<T>,
    constraints: &[Constraint<T>],
    distribution: TorqueDistribution<T>,
    regularisation: Regularisation<T>,
    scratch: &mut [RneaScratch<T>],
    supports: &mut [SupportScratch<T>],
    matrix: &mut [T],
    out: Inverse<T>,
    multipliers: &mut [T],
) -> Result<Solved<T>, ConstraintError> {
    let (nv, rows) = (model.nv, constraint_rows(constraints));
    let TorqueDistribution { torques, passive, multipliers: costs, wanted } = distribution;
    SizeError::check("matrix", matrix.len(), constrained_inverse_len(model, constraints, passive.len()))?;
    SizeError::check("torque weights", torques.len(), nv)?;
    SizeError::check("multiplier weights", costs.len(), rows)?;
    SizeError::check("multipliers", multipliers.len(), rows)?;
    if !wanted.is_empty() {
        SizeError::check("wanted multipliers", wanted.len(), rows)?;
    }
    if let Some(given) = passive.iter().copied().find(|k| *k >= nv) {
        return Err(SizeError { argument: "passive velocity", expected: nv, given }.into());
    }
    let (jacobian, rest) = matrix.split_at_mut(rows * nv);
    let (load, rest) = rest.split_at_mut(nv);
    let (solution, rest) = rest.split_at_mut(rows + passive.len());
    let motion = ConstraintMotion { error: &mut [], velocity: &mut [], jacobian: &mut *jacobian };
    constraint_motion(model, state.q, state.qd, constraints, supports, motion)?;
    rnea(model, state, accel, ext, scratch, Inverse { tau_j: &mut *out.tau_j, tau: &mut *out.tau })?;

    // A λ − J_p ν = J_a W h_a + V λ*,   J_pᵀ λ = h_p,   A = J_a W J_aᵀ + V;   h the torques without constraints
    let (n, h) = (rows + passive.len(), &*out.tau_j);
    let entry = |row: usize, k: usize| jacobian[row * nv + k];
    let driven = |k: &usize| !passive.contains(k);
    let mut system = System::of(n, rest);
    system.a.fill(T::zero());
    for r in 0..rows {
        for c in 0..rows {
            let sum = (0..nv).filter(driven).fold(T::zero(), |sum, k| sum + entry(r, k) * torques[k] * entry(c, k));
            system.a[r * n + c] = if r == c { sum + costs[r] } else { sum };
        }
        let sum = (0..nv).filter(driven).fold(T::zero(), |sum, k| sum + entry(r, k) * torques[k] * h[k]);
        system.b[r] = sum + wanted.get(r).map_or(T::zero(), |wanted| *wanted * costs[r]);
        for (p, k) in passive.iter().enumerate() {
            system.a[r * n + rows + p] = -entry(r, *k);
            system.a[(rows + p) * n + r] = entry(r, *k);
        }
    }
    for (p, k) in passive.iter().enumerate() {
        system.b[rows + p] = h[*k];
    }
    let solved = system.solve::<T>(&[] as &[Constraint<T>], &regularisation, false, solution);
    multipliers.copy_from_slice(&solution[..rows]);

    for (k, sum) in load.iter_mut().enumerate() {
        let given = ext.tau.get(k).copied().unwrap_or(T::zero());
        *sum = multipliers.iter().enumerate().fold(given, |sum, (r, l)| l.mul_add(entry(r, k), sum));
    }
    rnea(model, state, accel, External { tau: load, ..ext }, scratch, out)?;
    Ok(solved)
}
