//! Forward dynamics by the inertia matrix, for robots whose rigidly geared rotors sit on a body other than their joint's parent.
//!
//! Such a rotor couples its joint to bodies that are not its neighbours, so it cannot be eliminated link by link. `M_ij` still
//! vanishes unless one of the joints supports the other, because a carrier is an ancestor of its joint; so the
//! factorisation `M = Lᵀ L` fills in nothing (RBDA §6.5) and costs O(n·depth²).

use super::aba::{AbaScratch, check, outward_velocities, root_wrench, rotor_accelerations};
use super::crba::{write_branch, write_symmetric};
use super::{External, Forward, State};
use crate::Scalar;
use crate::model::{JointKind, Model, SizeError};
use crate::spatial::{Motion, Vec3};

/// The same as [`super::aba`] for every robot, by another route: `M q̈ = τ − C q̇ − g` with elastic rotors eliminated.
/// `matrix` has `nv * nv` entries of scratch.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn forward_in_joint_space<T: Scalar>(
    model: &Model<T>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: &mut [AbaScratch<T>],
    matrix: &mut [T],
    out: Forward<T>,
) -> Result<(), SizeError> {
    check(model, &state, tau, &ext, scratch, &out)?;
    SizeError::check("matrix", matrix.len(), model.nv * model.nv)?;
    let Forward { qdd, thetadd, tau_j } = out;

    outward_velocities(model, &state, tau, &ext, scratch, tau_j);

    // f = I a + p with q̈ = 0: what the present velocity and gravity ask for.
    let a_world = Motion { ang: Vec3::zero(), lin: -model.gravity };
    for (i, body) in model.bodies.iter().enumerate() {
        let a_p = body.parent().map_or(a_world, |p| scratch[p].a);
        let s = &mut scratch[i];
        s.a = s.x.motion(a_p) + s.c;
        s.pa = s.ia.force(s.a) + s.pa;
    }

    // Right-hand side into `qdd`, inertia matrix with composite inertias in `ia`.
    matrix.fill(T::zero());
    for (i, body) in model.bodies.iter().enumerate().rev() {
        let (s, k) = (scratch[i], body.v_index());
        if let Some(p) = body.parent() {
            scratch[p].pa += s.x.inv_force(s.pa);
            let composite = s.ia.seen_from_parent(&s.x);
            scratch[p].ia += composite;
        }
        if body.joint == JointKind::Floating {
            let load = root_wrench(tau, &ext, k) - s.pa;
            qdd[k..k + 6].copy_from_slice(&load.to_array());
            for row in 0..6 {
                let mut unit = [T::zero(); 6];
                unit[row] = T::one();
                write_symmetric(model, i, k + row, s.ia.force(Motion::from(unit)), matrix);
            }
            continue;
        }
        // A rigid rotor's own row: N J n·α, α what its carrier's velocity alone makes of it.
        let carrier = body.drive.as_ref().and_then(|d| d.rotor.mount());
        let at_carrier = carrier.map_or(Vec3::zero(), |m| scratch[m].a.ang);
        qdd[k] = s.u - body.along_joint(s.pa) - body.rigid_coupling().ang.dot(at_carrier);
        let unit = body.moved_along_joint(Motion::zero(), T::one());
        write_branch(model, i, s.ia.force(unit), |b| scratch[b].x, matrix);
    }

    solve_by_branches(model, matrix, qdd);

    for (i, body) in model.bodies.iter().enumerate() {
        let a_p = body.parent().map_or(a_world, |p| scratch[p].a);
        let k = body.v_index();
        let s = &mut scratch[i];
        let a_rest = s.x.motion(a_p) + s.c;
        if body.joint == JointKind::Floating {
            let free = [qdd[k], qdd[k + 1], qdd[k + 2], qdd[k + 3], qdd[k + 4], qdd[k + 5]];
            s.a = a_rest + Motion::from(free);
            thetadd[k..k + 6].copy_from_slice(&free);
        } else {
            s.a = body.moved_along_joint(a_rest, qdd[k]);
        }
    }
    rotor_accelerations(model, scratch, qdd, thetadd, tau_j);
    Ok(())
}

/// Solves `M x = b` in place by `M = Lᵀ D L` along the branches (RBDA table 6.3): row `k` touches only coordinates that
/// support it.
fn solve_by_branches<T: Scalar>(model: &Model<T>, m: &mut [T], b: &mut [T]) {
    let nv = model.nv;
    // Factorise, and carry b along: b ← L⁻ᵀ b.
    for k in (0..nv).rev() {
        let d_inv = T::one() / m[k * nv + k];
        let mut i = supporting(model, k);
        while let Some(row) = i {
            let l = m[k * nv + row] * d_inv;
            let mut j = Some(row);
            while let Some(column) = j {
                let update = l * m[k * nv + column];
                m[row * nv + column] -= update;
                j = supporting(model, column);
            }
            b[row] -= l * b[k];
            m[k * nv + row] = l;
            i = supporting(model, row);
        }
        b[k] = b[k] * d_inv;
    }
    // b ← L⁻¹ b, base to tips.
    for k in 0..nv {
        let mut i = supporting(model, k);
        while let Some(row) = i {
            b[k] -= m[k * nv + row] * b[row];
            i = supporting(model, row);
        }
    }
}

/// The velocity coordinate next to `k` on the way to the base.
fn supporting<T: Scalar>(model: &Model<T>, k: usize) -> Option<usize> {
    let floating = model.bodies.first().is_some_and(|b| b.joint == JointKind::Floating);
    let extra = if floating { 5 } else { 0 };
    if k <= extra {
        return k.checked_sub(1).filter(|_| floating);
    }
    let parent = model.bodies[k - extra].parent()?;
    let base = &model.bodies[parent];
    Some(base.v_index() + base.joint.nv() - 1)
}
