//! The passes over the bodies.

use super::super::at_base::{add, carrier, hand_on, load_carrier, outward, set, spin, subtract_wrenches, unit};
use super::super::drive_torque::{JointState, drives, sensitivity};
use super::super::pairs::{Entries, OnCarrier, for_each_carrying, for_each_inertia, for_each_pair};
use super::super::{DerivativeScratch, External, Forward, State};
use super::ForwardDerivatives;
use super::stride;
use crate::Scalar;
use crate::dispatch::Over;
use crate::model::{Drive, JointKind, Model, Rotor, SizeError};
use crate::spatial::{Mat3, Motion, Vec3};

/// Arguments, results and the parts of the matrix that the algorithm works in.
pub(super) struct Passes<'a, 'm, T: Scalar> {
    pub(super) model: &'a Model<'m, T::Param>,
    pub(super) state: State<'a, T>,
    pub(super) tau: &'a [T],
    pub(super) ext: External<'a, T>,
    pub(super) scratch: &'a mut [DerivativeScratch<T>],
    /// `M`, below and on the diagonal, in rows of [`stride`] entries.
    pub(super) m: &'a mut [T],
    /// `M⁻¹`, in the same rows.
    pub(super) inverse: &'a mut [T],
    /// `−R`.
    pub(super) r: &'a mut [T],
    /// `M ∂q̈`, in rows of `5 nv` entries.
    pub(super) rhs: &'a mut [T],
    /// What is left to accelerate the joints: `M q̈`.
    pub(super) left: &'a mut [T],
    pub(super) pivots: &'a mut [T],
    pub(super) value: Forward<'a, T>,
    pub(super) out: ForwardDerivatives<'a, T>,
}

/// State of one joint of one degree of freedom.
#[inline(always)]
fn joint<T: Scalar, F: Over<T>>(state: &State<T>, k: usize, q: usize) -> JointState<F> {
    JointState {
        q: F::load(state.q[q]),
        qd: F::load(state.qd[k]),
        theta: F::load(state.theta[k]),
        thetad: F::load(state.thetad[k]),
    }
}

impl<T: Scalar> Passes<'_, '_, T> {
    /// Base to tips, at `q̈ = 0`: motion and forces, then torques at the joints and couples of the rotors.
    #[inline(always)]
    pub(super) fn without_accelerations<F: Over<T>>(&mut self) -> Result<(), SizeError> {
        let (model, state, tau, ext) = (self.model, self.state, self.tau, self.ext);
        let (scratch, rhs, left) = (&mut *self.scratch, &mut *self.rhs, &mut *self.left);
        let (thetadd, tau_j) = (&mut *self.value.thetadd, &mut *self.value.tau_j);
        let nv = model.nv;
        let load = |k: usize| ext.tau.get(k).map_or(F::zero(), |tau| F::load(*tau));
        outward::<T, F, false>(
            model,
            state.q,
            |k| F::load(state.qd[k]),
            |_| F::zero(),
            |body| body.inertia.map(F::from_param),
            scratch,
        )?;
        subtract_wrenches::<T, F>(model, ext.wrenches, scratch);
        for body in model.bodies {
            let k = body.v_index();
            if body.joint == JointKind::Floating {
                for k in k..k + 6 {
                    left[k] = (F::load(tau[k]) + load(k)).store();
                    tau_j[k] = tau[k];
                    add(rhs, (5 * k + 4) * nv + k, F::one());
                }
                continue;
            }
            let at = joint(&state, k, body.q_index());
            let known = drives(body, at, F::load(tau[k]), load(k), model.knots);
            (left[k], thetadd[k], tau_j[k]) = (known.on_link.store(), known.on_rotor.store(), known.tau_j.store());
            let Some(Drive { rotor, elastic }) = &body.drive else { continue };
            let Some((on, omega, n)) = carrier::<T, F>(rotor, scratch) else { continue };
            // Couple h ω × n + (r/N) n; by ω it changes with −h n×, and, J n nᵀ not being in the carrier's inertia, J (ω × n) nᵀ
            let across = omega.cross(n);
            let (mut h, mut couple, mut turning) = (spin::<T, F>(rotor) * at.qd, Vec3::zero(), Mat3::zero());
            if elastic.is_some() {
                let j = F::from_param(rotor.inertia);
                h = spin::<T, F>(rotor).mul_add(at.thetad, j * n.dot(omega));
                couple = n.scale(known.on_rotor * F::from_param(rotor.inv_gear_ratio));
                turning = Mat3::outer(across.scale(j), n);
            }
            load_carrier(scratch, on, couple.plus_scaled(h, across), turning + Mat3::skew(n.scale(-h)));
        }
        Ok(())
    }

    /// Tips to base: composites, `M`, and what is left to accelerate the joints.
    #[inline(always)]
    pub(super) fn composites<F: Over<T>>(&mut self) {
        let (model, scratch, m, left) = (self.model, &mut *self.scratch, &mut *self.m, &mut *self.left);
        let nv = model.nv;
        for (i, body) in model.bodies.iter().enumerate().rev() {
            let (s, k) = (&mut scratch[i], body.v_index());
            let (inertia, force) = (s.inertia.map(F::load), s.f.map(F::load));
            if body.joint == JointKind::Floating {
                for c in 0..6 {
                    let column = inertia.momentum(unit::<F>(c)).to_array();
                    for (r, entry) in column.into_iter().enumerate() {
                        set(m, (k + r) * stride(nv) + k + c, entry);
                    }
                    left[k + c] = (F::load(left[k + c]) - force.to_array()[c]).store();
                }
                continue;
            }
            let axis = s.axis.map(F::load);
            s.column = inertia.momentum(axis).map(F::store);
            let mut accelerating = F::load(left[k]) - axis.dot(force);
            for_each_inertia(
                model,
                scratch,
                i,
                #[inline(always)]
                |column, entry: F| set(m, k * stride(nv) + column, entry),
            );
            if let Some(rotor) = body.rigid_rotor()
                && let Some(at) = carrier::<T, F>(rotor, scratch)
            {
                let spin = spin::<T, F>(rotor);
                accelerating -= spin * at.2.dot(scratch[at.0].a.ang.map(F::load));
                for_each_carrying(
                    model,
                    scratch,
                    at,
                    #[inline(always)]
                    |on: OnCarrier<F>| add(m, k * stride(nv) + on.column, spin * on.speed),
                );
            }
            add(m, k * stride(nv) + k, body.rigid_reflected_inertia::<F>());
            left[k] = accelerating.store();
            hand_on::<T, F>(body, i, scratch);
        }
    }

    /// Base to tips: `q̈ = M⁻¹ (M q̈)`, accelerations, `ψ̈`, and what they add to the forces: `Iᶜ Δa`, and `Iᶜ S q̈` of the joints
    /// beyond.
    #[inline(always)]
    pub(super) fn accelerate<F: Over<T>>(&mut self) {
        let (model, state, scratch) = (self.model, self.state, &mut *self.scratch);
        let (inverse, left, qdd) = (&*self.inverse, &*self.left, &mut *self.value.qdd);
        let nv = model.nv;
        for (qdd, row) in qdd.iter_mut().zip(inverse.chunks_exact(stride(nv).max(1))) {
            let products = row.iter().zip(left.iter());
            *qdd = products.fold(F::zero(), |sum, (m, left)| F::load(*m).mul_add(F::load(*left), sum)).store();
        }
        for (i, body) in model.bodies.iter().enumerate() {
            let s = &scratch[i];
            let k = body.v_index();
            let inertia = s.inertia.map(F::load);
            let before = s.a.map(F::load);
            let a;
            if body.joint == JointKind::Floating {
                a = before + Motion::from([0, 1, 2, 3, 4, 5].map(|c| F::load(qdd[k + c])));
            } else {
                let (axis, rate) = (s.axis.map(F::load), s.axis_rate.map(F::load));
                let (v_p, a_p) = match body.parent().and_then(|p| scratch.get(p)) {
                    Some(p) => (p.v.map(F::load), p.a.map(F::load)),
                    None => (Motion::zero(), Motion { ang: Vec3::zero(), lin: -model.gravity.map(F::from_param) }),
                };
                a = a_p + rate.scale(F::load(state.qd[k])) + axis.scale(F::load(qdd[k]));
                scratch[i].axis_acceleration = (a_p.cross(axis) + v_p.cross(rate)).map(F::store);
            }
            scratch[i].a = a.map(F::store);
            scratch[i].add_force(inertia.momentum(a - before));
        }
    }

    /// Tips to base: `M ∂q̈` and `R`, and what of `∂θ̈` does not come with `∂q̈`: `∂r/B − ∂(n·α)/N`.
    #[inline(always)]
    pub(super) fn right_hand_sides<F: Over<T>>(&mut self) {
        let (model, state, scratch, qdd) = (self.model, self.state, &mut *self.scratch, &*self.value.qdd);
        let (r, rhs, d_thetadd) = (&mut *self.r, &mut *self.rhs, &mut *self.out.thetadd);
        let (nv, width) = (model.nv, 5 * model.nv);
        let [q, qd, theta, thetad, tau] = [0, 1, 2, 3, 4].map(|block| block * nv);
        for (i, body) in model.bodies.iter().enumerate().rev() {
            let (k, s) = (body.v_index(), &mut scratch[i]);
            let mut beyond = s.beyond.map(F::load);
            s.add_force(beyond);
            for_each_pair(
                model,
                scratch,
                i,
                #[inline(always)]
                |at: Entries<F>| {
                    set(rhs, at.row * width + q + at.column, -at.q);
                    set(rhs, at.row * width + qd + at.column, -at.qd);
                },
            );
            if body.joint == JointKind::Floating {
                continue;
            }
            let acceleration = F::load(qdd[k]);
            beyond = beyond.plus_scaled(acceleration, scratch[i].column.map(F::load));
            if let Some(p) = body.parent().and_then(|p| scratch.get_mut(p)) {
                p.beyond = (p.beyond.map(F::load) + beyond).map(F::store);
            }
            let by = sensitivity(body, joint::<T, F>(&state, k, body.q_index()), model.knots);
            for (block, on_link) in by.on_link.into_iter().enumerate() {
                add(rhs, k * width + block * nv + k, on_link);
            }
            let Some(Drive { rotor, elastic }) = &body.drive else { continue };
            if elastic.is_some() {
                for (block, on_rotor) in by.on_rotor.into_iter().enumerate() {
                    let by_torque = F::from_param(rotor.inv_reflected_inertia);
                    set(d_thetadd, k * width + block * nv + k, by_torque * on_rotor);
                }
            }
            let Some(at) = carrier::<T, F>(rotor, scratch) else { continue };
            let spin = spin::<T, F>(rotor);
            if elastic.is_some() {
                let by_speed = F::from_param(rotor.inv_gear_ratio);
                for_each_carrying(
                    model,
                    scratch,
                    at,
                    #[inline(always)]
                    |on: OnCarrier<F>| {
                        let (turned, at) = (-(by_speed * on.speed), on.column * width + k);
                        set(r, on.column * nv + k, turned);
                        let [by_q, by_qd, by_theta, by_thetad, by_tau] = by.on_rotor.map(|by| turned * by);
                        add(rhs, at + q, by_q);
                        add(rhs, at + qd, by_qd);
                        set(rhs, at + theta, by_theta);
                        set(rhs, at + thetad, by_thetad - spin * on.across);
                        set(rhs, at + tau, by_tau);
                        set(d_thetadd, k * width + q + on.column, -(by_speed * on.q));
                        set(d_thetadd, k * width + qd + on.column, -(by_speed * on.qd));
                    },
                );
                continue;
            }
            let on = &mut scratch[at.0].beyond;
            on.ang = on.ang.map(F::load).plus_scaled(spin * acceleration, at.2).map(F::store);
            for_each_carrying(
                model,
                scratch,
                at,
                #[inline(always)]
                |on: OnCarrier<F>| {
                    add(rhs, on.column * width + qd + k, -(spin * on.across));
                    add(rhs, k * width + q + on.column, -(spin * on.q));
                    add(rhs, k * width + qd + on.column, -(spin * on.qd));
                },
            );
        }
    }

    /// Nothing depends on `θ` and `θ̇`, and all of `τ` acts on the links.
    pub(super) fn without_elastic_joints(&mut self) {
        let nv = self.model.nv;
        let rows = self.out.qdd.chunks_exact_mut((5 * nv).max(1));
        for (row, inverse) in rows.zip(self.inverse.chunks_exact(stride(nv).max(1))) {
            let (by_motor, by_tau) = row[2 * nv..].split_at_mut(2 * nv);
            by_motor.fill(T::zero());
            by_tau.copy_from_slice(&inverse[..nv]);
        }
    }

    /// `θ̈ = r/B − n·α/N`. With rigid gears: that of the joint, and `τ_J` less what the rotor takes.
    #[inline(always)]
    pub(super) fn rotors<F: Over<T>>(&mut self) {
        let (model, scratch, width) = (self.model, &*self.scratch, 5 * self.model.nv);
        let Forward { qdd, thetadd, tau_j } = &mut self.value;
        let (d_qdd, d_thetadd) = (&*self.out.qdd, &mut *self.out.thetadd);
        for body in model.bodies {
            let k = body.v_index();
            let Some(Drive { rotor, .. }) = body.drive.as_ref().filter(|drive| drive.elastic.is_some()) else {
                let rows = k * width..(k + body.joint.nv()) * width;
                d_thetadd[rows.clone()].copy_from_slice(&d_qdd[rows]);
                thetadd[k..k + body.joint.nv()].copy_from_slice(&qdd[k..k + body.joint.nv()]);
                if let Some(rotor) = body.rigid_rotor() {
                    let own = F::from_param(rotor.reflected_inertia) * F::load(qdd[k]);
                    let taken = spin::<T, F>(rotor).mul_add(at_carrier(rotor, scratch), own);
                    tau_j[k] = (F::load(tau_j[k]) - taken).store();
                }
                continue;
            };
            let (by_torque, by_speed) =
                (F::from_param(rotor.inv_reflected_inertia), F::from_param(rotor.inv_gear_ratio));
            thetadd[k] = (F::load(thetadd[k]) * by_torque - at_carrier::<T, F>(rotor, scratch) * by_speed).store();
        }
    }
}

/// `n·α` of a rotor's carrier; zero on the fixed world.
#[inline(always)]
fn at_carrier<T: Scalar, F: Over<T>>(rotor: &Rotor<T::Param>, scratch: &[DerivativeScratch<T>]) -> F {
    carrier::<T, F>(rotor, scratch).map_or(F::zero(), |(m, _, n)| n.dot(scratch[m].a.ang.map(F::load)))
}
