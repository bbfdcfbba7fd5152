//! Forward dynamics under constraints.

use super::anchor::Held;
use super::frames::{Root, SupportScratch, mark, outward};
use super::joint_space::{constrained_joint_matrix_len, forward};
use super::propagate::{ConstraintScratch, PropagatedScratch, block, mirror, propagate, write};
use super::solve::{Regularisation, Solved, System};
use super::spec::{Constraint, ConstraintError, check, constraint_matrix_len, constraint_rows, propagated_len};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::dynamics::aba::{self, Found, Known};
use crate::dynamics::aba_base::Base;
use crate::dynamics::tree::Tree;
use crate::dynamics::{
    AbaScratch, External, Forward, JointSpaceScratch, State, check_external, check_scratch, check_state,
    joint_space_len,
};
use crate::model::{Model, SizeError};
use crate::spatial::{Force, Motion, Vec3};

/// Scratch for [`constrained_forward_dynamics`] and [`super::impact`].
#[derive(Debug)]
pub struct ConstrainedScratch<'a, T> {
    /// One record per body.
    pub bodies: &'a mut [AbaScratch<T>],
    /// One record per body.
    pub supports: &'a mut [SupportScratch<T>],
    /// One record per constraint.
    pub constraints: &'a mut [ConstraintScratch<T>],
    /// [`propagated_len`] records: one per constraint and body.
    pub propagated: &'a mut [PropagatedScratch<T>],
    /// [`constraint_matrix_len`] entries.
    pub matrix: &'a mut [T],
    /// [`joint_space_len`] records.
    pub joint_space: &'a mut [JointSpaceScratch<T>],
    /// [`constrained_joint_matrix_len`](super::constrained_joint_matrix_len) entries.
    pub joint_matrix: &'a mut [T],
}

/// What constrained dynamics writes beside the accelerations.
#[derive(Debug)]
pub struct Constrained<'a, T> {
    /// `λ`, [`constraint_rows`] entries, constraint by constraint, direction by direction [N or N m; in impacts N s or N m s].
    pub multipliers: &'a mut [T],
    /// Force of each constraint on its frame's body, about the frame's origin, in world axes; of coupled joints zero.
    pub wrenches: &'a mut [Force<T>],
}

/// Accelerations of all joints and motors, and the forces of constraints, from state, motor torques and external loads: [`super::super::aba`]
/// with something held.
///
/// # Errors
/// A slice that does not fit, or a constraint that does not fit the model; nothing is written then.
///
/// # Example
///
/// Two links of a chain hang from the world at both ends: the supports share the weight.
///
/// ```
/// use gyroflex::dynamics::*;
/// # use gyroflex::model::*;
/// use gyroflex::spatial::{Force, Transform, Vec3};
/// # use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3};
/// # let at = |x: f64| Transform::from_pose(Mat3::identity(), Vec3::new(x, 0.0, 0.0));
/// # let link = |parent, x| BodySpec {
/// #     parent,
/// #     joint: JointKind::Revolute,
/// #     axis: Vec3::new(0.0, 1.0, 0.0),
/// #     placement: at(x),
/// #     inertia: SpatialInertia::from_com(2.0, Vec3::new(0.5, 0.0, 0.0), SymMat3::diagonal(1e-3, 0.1, 0.1)),
/// #     friction: Friction::none(),
/// #     drive: None,
/// # };
/// # let robot =
/// #     RobotSpec { bodies: &[link(None, 0.0), link(Some(0), 1.0)], spring_tables: &[], gravity: Vec3::new(0.0, 0.0, -9.81) };
/// # let mut bodies = [Body::empty(); 2];
/// # let model = robot.lower(Fidelity::Complete, &mut bodies, &mut [])?;
/// // The end of the second link is held where it is: 60° down and 60° up, an equilateral triangle.
/// let (q, rest) = ([1.0471975511965976, -2.0943951023931953], [0.0; 2]);
/// let end = Frame { body: 1, placement: Transform { pos: Vec3::new(1.0, 0.0, 0.0), ..Transform::identity() } };
/// let anchor = Anchor { body: None, placement: Transform { pos: Vec3::new(1.0, 0.0, 0.0), ..Transform::identity() } };
/// let hold = Hold::Frame { frame: end, anchor, directions: Directions::PLANAR_POINT };
/// let constraints = [Constraint { hold, stabilisation: 0.0, contact: None }];
///
/// let (mut qdd, mut thetadd, mut tau_j) = ([0.0_f64; 2], [0.0; 2], [0.0; 2]);
/// let (mut multipliers, mut wrenches) = ([0.0; 2], [Force::<f64>::zero(); 1]);
/// constrained_forward_dynamics(
///     &model,
///     State { q: &q, qd: &rest, theta: &rest, thetad: &rest },
///     &rest,
///     External::none(),
///     &constraints,
///     Regularisation::rank_revealing(1e-9),
///     ConstrainedScratch {
///         bodies: &mut [AbaScratch::new(); 2],
///         supports: &mut [SupportScratch::new(); 2],
///         constraints: &mut [ConstraintScratch::new(); 1],
///         propagated: &mut [PropagatedScratch::new(); 2],
///         matrix: &mut [0.0; 12],
///         joint_space: &mut [],
///         joint_matrix: &mut [],
///     },
///     Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
///     Constrained { multipliers: &mut multipliers, wrenches: &mut wrenches },
/// )?;
/// assert!(qdd[0].abs() < 1e-9 && qdd[1].abs() < 1e-9);
/// assert!((wrenches[0].lin.z - 2.0 * 9.81).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[expect(clippy::too_many_arguments)]
pub fn constrained_forward_dynamics<T: Scalar>(
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
    if model.has_remote_rigid_rotor() {
        check_inputs(model, &state, tau, &ext, &out)?;
        check_sizes(model, constraints, &scratch, &forces)?;
        return forward(model, state, tau, ext, constraints, regularisation, scratch, out, forces);
    }
    constrained_aba(model, state, tau, ext, constraints, regularisation, scratch, out, forces)
}

/// The same by the articulated-body algorithm alone: exact, but for robots with [`Model::has_remote_rigid_rotor`]. It links no code that could panic,
/// and `joint_space` and `joint_matrix` of the scratch are not used.
///
/// # Errors
/// A slice that does not fit, or a constraint that does not fit the model; nothing is written then.
#[expect(clippy::too_many_arguments)]
pub fn constrained_aba<T: Scalar>(
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
    check_inputs(model, &state, tau, &ext, &out)?;
    check_sizes(model, constraints, &scratch, &forces)?;
    let (mut scratch, mut out, mut forces) = (scratch, out, forces);
    let solved = T::dispatch(ConstrainedAba {
        model,
        state: &state,
        tau,
        ext: &ext,
        constraints,
        regularisation: &regularisation,
        scratch: &mut scratch,
        out: &mut out,
        forces: &mut forces,
    })?;
    Ok(solved)
}

fn check_inputs<T: Scalar>(
    model: &Model<T::Param>,
    state: &State<T>,
    tau: &[T],
    ext: &External<T>,
    out: &Forward<T>,
) -> Result<(), SizeError> {
    check_state(model, state)?;
    check_external(model, ext)?;
    out.check(model, tau)
}

pub(super) fn check_sizes<T: Scalar>(
    model: &Model<T::Param>,
    constraints: &[Constraint<T>],
    scratch: &ConstrainedScratch<T>,
    forces: &Constrained<T>,
) -> Result<(), ConstraintError> {
    check(model, constraints)?;
    check_scratch(model, scratch.bodies)?;
    check_scratch(model, scratch.supports)?;
    SizeError::check("constraint scratch", scratch.constraints.len(), constraints.len())?;
    SizeError::check("propagated scratch", scratch.propagated.len(), propagated_len(model, constraints))?;
    SizeError::check("matrix", scratch.matrix.len(), constraint_matrix_len(constraints))?;
    SizeError::check("joint_space scratch", scratch.joint_space.len(), joint_space_len(model))?;
    let joint_matrix = constrained_joint_matrix_len(model, constraints);
    SizeError::check("joint_matrix", scratch.joint_matrix.len(), joint_matrix)?;
    SizeError::check("multipliers", forces.multipliers.len(), constraint_rows(constraints))?;
    SizeError::check("wrenches", forces.wrenches.len(), constraints.len())?;
    Ok(())
}

struct ConstrainedAba<'a, 'm, 's, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    state: &'a State<'a, T>,
    tau: &'a [T],
    ext: &'a External<'a, T>,
    constraints: &'a [Constraint<T>],
    regularisation: &'a Regularisation<T>,
    scratch: &'a mut ConstrainedScratch<'s, T>,
    out: &'a mut Forward<'s, T>,
    forces: &'a mut Constrained<'s, T>,
}

impl<T: Scalar> Kernel<T> for ConstrainedAba<'_, '_, '_, T> {
    type Output = Result<Solved<T>, SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<Solved<T>, SizeError> {
        let Self { model, state, tau, ext, constraints, regularisation, scratch, out, forces } = self;
        let known = Known::of(model, state, tau, ext)?;
        let mut found = Found::of(&known.tree, out)?;
        let lift = -model.gravity.map(F::from_param);
        // Only the sweeps have a variant for plain robots: code for constraints is long.
        let bodies = known.tree.bodies_mut("scratch", &mut *scratch.bodies)?.1;
        let mut base = if model.plain {
            let mut base = aba::outward::<T, F, true>(&known, bodies, found.tau_j);
            aba::inward::<T, F, true>(&known, bodies, &mut base);
            base
        } else {
            let mut base = aba::outward::<T, F, false>(&known, bodies, found.tau_j);
            aba::inward::<T, F, false>(&known, bodies, &mut base);
            base
        };
        let root = Root::of(&known.tree, state.q, state.qd);
        let (free_base, _) = base.acceleration::<T>(lift, tau, ext);
        let (tree, q, qd) = (known.tree, known.q, known.qd);
        let at = Place { tree, q, qd, root, lift: root.pose.rot * lift, free_base };
        // Φ̈ = −2 ω Φ̇ − ω² Φ
        let wanted = |constraint: &Constraint<T>, held: &Held<T>, free: F, k: usize| {
            let omega = F::load(constraint.stabilisation);
            let (velocity, error) = (F::load(held.velocity[k]), F::load(held.error[k]));
            -(omega * (velocity + velocity + omega * error)) - free
        };
        let solved = at.hold(constraints, wanted, (regularisation, false), &mut base, scratch, forces)?;
        let bodies = known.tree.bodies_mut("scratch", &mut *scratch.bodies)?.1;
        if model.plain {
            aba::accelerations::<T, F, true>(&known, bodies, &base, &mut found);
        } else {
            aba::accelerations::<T, F, false>(&known, bodies, &base, &mut found);
        }
        Ok(solved)
    }
}

/// A robot at a state, between the second and the third sweep.
pub(super) struct Place<'a, 'm, T: Scalar, F> {
    pub(super) tree: Tree<'m, T::Param>,
    pub(super) q: &'a [T],
    pub(super) qd: &'a [T],
    pub(super) root: Root<F>,
    /// Acceleration upwards that stands for gravity, in base axes.
    pub(super) lift: Vec3<F>,
    /// The base's acceleration without constraints.
    pub(super) free_base: Motion<F>,
}

impl<T: Scalar, F: Over<T>> Place<'_, '_, T, F> {
    /// Finds the multipliers for which `Φ̈`, or the jump of `Φ̇`, becomes what it would be without them plus `wanted`, and loads joints and base with their
    /// forces.
    #[inline(always)]
    pub(super) fn hold(
        &self,
        constraints: &[Constraint<T>],
        wanted: impl Fn(&Constraint<T>, &Held<T>, F, usize) -> F,
        (regularisation, release): (&Regularisation<T>, bool),
        base: &mut Base<F>,
        scratch: &mut ConstrainedScratch<T>,
        forces: &mut Constrained<T>,
    ) -> Result<Solved<T>, SizeError> {
        let tree = &self.tree;
        let ConstrainedScratch { bodies, supports, constraints: kept, propagated, matrix, .. } = scratch;
        let (bodies, supports) = (tree.bodies_mut("scratch", bodies)?.1, tree.bodies_mut("scratch", supports)?.1);
        self.gather(constraints, base, bodies, supports, kept, propagated, matrix);
        let mut row = 0;
        let mut system = System::of(forces.multipliers.len(), matrix);
        for (constraint, kept) in constraints.iter().zip(kept.iter()) {
            for k in (0..6).filter(|k| constraint.holds(*k)) {
                if let Some(b) = system.b.get_mut(row) {
                    *b = wanted(constraint, &kept.held, F::load(kept.free[k]), k).store();
                }
                row += 1;
            }
        }
        let solved = system.solve::<F>(constraints, regularisation, release, forces.multipliers);
        self.load(constraints, base, bodies, kept, propagated, forces);
        Ok(solved)
    }

    /// `J M⁻¹ Jᵀ` into the matrix, and `Φ̈` without the constraints' forces into `kept`.
    #[inline(always)]
    #[expect(clippy::too_many_arguments)]
    fn gather(
        &self,
        constraints: &[Constraint<T>],
        base: &Base<F>,
        bodies: &[AbaScratch<T>],
        supports: &mut [SupportScratch<T>],
        kept: &mut [ConstraintScratch<T>],
        propagated: &mut [PropagatedScratch<T>],
        matrix: &mut [T],
    ) {
        let (tree, n) = (&self.tree, bodies.len());
        mark(tree, constraints, supports);
        for (s, x) in bodies.iter().zip(supports.iter_mut()) {
            x.theta = s.theta;
        }
        outward(tree, &self.root, self.q, self.qd, supports);
        for (k, (constraint, kept)) in constraints.iter().zip(kept.iter_mut()).enumerate() {
            let held = Held::of(constraint, tree, &self.root, self.q, self.qd, supports);
            let way = propagated.get_mut(k * n..(k + 1) * n).unwrap_or_default();
            let free = (self.lift, self.free_base);
            propagate(constraint, &held, tree, base, free, (bodies, supports), (way, kept));
        }
        let way_of = |k: usize| propagated.get(k * n..(k + 1) * n).unwrap_or_default();
        let size = constraint_rows(constraints);
        let mut first = 0;
        for (k, (a, kept_a)) in constraints.iter().zip(kept.iter()).enumerate() {
            let mut column = first;
            for (l, (b, kept_b)) in constraints.iter().zip(kept.iter()).enumerate().skip(k) {
                let block: [[F; 6]; 6] = block(bodies, (way_of(k), kept_a), (way_of(l), kept_b));
                write(&block, (a, b), (first, column), size, matrix);
                column += b.rows();
            }
            first += a.rows();
        }
        mirror(size, matrix);
    }

    /// The multipliers' forces on joints and base, and in the world.
    #[inline(always)]
    fn load(
        &self,
        constraints: &[Constraint<T>],
        base: &mut Base<F>,
        bodies: &mut [AbaScratch<T>],
        kept: &[ConstraintScratch<T>],
        propagated: &[PropagatedScratch<T>],
        forces: &mut Constrained<T>,
    ) {
        let n = bodies.len();
        let mut first = 0;
        for (k, (constraint, kept)) in constraints.iter().zip(kept).enumerate() {
            let mut lambda = [F::zero(); 6];
            let mut row = first;
            for (direction, entry) in lambda.iter_mut().enumerate() {
                if constraint.holds(direction) {
                    *entry = forces.multipliers.get(row).map_or(F::zero(), |x| F::load(*x));
                    row += 1;
                }
            }
            first = row;
            let way = propagated.get(k * n..(k + 1) * n).unwrap_or_default();
            for (s, w) in bodies.iter_mut().zip(way).filter(|(_, w)| w.on_way) {
                let sum = w.taken.iter().zip(lambda).fold(F::load(s.u), |sum, (t, l)| F::load(*t).mul_add(l, sum));
                s.u = sum.store();
            }
            for (force, l) in kept.at_base.iter().zip(lambda) {
                base.p -= force.map(F::load).scale(l);
            }
            let held = kept.held.map(F::load);
            let total = held.wrenches.iter().zip(lambda).fold(Force::zero(), |sum, (f, l)| sum + f.scale(l));
            if let Some(wrench) = forces.wrenches.get_mut(k) {
                *wrench = held.wrench_in_world(&self.root, total).map(F::store);
            }
        }
    }
}
