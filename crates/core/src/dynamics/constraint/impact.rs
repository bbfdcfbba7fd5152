//! Impacts: velocities jump, positions stay.
//!
//! `M (q̇⁺ − q̇⁻) = Jᵀ p` with `J q̇⁺ = 0`, or along the normal of a contact `J q̇⁺ = −e J q̇⁻`. Torques that stay finite have no part in it:
//! motors, gravity, springs and dampers of transmissions.
//!
//! An elastic transmission therefore leaves its rotor alone: its angular momentum along its axis stays, `N Δθ̇ = −n·Δω` of its carrier, and `M` is that of
//! the links. A rigid gear has its rotor stopped with the joint: `M` has the reflected inertia `N² J`, often most of the
//! whole, and the teeth transmit an impulse. The same robot takes a smaller blow with elastic transmissions; what is left in its rotors goes
//! into the springs afterwards.

use super::forward::{Constrained, ConstrainedScratch, Place, check_sizes};
use super::frames::Root;
use super::joint_space::blow;
use super::solve::{Regularisation, Solved, System};
use super::spec::{Constraint, ConstraintError};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::dynamics::aba::{self, Found, Known};
use crate::dynamics::{External, Forward, State};
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
    super::super::check_state(model, &state)?;
    SizeError::check("qd after", out.qd.len(), model.nv)?;
    SizeError::check("thetad after", out.thetad.len(), model.nv)?;
    SizeError::check("gears", out.gears.len(), model.nv)?;
    check_sizes(model, constraints, &scratch, &forces)?;
    let (mut scratch, mut forces) = (scratch, forces);
    let mut jump = Forward { qdd: &mut *out.qd, thetadd: &mut *out.thetad, tau_j: &mut *out.gears };
    let solved = if model.has_remote_rigid_rotor() {
        blow(model, state, constraints, release, regularisation, scratch, jump, forces)?
    } else {
        T::dispatch(Blow {
            model,
            state: &state,
            constraints,
            release,
            regularisation: &regularisation,
            scratch: &mut scratch,
            out: &mut jump,
            forces: &mut forces,
        })?
    };
    for (after, before) in out.qd.iter_mut().zip(state.qd) {
        *after += *before;
    }
    for body in model.bodies {
        let k = body.v_index();
        for i in k..k + body.joint.nv() {
            out.thetad[i] = if body.is_elastic() { out.thetad[i] + state.thetad[i] } else { out.qd[i] };
        }
    }
    Ok(solved)
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
        if self.model.plain { self.passes::<F, true>() } else { self.passes::<F, false>() }
    }
}

impl<T: Scalar> Blow<'_, '_, '_, T> {
    #[inline(always)]
    fn passes<F: Over<T>, const PLAIN: bool>(self) -> Result<Solved<T>, SizeError> {
        let Self { model, state, constraints, release, regularisation, scratch, out, forces } = self;
        let (weightless, none) = (model.with_gravity(Vec3::zero()), External::none());
        let still = State { q: state.q, qd: &[], theta: &[], thetad: &[] };
        let known = Known::of_impulses(&weightless, &still, &none, state.qd)?;
        let ConstrainedScratch { bodies, supports, constraints: kept, propagated, matrix, .. } = scratch;
        let (_, bodies) = known.tree.bodies_mut("scratch", bodies)?;
        let (_, supports) = known.tree.bodies_mut("scratch", supports)?;
        let mut found = Found::of(&known.tree, out)?;
        let mut base = aba::at_rest::<T, F>(&known, bodies, found.tau_j);
        aba::inward::<T, F, PLAIN>(&known, bodies, &mut base);

        let root = Root::of(&known.tree, state.q, state.qd);
        let at = Place { known: &known, root, lift: Vec3::zero(), free_base: Motion::zero() };
        at.gather::<PLAIN>(constraints, &base, bodies, supports, kept, propagated, matrix);
        let mut row = 0;
        let mut system = System::of(forces.multipliers.len(), matrix);
        for constraint in constraints {
            let held = at.held(constraint, supports);
            for k in (0..6).filter(|k| constraint.holds(*k)) {
                if let Some(b) = system.b.get_mut(row) {
                    *b = (-(held.velocity[k] * F::load(rebound(constraint, k)))).store();
                }
                row += 1;
            }
        }
        let solved = system.solve::<F>(constraints, regularisation, release, forces.multipliers);
        at.load(constraints, &mut base, bodies, supports, kept, propagated, forces);
        aba::accelerations::<T, F, PLAIN>(&known, bodies, &base, &mut found);
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
