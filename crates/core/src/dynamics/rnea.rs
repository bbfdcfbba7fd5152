//! Inverse dynamics in one sweep out and one in: the recursive Newton–Euler algorithm (RBDA table 5.1) with rotors, in
//! classical accelerations.
//!
//! With the acceleration `a` of a body's origin as a point in space, Newton's and Euler's equations about that origin need
//! no linear velocity: `f = m a + α × h + ω × (ω × h)`, `n = I α + ω × I ω + h × a`, where `h = m c` (Craig,
//! *Introduction to Robotics*, eq. 6.45–6.53, about the frame's origin).
//!
//! A rotor's absolute axial momentum is `h = J (N θ̇ + n·ω)`. Its carrier must supply the couple `ḣ n + ω × h n`, its motor
//! the reflected torque `N ḣ = B θ̈ + N J n·α` (PHYSICS §3). An elastic rotor's `J n nᵀ` is not part of the carrier's inertia,
//! so the whole of `h` counts; a rigid one's is, so only `N J q̇` counts for the carrier.
//!
//! Cost O(n). No allocation, no panic, no branch on values.

use super::drive_torque::transmission_error;
use super::moving::Moving;
use super::tree::{RootMotion, Tree, entry, first, store_first, turns};
use super::{Acceleration, External, Inverse, State};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Body, Drive, JointKind, Model, SizeError};
use crate::spatial::{Force, Motion, Turn, Vec3};

/// What the algorithm keeps for one body during a call.
#[derive(Clone, Copy, Debug)]
pub struct RneaScratch<T> {
    /// Sine and cosine of the joint's angle.
    theta: Turn<T>,
    /// Force the body needs.
    f: Force<T>,
    /// Couple that its rotor needs of its carrier.
    couple: Vec3<T>,
    /// Torque the rotor needs of its motor, reflected, besides what the transmission passes on.
    on_rotor: T,
    /// Motion, of a body that others than the next refer to.
    moving: Moving<T>,
}

impl<T: Scalar> RneaScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self {
            theta: Turn::none(),
            f: Force::zero(),
            couple: Vec3::zero(),
            on_rotor: T::zero(),
            moving: Moving::at_rest(),
        }
    }
}

impl<T: Scalar> Default for RneaScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Torques that make the robot, at the given state, accelerate as asked.
///
/// `tau_j` is what the transmission must exert on the joint: inertia, gravity and link-side friction, less the external loads.
/// `tau` is what the motor must: `(1 − e') τ_J` plus rotor inertia, gyroscopic coupling and motor-side friction, reflected.
/// The two differ only where a joint has a drive; for a floating root both are the wrench on it in its own frame.
/// `scratch` has one record per body.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn rnea<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    accel: Acceleration<T>,
    ext: External<T>,
    scratch: &mut [RneaScratch<T>],
    out: Inverse<T>,
) -> Result<(), SizeError> {
    T::dispatch(Rnea { model, state: &state, accel: &accel, ext: &ext, scratch, out: &mut { out } })
}

struct Rnea<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    state: &'a State<'a, T>,
    accel: &'a Acceleration<'a, T>,
    ext: &'a External<'a, T>,
    scratch: &'a mut [RneaScratch<T>],
    out: &'a mut Inverse<'a, T>,
}

impl<T: Scalar> Kernel<T> for Rnea<'_, '_, T> {
    type Output = Result<(), SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<(), SizeError> {
        if self.model.revolute { self.passes::<F, true>() } else { self.passes::<F, false>() }
    }
}

impl<T: Scalar> Rnea<'_, '_, T> {
    /// `REVOLUTE` says that all joints are.
    #[inline(always)]
    fn passes<F: Over<T>, const REVOLUTE: bool>(self) -> Result<(), SizeError> {
        let Self { model, state, accel, ext, scratch, out } = self;
        let tree = Tree::of(model);
        let (joints, n) = (tree.joints, tree.joints.len());
        let kind = |body: &Body<T::Param>| if REVOLUTE { JointKind::Revolute } else { body.joint };
        let (q, qd) = (tree.positions(state.q)?, tree.velocities("qd", state.qd)?);
        let (theta, thetad) = (tree.velocities("theta", state.theta)?, tree.velocities("thetad", state.thetad)?);
        let (qdd, thetadd) = (tree.velocities("qdd", accel.qdd)?, tree.velocities("thetadd", accel.thetadd)?);
        let (wrenches, tau_ext) = tree.external(ext)?;
        let (_, scratch) = tree.bodies_mut("scratch", scratch)?;
        let (root_tau_j, tau_j) = tree.velocities_mut("tau_j", out.tau_j)?;
        let (root_tau, tau) = tree.velocities_mut("tau", out.tau)?;
        turns::<T, F, _>(joints, q, scratch, |body, q| body.angle_as(kind(body), q), |s, theta| s.theta = theta);

        // The base: at rest, or the root with its own equation.
        let lift = -model.gravity.map(F::from_param);
        let mut base = Moving { accel: Motion { ang: Vec3::zero(), lin: lift }, ..Moving::at_rest() };
        let mut base_force = Force::zero();
        if let Some(root) = tree.root {
            let at = RootMotion::of(state.q, state.qd);
            // From the spatial to the classical acceleration: + ω × v
            let asked = Motion::from(first::<T, F, 6>(accel.qdd));
            let lin = at.v.ang.cross_plus(at.v.lin, asked.lin) + at.rot * lift;
            base = Moving::new(at.v.ang, Motion { ang: asked.ang, lin });
            base_force = base.force_on(base.field(), &root.inertia);
            if let Some(wrench) = ext.wrenches.first() {
                base_force -= root.frame.map(F::from_param).inv_force(wrench.map(F::load));
            }
        }

        let at_body = |b: Option<u16>, scratch: &[RneaScratch<T>]| {
            tree.joint(b).and_then(|b| scratch.get(b)).map_or(base, |s| s.moving.map(F::load))
        };

        // Pass 1, base to tips: motion, and the force each body needs. `previous` accelerates as the body before does where the
        // next joint of its chain sits.
        let mut previous = base;
        for i in 0..n {
            let body = &joints[i];
            let (qd, qdd) = (F::load(qd[i]), F::load(qdd[i]));
            let x = body.across_as(kind(body), scratch[i].theta.map(F::load), entry(q, i));
            let (parent, turned) = match body.branch() {
                None => (previous, previous),
                Some(branch) => {
                    let parent = at_body(body.parent, scratch);
                    let turned = parent.turned(branch.turn);
                    (parent, turned.at(turned.field(), branch.shift + x.offset()))
                }
            };
            let moving = turned.across(&x, kind(body), qd, qdd);
            let field = moving.field();

            // f = m a + α × h + ω × (ω × h) − f_ext,   n = I α + ω × I ω + h × a − n_ext
            let mut f = moving.force_on(field, &body.inertia);
            if let Some(wrench) = wrenches.and_then(|wrenches| wrenches.get(i)) {
                f -= body.frame.map(F::from_param).inv_force(wrench.map(F::load));
            }
            scratch[i].f = f.map(F::store);

            // Rotor: N ḣ = B θ̈ + N J n·α for its motor, and the couple ḣ n + ω × h n on its carrier
            if let Some(Drive { rotor, elastic }) = &body.drive {
                let (thetad, thetadd) = match elastic {
                    Some(_) => (F::load(thetad[i]), F::load(thetadd[i])),
                    None => (qd, qdd),
                };
                let own = F::from_param(rotor.reflected_inertia).mul_add(thetadd, rotor.reflected_friction(thetad));
                let beside = rotor.mount == body.parent;
                let carrier = if beside { parent } else { at_body(rotor.mount, scratch) };
                let (omega, alpha) = (carrier.omega, carrier.accel.ang);
                let (h, h_dot) = match elastic {
                    Some(_) => (rotor.axial_momentum(thetad, omega), rotor.axial_momentum(thetadd, alpha)),
                    None => (rotor.axial_momentum(thetad, Vec3::zero()), rotor.axial_momentum(thetadd, Vec3::zero())),
                };
                let axis = rotor.axis_in::<F>();
                let couple = omega.cross_plus(axis.scale(h), axis.scale(h_dot));
                scratch[i].on_rotor = (own + rotor.coupling::<F>().dot(alpha)).store();
                scratch[i].couple = couple.map(F::store);
                if !beside {
                    match tree.joint(rotor.mount).and_then(|b| scratch.get_mut(b)) {
                        Some(carrier) => carrier.f.ang = (carrier.f.ang.map(F::load) + couple).map(F::store),
                        None => base_force.ang += couple,
                    }
                }
            }
            if body.shared {
                scratch[i].moving = moving.map(F::store);
            }
            previous = match joints.get(i + 1) {
                Some(next) if next.placement.branch.is_none() => {
                    moving.at(field, next.across_as(kind(next), Turn::none(), entry(q, i + 1)).offset())
                }
                _ => moving,
            };
        }

        // Pass 2, tips to base: forces across the joints.
        let mut incoming = Force::zero();
        for i in (0..n).rev() {
            let (Some(body), Some(s)) = (joints.get(i), scratch.get(i)) else { break };
            let f = s.f.map(F::load) + incoming;

            // τ_J = Sᵀ f + f_l(q̇) − τ_ext,   τ = (1 − e') τ_J + N ḣ + N f_m
            let mut joint = kind(body).along(f) + body.friction.torque(entry::<T, F>(qd, i));
            if let Some(tau_ext) = tau_ext {
                joint -= entry::<T, F>(tau_ext, i);
            }
            let mut motor = joint;
            if let Some(Drive { rotor, elastic }) = &body.drive {
                if let Some(elastic) = elastic {
                    motor = (F::one() - transmission_error(elastic, rotor, entry(theta, i)).1) * joint;
                }
                motor += F::load(s.on_rotor);
            }
            let (Some(on_joint), Some(on_motor)) = (tau_j.get_mut(i), tau.get_mut(i)) else { break };
            (*on_joint, *on_motor) = (joint.store(), motor.store());

            // f_p += Xᵀ f and the rotor's couple; the fixed world bears whatever comes
            incoming = Force::zero();
            if body.parent.is_none() {
                continue;
            }
            let x = body.across_as(kind(body), s.theta.map(F::load), entry(q, i));
            let mut on_parent = x.inv_force(f);
            if let Some(branch) = body.branch() {
                on_parent = branch.inv_force(on_parent);
            }
            if body.carrier() == body.parent {
                on_parent.ang += s.couple.map(F::load);
            }
            if body.placement.branch.is_none() {
                incoming = on_parent;
            } else {
                match tree.joint(body.parent).and_then(|p| scratch.get_mut(p)) {
                    Some(parent) => parent.f = (parent.f.map(F::load) + on_parent).map(F::store),
                    None => base_force += on_parent,
                }
            }
        }

        if tree.root.is_some() {
            let wrench = base_force - Force::from(first::<T, F, 6>(ext.tau));
            store_first(root_tau_j, wrench.to_array());
            store_first(root_tau, wrench.to_array());
        }
        Ok(())
    }
}
