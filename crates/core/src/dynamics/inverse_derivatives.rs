//! First derivatives of inverse dynamics, by the sensitivities of [`super::at_base`].
//!
//! A rotor at rest is part of its carrier's inertia; what turning adds is the couple `N J (θ̈ n + θ̇ ω × n)`, and the torque
//! `B θ̈ + N J n·α` for its motor (PHYSICS §3). Behind a rigid gear `θ` is `q`, and those columns are added to it.
//!
//! Cost O(n·depth). No allocation, no branch on values.

use super::at_base::{DerivativeScratch, add, carrier, hand_on, load_carrier, outward, spin, subtract_wrenches};
use super::drive_torque::transmission_error;
use super::pairs::{Entries, OnCarrier, for_each_carrying, for_each_pair};
use super::{Acceleration, External, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Drive, JointKind, Model, SizeError};
use crate::spatial::Mat3;

/// What [`inverse_derivatives`] writes: matrices of `nv` rows and `6 nv` columns by rows, one block of `nv` columns after the other
/// for the derivatives with respect to `q, q̇, q̈, θ, θ̇, θ̈`. Derivatives with respect to the pose of a floating root are with
/// respect to a small motion of it in its own frame, angular first.
#[derive(Debug)]
pub struct InverseDerivatives<'a, T> {
    /// Of the torque that the transmission must exert on the joint.
    pub tau_j: &'a mut [T],
    /// Of the torque that the motor must exert, reflected to the link side.
    pub tau: &'a mut [T],
}

/// How the torques of [`super::rnea`] change with the motion that is asked for. Loads from outside keep their coordinates: wrenches
/// turn with their links. `scratch` has one record per body.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn inverse_derivatives<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    accel: Acceleration<T>,
    ext: External<T>,
    scratch: &mut [DerivativeScratch<T>],
    out: InverseDerivatives<T>,
) -> Result<(), SizeError> {
    check_state(model, &state)?;
    check_external(model, &ext)?;
    check_scratch(model, scratch)?;
    SizeError::check("qdd", accel.qdd.len(), model.nv)?;
    SizeError::check("thetadd", accel.thetadd.len(), model.nv)?;
    SizeError::check("tau_j", out.tau_j.len(), 6 * model.nv * model.nv)?;
    SizeError::check("tau", out.tau.len(), 6 * model.nv * model.nv)?;
    T::dispatch(Sensitivities { model, state, accel, ext, scratch, out })
}

struct Sensitivities<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    state: State<'a, T>,
    accel: Acceleration<'a, T>,
    ext: External<'a, T>,
    scratch: &'a mut [DerivativeScratch<T>],
    out: InverseDerivatives<'a, T>,
}

impl<T: Scalar> Kernel<T> for Sensitivities<'_, '_, T> {
    type Output = Result<(), SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<(), SizeError> {
        let Self { model, state, accel, ext, scratch, out } = self;
        let InverseDerivatives { tau_j, tau } = out;
        let (bodies, nv) = (model.bodies, model.nv);
        let width = 6 * nv;
        let [q, qd, qdd, theta, thetad, thetadd] = [0, 1, 2, 3, 4, 5].map(|block| block * nv);
        tau_j.fill(T::zero());
        tau.fill(T::zero());

        // Pass 1, base to tips: motion and forces, then the rotors' couples on their carriers.
        outward::<T, F, true>(
            model,
            state.q,
            |k| F::load(state.qd[k]),
            |k| F::load(accel.qdd[k]),
            |body| body.inertia_with_rotors::<F>(),
            scratch,
        )?;
        subtract_wrenches::<T, F>(model, ext.wrenches, scratch);
        for body in bodies {
            let (k, Some(Drive { rotor, elastic })) = (body.v_index(), &body.drive) else { continue };
            let (speed, acceleration) = match elastic {
                Some(_) => (F::load(state.thetad[k]), F::load(accel.thetadd[k])),
                None => (F::load(state.qd[k]), F::load(accel.qdd[k])),
            };
            let Some((m, omega, n)) = carrier(rotor, scratch) else { continue };
            let spin = spin::<T, F>(rotor);
            let h = spin * speed;
            let couple = omega.cross(n).scale(h).plus_scaled(spin * acceleration, n);
            load_carrier(scratch, m, couple, Mat3::skew(n.scale(-h)));
        }

        // Pass 2, tips to base: every pair of joints on one way to the base.
        for (i, body) in bodies.iter().enumerate().rev() {
            let s = &mut scratch[i];
            s.column = s.inertia.map(F::load).momentum(s.axis.map(F::load)).map(F::store);
            for_each_pair(
                model,
                scratch,
                i,
                #[inline(always)]
                |at: Entries<F>| {
                    let row = at.row * width + at.column;
                    add(tau_j, row + q, at.q);
                    add(tau_j, row + qd, at.qd);
                    add(tau_j, row + qdd, at.qdd);
                },
            );
            hand_on::<T, F>(body, i, scratch);
        }

        // The rotors' couples: h ω × n + ḣ n
        for body in bodies {
            let (k, Some(Drive { rotor, elastic })) = (body.v_index(), &body.drive) else { continue };
            let Some(carrier) = carrier(rotor, scratch) else { continue };
            let spin = spin::<T, F>(rotor);
            let (speed, acceleration) = if elastic.is_some() { (thetad, thetadd) } else { (qd, qdd) };
            for_each_carrying(
                model,
                scratch,
                carrier,
                #[inline(always)]
                |on: OnCarrier<F>| {
                    add(tau_j, on.column * width + speed + k, spin * on.across);
                    add(tau_j, on.column * width + acceleration + k, spin * on.speed);
                },
            );
        }

        // τ = (1 − e') τ_J + B θ̈ + N J n·α + N f_m
        for (body, s) in bodies.iter().zip(scratch.iter()) {
            let k = body.v_index();
            let rows = k * width..(k + body.joint.nv()) * width;
            if body.joint == JointKind::Floating {
                tau[rows.clone()].copy_from_slice(&tau_j[rows]);
                continue;
            }
            let velocity = F::load(state.qd[k]);
            add(tau_j, k * width + qd + k, body.friction.slope(velocity));
            let own = k * width + k;
            let Some(Drive { rotor, elastic }) = &body.drive else {
                tau[rows.clone()].copy_from_slice(&tau_j[rows]);
                continue;
            };
            let (mut share, mut speed, mut acceleration, mut motor) = (F::one(), qd, qdd, velocity);
            if let Some(elastic) = elastic {
                let position = F::load(state.theta[k]);
                let (e, slope) = transmission_error(elastic, rotor, position);
                let load = ext.tau.get(k).map_or(F::zero(), |tau| F::load(*tau));
                let torque = s.axis.map(F::load).dot(s.f.map(F::load)) + body.friction.torque(velocity) - load;
                let curvature = elastic.error.map_or(F::zero(), |at| at.curvature(e, F::from_param(rotor.gear_ratio)));
                add(tau, own + theta, -(curvature * torque));
                (share, speed, acceleration, motor) = (F::one() - slope, thetad, thetadd, F::load(state.thetad[k]));
            }
            for (to, from) in tau[rows.clone()].iter_mut().zip(&tau_j[rows]) {
                *to = share.mul_add(F::load(*from), F::load(*to)).store();
            }
            add(tau, own + speed, rotor.reflected_friction_slope(motor));
            add(tau, own + acceleration, F::from_param(rotor.reflected_inertia));
            if let Some(carrier) = carrier(rotor, scratch) {
                let spin = spin::<T, F>(rotor);
                for_each_carrying(
                    model,
                    scratch,
                    carrier,
                    #[inline(always)]
                    |on: OnCarrier<F>| {
                        let row = k * width + on.column;
                        add(tau, row + q, spin * on.q);
                        add(tau, row + qd, spin * on.qd);
                        add(tau, row + qdd, spin * on.speed);
                    },
                );
            }
        }
        Ok(())
    }
}
