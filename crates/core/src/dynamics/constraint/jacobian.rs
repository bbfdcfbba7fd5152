//! Constraints by themselves: how far they are from being kept, and their Jacobian.

use super::anchor::Held;
use super::frames::{Root, SupportScratch, bodies, joint_of, mark, outward};
use super::spec::{Constraint, ConstraintError, Hold, check, constraint_rows};
use crate::Scalar;
use crate::dynamics::check_scratch;
use crate::dynamics::tree::{Tree, turns};
use crate::model::{Body, Model, SizeError};
use crate::spatial::Force;

/// What [`constraint_motion`] writes, for `m` multipliers; a slice may be empty where it is not wanted.
#[derive(Debug)]
pub struct ConstraintMotion<'a, T> {
    /// `Φ(q)`, `m` entries [m or rad].
    pub error: &'a mut [T],
    /// `Φ̇ = J q̇`, `m` entries [m/s or rad/s].
    pub velocity: &'a mut [T],
    /// `J = ∂Φ/∂q`, `m × nv` by rows, of a floating root by its twist.
    pub jacobian: &'a mut [T],
}

/// Position and velocity errors of constraints, and their Jacobian. `scratch` has one record per body.
///
/// Of a turn the error is that to first order: it is the integral of `J q̇` only where it is small.
///
/// # Errors
/// A slice that does not fit, or a constraint that does not fit the model; nothing is written then.
pub fn constraint_motion<T: Scalar>(
    model: &Model<T::Param>,
    q: &[T],
    qd: &[T],
    constraints: &[Constraint<T>],
    scratch: &mut [SupportScratch<T>],
    out: ConstraintMotion<T>,
) -> Result<(), ConstraintError> {
    let (m, nv) = (constraint_rows(constraints), model.nv);
    check(model, constraints)?;
    check_scratch(model, scratch)?;
    SizeError::check("q", q.len(), model.nq)?;
    SizeError::check("qd", qd.len(), nv)?;
    for (name, given, needed) in [("error", out.error.len(), m), ("velocity", out.velocity.len(), m)] {
        if given != 0 {
            SizeError::check(name, given, needed)?;
        }
    }
    if !out.jacobian.is_empty() {
        SizeError::check("jacobian", out.jacobian.len(), m * nv)?;
    }
    let tree = Tree::of(model);
    let root = Root::<T>::of(&tree, q, qd);
    let (_, scratch) = tree.bodies_mut("scratch", scratch)?;
    let (joint_q, joint_qd) = (tree.positions(q)?, tree.velocities("qd", qd)?);
    turns::<T, T, _>(tree.joints, joint_q, scratch, Body::angle, |s, theta| s.theta = theta);
    mark(&tree, constraints, scratch);
    outward(&tree, &root, joint_q, joint_qd, scratch);

    let lead = nv - tree.joints.len();
    let mut row = 0;
    out.jacobian.fill(T::zero());
    for constraint in constraints {
        let held = Held::of(constraint, &tree, &root, joint_q, joint_qd, scratch);
        for k in (0..6).filter(|k| constraint.holds(*k)) {
            if let Some(error) = out.error.get_mut(row) {
                *error = held.error[k];
            }
            if let Some(velocity) = out.velocity.get_mut(row) {
                *velocity = held.velocity[k];
            }
            if let Some(entries) = out.jacobian.get_mut(row * nv..(row + 1) * nv) {
                let sides = bodies(constraint);
                add_row(entries, lead, &tree, constraint, sides[0], T::one(), held.wrenches[k], scratch);
                add_row(entries, lead, &tree, constraint, sides[1], -T::one(), held.wrenches[k], scratch);
            }
            row += 1;
        }
    }
    Ok(())
}

/// Adds what the joints that carry a body contribute: `S·f`.
#[expect(clippy::too_many_arguments)]
fn add_row<T: Scalar>(
    row: &mut [T],
    lead: usize,
    tree: &Tree<'_, T::Param>,
    constraint: &Constraint<T>,
    body: Option<usize>,
    sign: T,
    wrench: Force<T>,
    scratch: &[SupportScratch<T>],
) {
    let Some(body) = body else { return };
    if let Hold::Joints { joint, ratio, .. } = &constraint.hold {
        let value = if *joint == body { T::one() } else { -*ratio };
        if let Some(entry) = joint_of(tree, Some(body)).and_then(|i| row.get_mut(lead + i)) {
            *entry += value;
        }
        return;
    }
    let mut at = joint_of(tree, Some(body));
    while let Some(i) = at {
        if let (Some(s), Some(entry)) = (scratch.get(i), row.get_mut(lead + i)) {
            *entry += sign * s.axis.dot(wrench);
        }
        at = tree.joint(tree.joints.get(i).and_then(|body| body.parent));
    }
    for (entry, f) in row.iter_mut().zip(wrench.to_array()).take(lead) {
        *entry += sign * f;
    }
}
