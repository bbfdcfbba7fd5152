//! Impacts: velocities jump, positions stay.
//!
//! `M (q̇⁺ − q̇⁻) = Jᵀ p` with `J q̇⁺ = 0`, or along the normal of a contact `J q̇⁺ = −e J q̇⁻`. Torques that stay finite have no part in it:
//! motors, gravity, springs and dampers of transmissions.
//!
//! An elastic transmission therefore leaves its rotor alone: its angular momentum along its axis stays, `N Δθ̇ = −n·Δω` of its carrier, and `M` is that of
//! the links. A rigid gear has its rotor stopped with the joint: `M` has the reflected inertia `N² J`, often most of the
//! whole, and the teeth transmit an impulse. The same robot takes a smaller blow with elastic transmissions; what is left in its rotors goes
//! into the springs afterwards.

use super::anchor::Held;
use super::forward::{Constrained, ConstrainedScratch, Place, check_sizes};
use super::frames::Root;
use super::joint_space::blow;
use super::solve::{Regularisation, Solved};
use super::spec::{Constraint, ConstraintError};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::dynamics::aba::{self, Found, Known};
use crate::dynamics::{External, Forward, State, check_state};
use crate::model::{Model, SizeError};
use crate::spatial::{Motion, Vec3};

/// Velocities after an impact: `nv` entries each.
#[derive(Debug)]
pub struct Impact<'a, T> {
    /// `q̇⁺`.
    pub qd: &'a mut [T],
    /// `θ̇⁺`; equal to `q̇⁺` where there is no elastic transmission.
    pub thetad: &'a mut [T],
    /// Impulse that a rigid gear exerts on its joint [N m s or N s]; zero elsewhere.
    pub gears: &'a mut [T],
}

/// Velocities after everything in `constraints` is caught at once, and the impulses of it. Of `state`, `theta` is not read.
///
/// `release` lets contacts go that would have to pull, the one that pulls most first; the multipliers of the others may tell afterwards that they
/// do not. Without it a pulling contact has a multiplier below zero along its normal.
///
/// # Errors
/// A slice that does not fit, or a constraint that does not fit the model; nothing is written then.
#[expect(clippy::too_many_arguments)]
pub fn impact<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    constraints: &[Constraint<T>],
    release: bool,
    regularisation: Regularisation<T>,
    scratch: ConstrainedScratch<T>,
    out: Impact<T>,
    forces: Constrained<T>,
) -> Result<Solved<T>, ConstraintError> {
    if !model.has_remote_rigid_rotor() {
        return impact_aba(model, state, constraints, release, regularisation, scratch, out, forces);
    }
    check(model, &state, constraints, &scratch, &out, &forces)?;
    let jump = Forward { qdd: &mut *out.qd, thetadd: &mut *out.thetad, tau_j: &mut *out.gears };
    let solved = blow(model, state, constraints, release, regularisation, scratch, jump, forces)?;
    add_to(model, &state, out);
    Ok(solved)
}

/// The same by the articulated-body algorithm alone: exact, but for robots with [`Model::has_remote_rigid_rotor`]. It links no code that could panic,
/// and `joint_space` and `joint_matrix` of the scratch are not used.
///
/// # Errors
/// A slice that does not fit, or a constraint that does not fit the model; nothing is written then.
#[expect(clippy::too_many_arguments)]
pub fn impact_aba<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    constraints: &[Constraint<T>],
    release: bool,
    regularisation: Regularisation<T>,
    scratch: ConstrainedScratch<T>,
    out: Impact<T>,
    forces: Constrained<T>,
) -> Result<Solved<T>, ConstraintError> {
    check(model, &state, constraints, &scratch, &out, &forces)?;
    let (mut scratch, mut forces) = (scratch, forces);
    let solved = T::dispatch(Blow {
        model,
        state: &state,
        constraints,
        release,
        regularisation: &regularisation,
        scratch: &mut scratch,
        out: &mut Forward { qdd: &mut *out.qd, thetadd: &mut *out.thetad, tau_j: &mut *out.gears },
        forces: &mut forces,
    })?;
    add_to(model, &state, out);
    Ok(solved)
}

fn check<T: Scalar>(
    model: &Model<T::Param>,
    state: &State<T>,
    constraints: &[Constraint<T>],
    scratch: &ConstrainedScratch<T>,
    out: &Impact<T>,
    forces: &Constrained<T>,
) -> Result<(), ConstraintError> {
    check_state(model, state)?;
    SizeError::check("qd after", out.qd.len(), model.nv)?;
    SizeError::check("thetad after", out.thetad.len(), model.nv)?;
    SizeError::check("gears", out.gears.len(), model.nv)?;
    check_sizes(model, constraints, scratch, forces)
}

/// From jumps to velocities.
fn add_to<T: Scalar>(model: &Model<T::Param>, state: &State<T>, out: Impact<T>) {
    for (after, before) in out.qd.iter_mut().zip(state.qd) {
        *after += *before;
    }
    let mut at = out.thetad.iter_mut().zip(state.thetad).zip(out.qd.iter());
    for body in model.bodies {
        for ((motor, before), link) in at.by_ref().take(body.joint.nv()) {
            *motor = if body.is_elastic() { *motor + *before } else { *link };
        }
    }
}

struct Blow<'a, 'm, 's, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    state: &'a State<'a, T>,
    constraints: &'a [Constraint<T>],
    release: bool,
    regularisation: &'a Regularisation<T>,
    scratch: &'a mut ConstrainedScratch<'s, T>,
    out: &'a mut Forward<'s, T>,
    forces: &'a mut Constrained<'s, T>,
}

impl<T: Scalar> Kernel<T> for Blow<'_, '_, '_, T> {
    type Output = Result<Solved<T>, SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<Solved<T>, SizeError> {
        let Self { model, state, constraints, release, regularisation, scratch, out, forces } = self;
        let (weightless, none) = (model.with_gravity(Vec3::zero()), External::none());
        let still = State { q: state.q, qd: &[], theta: &[], thetad: &[] };
        let known = Known::of_impulses(&weightless, &still, &none, state.qd)?;
        let mut found = Found::of(&known.tree, out)?;
        let bodies = known.tree.bodies_mut("scratch", &mut *scratch.bodies)?.1;
        let mut base = aba::at_rest::<T, F>(&known, bodies, found.tau_j);
        if model.plain {
            aba::inward::<T, F, true>(&known, bodies, &mut base);
        } else {
            aba::inward::<T, F, false>(&known, bodies, &mut base);
        }
        let root = Root::of(&known.tree, state.q, state.qd);
        let (tree, q, qd) = (known.tree, known.q, known.qd);
        let at = Place { tree, q, qd, root, lift: Vec3::zero(), free_base: Motion::zero() };
        let wanted = |constraint: &Constraint<T>, held: &Held<T>, _, k: usize| {
            -(F::load(held.velocity[k]) * F::load(rebound(constraint, k)))
        };
        let solved = at.hold(constraints, wanted, (regularisation, release), &mut base, scratch, forces)?;
        let bodies = known.tree.bodies_mut("scratch", &mut *scratch.bodies)?.1;
        if model.plain {
            aba::accelerations::<T, F, true>(&known, bodies, &base, &mut found);
        } else {
            aba::accelerations::<T, F, false>(&known, bodies, &base, &mut found);
        }
        Ok(solved)
    }
}

/// `1 + e` along the normal of a contact, 1 elsewhere.
#[inline(always)]
pub(super) fn rebound<T: Scalar>(constraint: &Constraint<T>, direction: usize) -> T {
    match &constraint.contact {
        Some(contact) if contact.normal == direction => T::one() + contact.restitution,
        _ => T::one(),
    }
}
