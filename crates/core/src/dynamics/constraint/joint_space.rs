//! Constraints by the inertia matrix, for robots whose rigidly geared rotors sit away from their joint's parent.

use super::anchor::Held;
use super::forward::{Constrained, ConstrainedScratch};
use super::frames::{Root, SupportScratch, bodies, joint_of};
use super::jacobian::{ConstraintMotion, constraint_motion};
use super::solve::{Regularisation, Solved, System};
use super::spec::{Constraint, ConstraintError, Hold, constraint_rows};
use crate::Scalar;
use crate::dynamics::branches::{half_solve, solve};
use crate::dynamics::joint_space::accelerate;
use crate::dynamics::tree::Tree;
use crate::dynamics::{External, Forward, JointSpaceScratch, State, forward_in_joint_space};
use crate::model::Model;
use crate::spatial::{Force, Motion, Transform, Vec3};

/// Length of [`ConstrainedScratch::joint_matrix`]: zero, unless a rigidly geared rotor sits away from its joint's parent.
pub fn constrained_joint_matrix_len<P: Scalar, T: Scalar>(model: &Model<P>, constraints: &[Constraint<T>]) -> usize {
    let (nv, rows) = (model.nv(), constraint_rows(constraints));
    if model.has_remote_rigid_rotor() { (nv + 2 * rows + 1) * nv } else { 0 }
}

/// Storage cut from `joint_matrix`.
struct Matrices<'a, T> {
    /// `M`, then its factors.
    m: &'a mut [T],
    /// `J`.
    jacobian: &'a mut [T],
    /// `J L⁻¹ D^-½`.
    weighted: &'a mut [T],
    /// `nv` entries.
    vector: &'a mut [T],
}

impl<'a, T> Matrices<'a, T> {
    fn of(nv: usize, rows: usize, all: &'a mut [T]) -> Self {
        let (m, rest) = all.split_at_mut(nv * nv);
        let (jacobian, rest) = rest.split_at_mut(rows * nv);
        let (weighted, vector) = rest.split_at_mut(rows * nv);
        Self { m, jacobian, weighted, vector }
    }
}

/// [`super::constrained_forward_dynamics`] for every robot.
#[expect(clippy::too_many_arguments)]
pub(super) fn forward<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    constraints: &[Constraint<T>],
    regularisation: Regularisation<T>,
    scratch: ConstrainedScratch<T>,
    out: Forward<T>,
    forces: Constrained<T>,
) -> Result<Solved<T>, ConstraintError> {
    let (nv, rows) = (model.nv(), constraint_rows(constraints));
    let ConstrainedScratch { supports, matrix, joint_space, joint_matrix, .. } = scratch;
    let Matrices { m, jacobian, weighted, vector } = Matrices::of(nv, rows, joint_matrix);
    let free = Forward { qdd: &mut *out.qdd, thetadd: &mut *out.thetadd, tau_j: &mut *out.tau_j };
    forward_in_joint_space(model, state, tau, ext, joint_space, m, free)?;
    let motion = ConstraintMotion { error: &mut [], velocity: &mut [], jacobian: &mut *jacobian };
    constraint_motion(model, state.q, state.qd, constraints, supports, motion)?;

    let place = Place::of(model, &state, supports);
    let system = &mut System::of(rows, matrix);
    place.compliance(model, m, jacobian, weighted, system);
    let mut row = 0;
    for constraint in constraints {
        let held = place.held(constraint);
        let [on, to] = bodies(constraint).map(|body| place.acceleration(body, joint_space));
        let difference = Motion { ang: on.ang - to.ang, lin: on.lin - to.lin };
        let omega = constraint.stabilisation;
        for k in (0..6).filter(|k| constraint.holds(*k)) {
            let free = match &constraint.hold {
                Hold::Frame { .. } => difference.dot(held.wrenches[k]) + held.bias[k],
                Hold::Joints { .. } => {
                    let entries = &jacobian[row * nv..(row + 1) * nv];
                    entries.iter().zip(out.qdd.iter()).fold(T::zero(), |sum, (j, qdd)| j.mul_add(*qdd, sum))
                }
            };
            let wanted = -(omega * (held.velocity[k] + held.velocity[k] + omega * held.error[k]));
            system.b[row] = wanted - free;
            row += 1;
        }
    }
    let solved = system.solve::<T>(constraints, &regularisation, false, forces.multipliers);
    transposed_times(jacobian, forces.multipliers, vector);
    for (sum, given) in vector.iter_mut().zip(ext.tau) {
        *sum += *given;
    }
    forward_in_joint_space(model, state, tau, External { tau: vector, ..ext }, joint_space, m, out)?;
    place.wrenches(constraints, forces);
    Ok(solved)
}

/// [`super::impact`] for every robot.
#[expect(clippy::too_many_arguments)]
pub(super) fn blow<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    constraints: &[Constraint<T>],
    release: bool,
    regularisation: Regularisation<T>,
    scratch: ConstrainedScratch<T>,
    out: Forward<T>,
    forces: Constrained<T>,
) -> Result<Solved<T>, ConstraintError> {
    let (nv, rows) = (model.nv(), constraint_rows(constraints));
    let ConstrainedScratch { supports, matrix, joint_space, joint_matrix, .. } = scratch;
    let Matrices { m, jacobian, weighted, vector } = Matrices::of(nv, rows, joint_matrix);
    // The factors of M do not depend on what moves.
    vector.fill(T::zero());
    let rest = State { q: state.q, qd: vector, theta: vector, thetad: vector };
    let unused = Forward { qdd: &mut *out.qdd, thetadd: &mut *out.thetadd, tau_j: &mut *out.tau_j };
    forward_in_joint_space(model, rest, vector, External::none(), joint_space, m, unused)?;
    let motion = ConstraintMotion { error: &mut [], velocity: &mut [], jacobian: &mut *jacobian };
    constraint_motion(model, state.q, state.qd, constraints, supports, motion)?;

    let place = Place::of(model, &state, supports);
    let system = &mut System::of(rows, matrix);
    place.compliance(model, m, jacobian, weighted, system);
    let mut row = 0;
    for constraint in constraints {
        let held = place.held(constraint);
        for k in (0..6).filter(|k| constraint.holds(*k)) {
            system.b[row] = -held.velocity[k] * super::impact::rebound(constraint, k);
            row += 1;
        }
    }
    let solved = system.solve::<T>(constraints, &regularisation, release, forces.multipliers);
    transposed_times(jacobian, forces.multipliers, vector);
    solve::<T, T>(model, m, vector, 1);
    for s in joint_space.iter_mut() {
        (s.c, s.on_rotor) = (Motion::zero(), T::zero());
    }
    out.tau_j.fill(T::zero());
    accelerate(model, Motion::zero(), joint_space, vector, out.thetadd, out.tau_j);
    out.qdd.copy_from_slice(vector);
    place.wrenches(constraints, forces);
    Ok(solved)
}

/// `Jᵀ λ`.
fn transposed_times<T: Scalar>(jacobian: &[T], lambda: &[T], out: &mut [T]) {
    let nv = out.len();
    out.fill(T::zero());
    for (row, lambda) in jacobian.chunks_exact(nv.max(1)).zip(lambda) {
        for (sum, entry) in out.iter_mut().zip(row) {
            *sum = lambda.mul_add(*entry, *sum);
        }
    }
}

/// A robot at a state, its constraints' frames known.
struct Place<'a, 'm, T: Scalar> {
    tree: Tree<'m, T::Param>,
    root: Root<T>,
    lift: Vec3<T>,
    q: &'a [T],
    qd: &'a [T],
    supports: &'a [SupportScratch<T>],
}

impl<'a, 'm, T: Scalar> Place<'a, 'm, T> {
    fn of(model: &Model<'m, T::Param>, state: &State<'a, T>, supports: &'a [SupportScratch<T>]) -> Self {
        let tree = Tree::of(model);
        let root = Root::of(&tree, state.q, state.qd);
        let lead = model.bodies().len() - tree.joints.len();
        let n = tree.joints.len();
        Self {
            lift: root.pose.rot * -model.gravity().map(T::from_param),
            q: &state.q[state.q.len() - n..],
            qd: &state.qd[state.qd.len() - n..],
            supports: &supports[lead..],
            tree,
            root,
        }
    }

    fn held(&self, constraint: &Constraint<T>) -> Held<T> {
        Held::of(constraint, &self.tree, &self.root, self.q, self.qd, self.supports)
    }

    /// Acceleration of a body as a point in space, in base axes about the base's origin; of the world that against gravity.
    fn acceleration(&self, body: Option<usize>, joint_space: &[JointSpaceScratch<T>]) -> Motion<T> {
        let Some(body) = body else { return Motion { ang: Vec3::zero(), lin: self.lift } };
        let (pose, v) = match joint_of(&self.tree, Some(body)).and_then(|i| self.supports.get(i)) {
            Some(s) => (s.pose, s.v),
            None => (Transform::identity(), self.root.v),
        };
        let a = pose.inv_motion(joint_space[body].a);
        Motion { ang: a.ang, lin: a.lin + v.ang.cross(v.lin + v.ang.cross(pose.pos)) }
    }

    /// `J M⁻¹ Jᵀ = W Wᵀ` for `W = J L⁻¹ D^-½`.
    fn compliance(&self, model: &Model<T::Param>, m: &[T], jacobian: &[T], weighted: &mut [T], system: &mut System<T>) {
        let (nv, rows) = (model.nv(), system.rows);
        weighted.copy_from_slice(jacobian);
        for row in weighted.chunks_exact_mut(nv.max(1)) {
            half_solve(model, m, row);
        }
        for i in 0..rows {
            for j in 0..rows {
                let product = weighted[i * nv..(i + 1) * nv].iter().zip(&weighted[j * nv..(j + 1) * nv]);
                system.a[i * rows + j] = product.fold(T::zero(), |sum, (a, b)| a.mul_add(*b, sum));
            }
        }
    }

    fn wrenches(&self, constraints: &[Constraint<T>], forces: Constrained<T>) {
        let mut row = 0;
        for (constraint, wrench) in constraints.iter().zip(forces.wrenches) {
            let (held, mut total) = (self.held(constraint), Force::zero());
            for k in (0..6).filter(|k| constraint.holds(*k)) {
                total += held.wrenches[k].scale(forces.multipliers[row]);
                row += 1;
            }
            *wrench = held.wrench_in_world(&self.root, total);
        }
    }
}
