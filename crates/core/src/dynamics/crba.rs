//! Inertia matrices: the composite-rigid-body algorithm (RBDA table 6.2) with rotors.
//!
//! In the matrix form of PHYSICS §2 the complete model's inertia is `[[M_l, S], [Sᵀ, B]]`. [`crba`] gives `M_l`, with rigidly
//! geared rotors fully in it; [`coupling`] gives `S`, whose column `j` is `N_j J_j n_jᵀ` times the angular Jacobian of the
//! body that carries rotor `j`; [`reflected_inertia`] gives the diagonal of `B`.
//!
//! Cost O(n·depth). No allocation, no panic, no branch on values.

use super::check_scratch;
use super::tree::{Support, Tree, turns};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Drive, JointKind, Model, SizeError};
use crate::spatial::{Force, Motion, SpatialInertia, SymMat3, Turn, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct CrbaScratch<T> {
    /// Sine and cosine of the joint's angle.
    theta: Turn<T>,
    /// `Iᶜ`.
    composite: SpatialInertia<T>,
}

impl<T: Scalar> CrbaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self { theta: Turn::none(), composite: SpatialInertia::zero() }
    }
}

impl<T: Scalar> Default for CrbaScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// `M_l(q)`: inertia matrix of the link side, `nv × nv` by rows [kg m², kg m or kg].
///
/// Elastic rotors are in it as they are at rest relative to their carriers; rigidly geared ones with everything that turning
/// with the joint entails, so that in the rigid models this is the whole robot's matrix.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn crba<T: Scalar>(
    model: &Model<T::Param>,
    q: &[T],
    scratch: &mut [CrbaScratch<T>],
    m: &mut [T],
) -> Result<(), SizeError> {
    SizeError::check("q", q.len(), model.nq)?;
    check_scratch(model, scratch)?;
    SizeError::check("m", m.len(), model.nv * model.nv)?;
    T::dispatch(Crba { model, q, scratch, m });
    Ok(())
}

struct Crba<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    q: &'a [T],
    scratch: &'a mut [CrbaScratch<T>],
    m: &'a mut [T],
}

impl<T: Scalar> Kernel<T> for Crba<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn run<F: Over<T>>(self) {
        let Self { model, q, scratch, m } = self;
        let (tree, nv) = (Tree::of(model), model.nv);
        let Some((_, scratch)) = tree.split_bodies_mut(scratch) else { return };
        let (joints, n) = (tree.joints, tree.joints.len());
        let Some(q) = tree.positions(q) else { return };
        let lead = nv - n;
        m.fill(T::zero());

        // Pass 1: each body's own inertia with the elastic rotors it carries put back in.
        turns::<T, F, _>(joints, q, scratch, |s, theta| s.theta = theta);
        let mut base = tree.root.map_or(SpatialInertia::zero(), |root| root.inertia.map(F::from_param));
        for i in 0..n {
            scratch[i].composite = joints[i].inertia.map(F::from_param).map(F::store);
            if let Some(Drive { rotor, elastic: Some(_) }) = &joints[i].drive
                && rotor.mount.is_some()
            {
                let own = SymMat3::outer(rotor.axis_in()).scale(F::from_param(rotor.inertia));
                match tree.support(rotor.mount, i).joint(i).and_then(|b| scratch.get_mut(b)) {
                    Some(s) => s.composite.rotational = (s.composite.rotational.map(F::load) + own).map(F::store),
                    None => base.rotational += own,
                }
            }
        }

        // Pass 2, tips to base: F = Iᶜ S, the column above the diagonal, Iᶜ_p += Xᵀ Iᶜ X
        for i in (0..n).rev() {
            let s = &scratch[i];
            let composite: SpatialInertia<F> = s.composite.map(F::load);
            let across = |j: usize| {
                let (joint, s, q) = (joints.get(j)?, scratch.get(j)?, q.get(j)?);
                Some(joint.across(s.theta.map(F::load), F::load(*q)))
            };
            let mut write = |row: usize, entry: F| {
                for at in [row * nv + lead + i, (lead + i) * nv + row] {
                    if let Some(m) = m.get_mut(at) {
                        *m = entry.store();
                    }
                }
            };
            let mut f = unit_momentum(joints[i].joint, composite);
            write(lead + i, joints[i].along_joint(f) + joints[i].rigid_reflected_inertia());
            // F ← Xᵀ F (+ N J n at the carrier),  M_ji = S_jᵀ F
            let mut at = Some(i);
            while let Some(j) = at {
                let Some((x, body)) = across(j).zip(joints.get(j)) else { break };
                if tree.root.is_none() && body.parent.is_none() {
                    break;
                }
                f = x.inv_force(f);
                if body.parent == joints[i].carrier() {
                    f += joints[i].rigid_coupling();
                }
                at = tree.support(body.parent, j).joint(j);
                match at.and_then(|p| joints.get(p).map(|joint| (p, joint))) {
                    Some((p, joint)) => write(lead + p, joint.along_joint(f)),
                    None => f.to_array().into_iter().enumerate().for_each(|(row, f)| write(row, f)),
                }
            }

            let support = tree.support(joints[i].parent, i);
            if tree.root.is_none() && matches!(support, Support::Base) {
                continue;
            }
            let Some(x) = across(i) else { continue };
            let on_parent = x.inv_inertia(composite);
            match support.joint(i).and_then(|b| scratch.get_mut(b)) {
                Some(parent) => parent.composite = (parent.composite.map(F::load) + on_parent).map(F::store),
                None => base = base + on_parent,
            }
        }

        if tree.root.is_some() {
            for column in 0..6 {
                let mut unit = [F::zero(); 6];
                unit[column] = F::one();
                for (row, entry) in base.momentum(Motion::from(unit)).to_array().into_iter().enumerate() {
                    if let Some(m) = m.get_mut(row * nv + column) {
                        *m = entry.store();
                    }
                }
            }
        }
    }
}

/// `I S` for a joint along z.
#[inline(always)]
fn unit_momentum<F: Scalar>(joint: JointKind, i: SpatialInertia<F>) -> Force<F> {
    let (o, h) = (F::zero(), i.first_moment);
    match joint {
        JointKind::Prismatic => Force { ang: Vec3::new(h.y, -h.x, o), lin: Vec3::new(o, o, i.mass) },
        _ => Force { ang: Vec3::new(i.rotational.xz, i.rotational.yz, i.rotational.zz), lin: Vec3::new(-h.y, h.x, o) },
    }
}

/// `S(q)`: inertial coupling between links (rows) and reflected motor coordinates (columns), `nv × nv` by rows [kg m²].
/// Columns of joints without an elastic transmission are zero.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn coupling<T: Scalar>(
    model: &Model<T::Param>,
    q: &[T],
    scratch: &mut [CrbaScratch<T>],
    s: &mut [T],
) -> Result<(), SizeError> {
    let nv = model.nv;
    SizeError::check("q", q.len(), model.nq)?;
    check_scratch(model, scratch)?;
    SizeError::check("s", s.len(), nv * nv)?;
    s.fill(T::zero());
    for (body, scratch) in model.bodies.iter().zip(scratch.iter_mut()) {
        let (sin, cos) = body.angle(q[body.q_index()]).sin_cos();
        scratch.theta = Turn { sin, cos };
    }
    for body in model.bodies {
        let Some(drive) = body.drive.as_ref().filter(|d| d.elastic.is_some()) else { continue };
        // The couple N J n at the carrier, carried on to the base.
        let (column, mut f) = (body.v_index(), Force::couple(drive.rotor.coupling()));
        let mut at = drive.rotor.mount();
        while let Some(b) = at {
            let on = &model.bodies[b];
            if on.joint == JointKind::Floating {
                for (row, entry) in f.to_array().into_iter().enumerate() {
                    s[row * nv + column] = entry;
                }
                break;
            }
            s[on.v_index() * nv + column] = on.along_joint(f);
            f = on.across(scratch[b].theta, q[on.q_index()]).inv_force(f);
            at = on.parent();
        }
    }
    Ok(())
}

/// Diagonal of `B`: reflected rotor inertias of the joints with an elastic transmission, `nv` entries, zero elsewhere
/// [kg m² or kg].
///
/// # Errors
/// [`SizeError`] if the slice does not fit the model; nothing is written then.
pub fn reflected_inertia<P: Scalar>(model: &Model<P>, b: &mut [P]) -> Result<(), SizeError> {
    SizeError::check("b", b.len(), model.nv)?;
    b.fill(P::zero());
    for body in model.bodies {
        if let Some(drive) = body.drive.as_ref().filter(|d| d.elastic.is_some()) {
            b[body.v_index()] = drive.rotor.reflected_inertia;
        }
    }
    Ok(())
}
