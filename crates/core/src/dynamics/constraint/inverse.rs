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
    let (jacobian, rest) = matrix.split_at_mut_checked(rows * nv).unwrap_or_default();
    let (load, rest) = rest.split_at_mut_checked(nv).unwrap_or_default();
    let (solution, rest) = rest.split_at_mut_checked(rows + passive.len()).unwrap_or_default();
    let motion = ConstraintMotion { error: &mut [], velocity: &mut [], jacobian: &mut *jacobian };
    constraint_motion(model, state.q, state.qd, constraints, supports, motion)?;
    torques_of(model, state, accel, ext, scratch, Inverse { tau_j: &mut *out.tau_j, tau: &mut *out.tau })?;

    // A λ − J_p ν = J_a W h_a + V λ*,   J_pᵀ λ = h_p,   A = J_a W J_aᵀ + V;   h the torques without constraints
    let (n, h) = (rows + passive.len(), &*out.tau_j);
    let row = |r: usize| jacobian.get(r * nv..(r + 1) * nv).unwrap_or_default();
    let mut system = System::of(n, rest);
    system.a.fill(T::zero());
    // Every torque beside its weight; passive ones weigh nothing.
    let weighed = |left: &[T], right: &[T]| {
        let mut sum = T::zero();
        for (k, ((a, b), w)) in left.iter().zip(right).zip(torques).enumerate() {
            if !passive.contains(&k) {
                sum += *a * *w * *b;
            }
        }
        sum
    };
    for r in 0..rows {
        for c in 0..rows {
            set(system.a, r * n + c, weighed(row(r), row(c)));
        }
        let cost = at(costs, r);
        set(system.a, r * n + r, weighed(row(r), row(r)) + cost);
        set(system.b, r, weighed(row(r), h) + at(wanted, r) * cost);
        for (p, k) in passive.iter().enumerate() {
            set(system.a, r * n + rows + p, -at(row(r), *k));
            set(system.a, (rows + p) * n + r, at(row(r), *k));
        }
    }
    for (p, k) in passive.iter().enumerate() {
        set(system.b, rows + p, at(h, *k));
    }
    let solved = system.solve::<T>(&[], &regularisation, false, solution);
    multipliers.iter_mut().zip(solution.iter()).for_each(|(to, from)| *to = *from);

    for (k, sum) in load.iter_mut().enumerate() {
        *sum = multipliers.iter().enumerate().fold(at(ext.tau, k), |sum, (r, l)| l.mul_add(at(row(r), k), sum));
    }
    torques_of(model, state, accel, External { tau: load, ..ext }, scratch, out)?;
    Ok(solved)
}

/// [`rnea`], compiled once for its two calls.
#[inline(never)]
fn torques_of<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    accel: Acceleration<T>,
    ext: External<T>,
    scratch: &mut [RneaScratch<T>],
    out: Inverse<T>,
) -> Result<(), SizeError> {
    rnea(model, state, accel, ext, scratch, out)
}

/// Entry `i`, zero beyond the end.
fn at<T: Scalar>(all: &[T], i: usize) -> T {
    all.get(i).map_or(T::zero(), |x| *x)
}

fn set<T>(all: &mut [T], i: usize, x: T) {
    if let Some(entry) = all.get_mut(i) {
        *entry = x;
    }
}
