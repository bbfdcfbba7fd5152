//! Inertia matrices: the composite-rigid-body algorithm (RBDA table 6.2) with rotors.
//!
//! In the matrix form of PHYSICS §2 the complete model's inertia is `[[M_l, S], [Sᵀ, B]]`. [`crba`] gives `M_l`, with rigidly
//! geared rotors fully in it; [`coupling`] gives `S`, whose column `j` is `N_j J_j n_jᵀ` times the angular Jacobian of the
//! body that carries rotor `j`; [`reflected_inertia`] gives the diagonal of `B`.
//!
//! Composite inertias go from body to body, where a joint's own force `Iᶜ S` is one of their columns; that force and `S` are
//! taken to the axes and the origin of the base, the world or a floating root, where an entry of the matrix is one scalar
//! product.
//!
//! Cost O(n·depth). No allocation, no panic, no branch on values.

use super::check_scratch;
use super::tree::{Tree, store_first, turns};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Body, JointKind, Model, SizeError};
use crate::spatial::{Force, Motion, SpatialInertia, Transform, Turn, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct CrbaScratch<T> {
    /// Sine and cosine of the joint's angle.
    theta: Turn<T>,
    /// From the base to the body.
    pose: Transform<T>,
    /// `S`, at the base.
    axis: Motion<T>,
    /// The parent, beside what else the walk to the base reads.
    parent: Option<u16>,
    /// `Iᶜ` so far, of a body that others than the next hang on.
    composite: SpatialInertia<T>,
}

impl<T: Scalar> CrbaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            theta: Turn::none(),
            pose: Transform::identity(),
            axis: Motion::zero(),
            parent: None,
            composite: SpatialInertia::zero(),
        }
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
    SizeError::check("m", m.len(), model.nv * model.nv)?;
    T::dispatch(Crba { model, q, scratch, m })
}

struct Crba<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    q: &'a [T],
    scratch: &'a mut [CrbaScratch<T>],
    m: &'a mut [T],
}

impl<T: Scalar> Kernel<T> for Crba<'_, '_, T> {
    type Output = Result<(), SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<(), SizeError> {
        if self.model.revolute { self.passes::<F, true>() } else { self.passes::<F, false>() }
    }
}

impl<T: Scalar> Crba<'_, '_, T> {
    /// `REVOLUTE` says that all joints are.
    #[inline(always)]
    fn passes<F: Over<T>, const REVOLUTE: bool>(self) -> Result<(), SizeError> {
        let Self { model, q, scratch, m } = self;
        let (tree, nv) = (Tree::of(model), model.nv);
        let (_, scratch) = tree.bodies_mut("scratch", scratch)?;
        let (joints, n) = (tree.joints, tree.joints.len());
        let kind = |body: &Body<T::Param>| if REVOLUTE { JointKind::Revolute } else { body.joint };
        let q = tree.positions(q)?;
        let lead = nv - n;
        m.fill(T::zero());

        turns::<T, F, _>(joints, q, scratch, |body, q| body.angle_as(kind(body), q), |s, theta| s.theta = theta);
        let mut base = tree.root.map_or(SpatialInertia::zero(), |root| root.inertia_with_rotors());

        // Pass 1, base to tips: X and S at the base.
        let pose_at = |b: Option<u16>, scratch: &[CrbaScratch<T>]| {
            tree.joint(b).and_then(|b| scratch.get(b)).map_or(Transform::identity(), |s| s.pose.map(F::load))
        };
        let mut previous = Transform::identity();
        for i in 0..n {
            let body = &joints[i];
            let parent = match body.branch() {
                None => previous,
                Some(branch) => branch.after(pose_at(body.parent, scratch)),
            };
            let pose = body.across_as(kind(body), scratch[i].theta.map(F::load), F::load(q[i])).after(parent);
            let z = pose.rot.rows[2];
            let axis = match kind(body) {
                JointKind::Prismatic => Motion { ang: Vec3::zero(), lin: z },
                _ => Motion { ang: z, lin: pose.pos.cross(z) },
            };
            let s = &mut scratch[i];
            s.pose = pose.map(F::store);
            s.axis = axis.map(F::store);
            s.parent = body.parent;
            if body.shared {
                s.composite = SpatialInertia::zero();
            }
            previous = pose;
        }

        // Pass 2, tips to base: Iᶜ_p += Xᵀ Iᶜ X,   F = Iᶜ S,   M_ji = S_jᵀ F for the joints j that support i
        let mut carried = SpatialInertia::<F>::zero();
        for i in (0..n).rev() {
            let body = &joints[i];
            let mut composite = body.inertia_with_rotors() + carried;
            if body.shared {
                composite = composite + scratch[i].composite.map(F::load);
            }
            carried = SpatialInertia::zero();
            if body.parent.is_some() {
                let x = body.across_as(kind(body), scratch[i].theta.map(F::load), F::load(q[i]));
                carried = x.inv_inertia(composite);
                if let Some(branch) = body.branch() {
                    let at_parent = branch.inv_inertia(carried);
                    carried = SpatialInertia::zero();
                    match tree.joint(body.parent).and_then(|p| scratch.get_mut(p)) {
                        Some(parent) => parent.composite = (parent.composite.map(F::load) + at_parent).map(F::store),
                        None => base = base + at_parent,
                    }
                }
            }

            let own = kind(body).column_of_rigid(&composite);
            let row = m.get_mut((lead + i) * nv..).and_then(|m| m.split_at_mut_checked(lead));
            let Some((to_root, row)) = row else { break };
            if let Some(entry) = row.get_mut(i) {
                *entry = (kind(body).along(own) + body.rigid_reflected_inertia()).store();
            }

            let mut f = scratch[i].pose.map(F::load).inv_force(own);
            let rigid = body.rigid_rotor();
            let mut support = body.parent;
            while support.is_some() {
                // A rigidly geared rotor leans on its carrier: F += [N J n; 0]
                if let Some(rotor) = rigid.filter(|rotor| rotor.mount == support) {
                    f.ang += pose_at(support, scratch).rot.transpose_mul(rotor.coupling());
                }
                let Some(j) = tree.joint(support) else { break };
                let (Some(s), Some(entry)) = (scratch.get(j), row.get_mut(j)) else { break };
                *entry = s.axis.map(F::load).dot(f).store();
                support = s.parent;
            }
            if support.is_some() {
                store_first(to_root, f.to_array());
            }
        }

        if tree.root.is_some() {
            for column in 0..6 {
                let mut unit = [F::zero(); 6];
                unit[column] = F::one();
                let row = m.get_mut(column * nv..).unwrap_or(&mut []);
                store_first(row, base.momentum(Motion::from(unit)).to_array());
            }
        }
        // M = Mᵀ
        for i in 1..nv {
            let Some((above, below)) = m.split_at_mut_checked(i * nv) else { break };
            for (j, entry) in below.iter().enumerate().take(i) {
                if let Some(mirrored) = above.get_mut(j * nv + i) {
                    *mirrored = *entry;
                }
            }
        }
        Ok(())
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
            s[on.v_index() * nv + column] = on.joint.along(f);
            f = on.across(scratch[b].theta, q[on.q_index()]).inv_force(f);
            f = on.branch().map_or(f, |branch| branch.inv_force(f));
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
