//! Inertia matrices: the composite-rigid-body algorithm (RBDA table 6.2) with rotors.
//!
//! In the matrix form of PHYSICS §2 the complete model's inertia is `[[M_l, S], [Sᵀ, B]]`. [`crba`] gives `M_l`, with rigidly
//! geared rotors fully in it; [`coupling`] gives `S`, whose column `j` is `N_j J_j n_jᵀ` times the angular Jacobian of the
//! body that carries rotor `j`; [`reflected_inertia`] gives the diagonal of `B`.
//!
//! Cost O(n·depth). No allocation, no panic, no branch on values.

use super::check_scratch;
use crate::Scalar;
use crate::model::{JointKind, Model, SizeError};
use crate::spatial::{Force, Motion, SpatialInertia, SymMat3, Transform, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct CrbaScratch<T> {
    x: Transform<T>,
    composite: SpatialInertia<T>,
}

impl<T: Scalar> CrbaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self { x: Transform::identity(), composite: SpatialInertia::zero() }
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
    model: &Model<T>,
    q: &[T],
    scratch: &mut [CrbaScratch<T>],
    m: &mut [T],
) -> Result<(), SizeError> {
    let nv = model.nv;
    SizeError::check("q", q.len(), model.nq)?;
    check_scratch(model, scratch)?;
    SizeError::check("m", m.len(), nv * nv)?;
    m.fill(T::zero());

    // Pass 1: transforms, and each body's own inertia with the elastic rotors it carries put back in.
    for (body, s) in model.bodies.iter().zip(scratch.iter_mut()) {
        *s = CrbaScratch { x: body.transform(q), composite: body.inertia };
    }
    for drive in model.bodies.iter().filter_map(|b| b.drive.as_ref()).filter(|d| d.elastic.is_some()) {
        if let Some(mount) = drive.rotor.mount() {
            scratch[mount].composite.rotational += SymMat3::outer(drive.rotor.axis).scale(drive.rotor.inertia);
        }
    }

    for (i, body) in model.bodies.iter().enumerate().rev() {
        // Pass 2, tips to base: Iᶜ_p += Xᵀ Iᶜ X
        let CrbaScratch { x, composite } = scratch[i];
        if let Some(p) = body.parent() {
            scratch[p].composite = scratch[p].composite + composite.seen_from_parent(x);
        }

        let k = body.v_index();
        if body.joint == JointKind::Floating {
            for row in 0..6 {
                let mut unit = [T::zero(); 6];
                unit[row] = T::one();
                let column = composite.momentum(Motion::from(unit)).to_array();
                m[(k + row) * nv + k..(k + row) * nv + k + 6].copy_from_slice(&column);
            }
            continue;
        }
        // F = Iᶜ S
        let f = match body.joint {
            JointKind::Prismatic => composite.momentum(Motion { ang: Vec3::zero(), lin: Vec3::z_axis() }),
            _ => composite.momentum(Motion { ang: Vec3::z_axis(), lin: Vec3::zero() }),
        };
        write_branch(model, i, f, |b| scratch[b].x, m);
    }
    Ok(())
}

/// `S(q)`: inertial coupling between links (rows) and reflected motor coordinates (columns), `nv × nv` by rows [kg m²].
/// Columns of joints without an elastic transmission are zero.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn coupling<T: Scalar>(
    model: &Model<T>,
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
        scratch.x = body.transform(q);
    }
    for body in model.bodies {
        let Some(drive) = body.drive.as_ref().filter(|d| d.elastic.is_some()) else { continue };
        let r = &drive.rotor;
        // The couple N J n at the carrier, carried on to the base.
        let mut f = Force::couple(r.axis.scale(r.gear_ratio * r.inertia));
        let mut at = r.mount();
        while let Some(b) = at {
            write_rows(model, b, body.v_index(), f, s);
            f = scratch[b].x.inv_force(f);
            at = model.bodies[b].parent();
        }
    }
    Ok(())
}

/// Diagonal of `B`: reflected rotor inertias of the joints with an elastic transmission, `nv` entries, zero elsewhere
/// [kg m² or kg].
///
/// # Errors
/// [`SizeError`] if the slice does not fit the model; nothing is written then.
pub fn reflected_inertia<T: Scalar>(model: &Model<T>, b: &mut [T]) -> Result<(), SizeError> {
    SizeError::check("b", b.len(), model.nv)?;
    b.fill(T::zero());
    for body in model.bodies {
        if let Some(drive) = body.drive.as_ref().filter(|d| d.elastic.is_some()) {
            b[body.v_index()] = drive.rotor.reflected_inertia;
        }
    }
    Ok(())
}

/// Column of joint `i` and its mirror image: `M_ii = Sᵀ F (+ B)`, and on the way to the base `F ← Xᵀ F (+ N J n at the
/// carrier)`, `M_ji = S_jᵀ F`. `x(b)` is the transform from the parent of body `b`.
pub(super) fn write_branch<T: Scalar>(
    model: &Model<T>,
    i: usize,
    mut f: Force<T>,
    x: impl Fn(usize) -> Transform<T>,
    m: &mut [T],
) {
    let body = &model.bodies[i];
    let k = body.v_index();
    m[k * model.nv + k] = body.along_joint(f) + body.rigid_reflected_inertia();
    let carrier = body.drive.as_ref().and_then(|d| d.rotor.mount());
    let mut at = i;
    while let Some(p) = model.bodies[at].parent() {
        f = x(at).inv_force(f);
        if carrier == Some(p) {
            f += body.rigid_coupling();
        }
        write_symmetric(model, p, k, f, m);
        at = p;
    }
}

/// `Sᵀ_b f` into the rows of body `b`, column `k`.
#[inline]
fn write_rows<T: Scalar>(model: &Model<T>, b: usize, k: usize, f: Force<T>, m: &mut [T]) {
    let (body, nv) = (&model.bodies[b], model.nv);
    let j = body.v_index();
    if body.joint == JointKind::Floating {
        for (row, entry) in f.to_array().into_iter().enumerate() {
            m[(j + row) * nv + k] = entry;
        }
    } else {
        m[j * nv + k] = body.along_joint(f);
    }
}

/// The same, and into the mirrored entries.
#[inline]
pub(super) fn write_symmetric<T: Scalar>(model: &Model<T>, b: usize, k: usize, f: Force<T>, m: &mut [T]) {
    write_rows(model, b, k, f, m);
    let (body, nv) = (&model.bodies[b], model.nv);
    let j = body.v_index();
    for row in j..j + body.joint.nv() {
        m[k * nv + row] = m[row * nv + k];
    }
}
