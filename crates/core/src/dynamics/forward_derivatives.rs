//! Forward dynamics with its first derivatives.
//!
//! The links obey `M q̈ + b(q, q̇, θ̇, r) = τ_J − friction + τ_ext` when elastic rotors are eliminated (PHYSICS §3), `r` being the net
//! torque on a rotor, and a rotor follows with `θ̈ = r/B − n·α/N`. So
//!
//! ```text
//! M ∂q̈ = ∂(τ_J − friction) − ∂(M q̈ + b) − R ∂r,    R_ij = S_i·n_j / N_j
//! ∂θ̈   = ∂r / B − ∂(n·α) / N − Rᵀ ∂q̈
//! ```
//!
//! where `∂(M q̈ + b)` are the sensitivities of [`super::at_base`] at the `q̈` found. With rigid gears the rotors' inertia is in `M` and
//! their columns belong to `q̇` and `q̈`. `M = Lᵀ D L` is factorised along the branches, and solved for all columns at once.
//!
//! Cost O(n·depth) for the sensitivities and for each column of the solution. No allocation, no branch on values.

use super::at_base::{
    DerivativeScratch, Entries, OnCarrier, add, carrier, for_each_carrying, for_each_inertia, for_each_pair, hand_on,
    load_carrier, outward, spin, subtract_wrenches, unit,
};
use super::branches::{factorise, solve, subtract, supporting};
use super::drive_torque::{JointState, drives, sensitivity};
use super::{External, Forward, State, check_external, check_scratch, check_state};
use crate::Scalar;
use crate::dispatch::{Kernel, Over};
use crate::model::{Drive, JointKind, Model, Rotor, SizeError};
use crate::spatial::{Mat3, Motion, Vec3};

/// What [`forward_derivatives`] writes: matrices of `nv` rows and `5 nv` columns by rows, one block of `nv` columns after the other
/// for the derivatives with respect to `q, q̇, θ, θ̇, τ`. Derivatives with respect to the pose of a floating root are with respect to
/// a small motion of it in its own frame, angular first. Columns of `θ` and `θ̇` are zero at joints without an elastic transmission.
#[derive(Debug)]
pub struct ForwardDerivatives<'a, T> {
    /// Of the joint accelerations.
    pub qdd: &'a mut [T],
    /// Of the reflected motor accelerations; those of `qdd` where there is no elastic transmission.
    pub thetadd: &'a mut [T],
}

/// Entries of the matrix that [`forward_derivatives`] works in.
pub fn derivative_matrix_len<P: Scalar>(model: &Model<P>) -> usize {
    (2 * model.nv + 10) * model.nv
}

/// The accelerations of [`super::forward_dynamics`] and how they change with state and motor torques, in all four models. Loads from
/// outside keep their coordinates: wrenches turn with their links. `scratch` has one record per body, `matrix`
/// [`derivative_matrix_len`] entries.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
#[expect(clippy::too_many_arguments)]
pub fn forward_derivatives<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    tau: &[T],
    ext: External<T>,
    scratch: &mut [DerivativeScratch<T>],
    matrix: &mut [T],
    value: Forward<T>,
    out: ForwardDerivatives<T>,
) -> Result<(), SizeError> {
    check_state(model, &state)?;
    check_external(model, &ext)?;
    check_scratch(model, scratch)?;
    value.check(model, tau)?;
    SizeError::check("matrix", matrix.len(), derivative_matrix_len(model))?;
    SizeError::check("derivatives of qdd", out.qdd.len(), 5 * model.nv * model.nv)?;
    SizeError::check("derivatives of thetadd", out.thetadd.len(), 5 * model.nv * model.nv)?;
    T::dispatch(Sensitivities { model, state, tau, ext, scratch, matrix, value, out })
}

struct Sensitivities<'a, 'm, T: Scalar> {
    model: &'a Model<'m, T::Param>,
    state: State<'a, T>,
    tau: &'a [T],
    ext: External<'a, T>,
    scratch: &'a mut [DerivativeScratch<T>],
    matrix: &'a mut [T],
    value: Forward<'a, T>,
    out: ForwardDerivatives<'a, T>,
}

impl<T: Scalar> Kernel<T> for Sensitivities<'_, '_, T> {
    type Output = Result<(), SizeError>;

    #[inline(always)]
    fn run<F: Over<T>>(self) -> Result<(), SizeError> {
        let Self { model, state, tau, ext, scratch, matrix, value, out } = self;
        let (Forward { qdd, thetadd, tau_j }, ForwardDerivatives { qdd: d_qdd, thetadd: d_thetadd }) = (value, out);
        let (bodies, nv) = (model.bodies, model.nv);
        let width = 5 * nv;
        let [q, qd, theta, thetad, tau_at] = [0, 1, 2, 3, 4].map(|block| block * nv);
        let (m, rest) = matrix.split_at_mut(nv * nv);
        let (r, local) = rest.split_at_mut(nv * nv);
        let (on_link, on_rotor) = local.split_at_mut(5 * nv);
        for all in [&mut *m, &mut *r, &mut *on_link, &mut *on_rotor, &mut *d_qdd, &mut *d_thetadd] {
            all.fill(T::zero());
        }
        let load = |k: usize| ext.tau.get(k).map_or(F::zero(), |tau| F::load(*tau));
        let joint = |k: usize, q: usize| JointState {
            q: F::load(state.q[q]),
            qd: F::load(state.qd[k]),
            theta: F::load(state.theta[k]),
            thetad: F::load(state.thetad[k]),
        };

        // Pass 1, base to tips, at q̈ = 0: motion and forces, then torques at the joints and couples of the rotors.
        outward(
            model,
            state.q,
            |k| F::load(state.qd[k]),
            |_| F::zero(),
            |body| body.inertia.map(F::from_param),
            scratch,
        )?;
        subtract_wrenches::<T, F>(model, ext.wrenches, scratch);
        for body in bodies {
            let k = body.v_index();
            if body.joint == JointKind::Floating {
                for k in k..k + 6 {
                    qdd[k] = (F::load(tau[k]) + load(k)).store();
                    tau_j[k] = tau[k];
                }
                continue;
            }
            let at = joint(k, body.q_index());
            let known = drives(body, at, F::load(tau[k]), load(k), model.knots);
            (qdd[k], thetadd[k], tau_j[k]) = (known.on_link.store(), known.on_rotor.store(), known.tau_j.store());
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

        // Pass 2, tips to base: composites, M, R, and what is left to accelerate the joints.
        for (i, body) in bodies.iter().enumerate().rev() {
            let (s, k) = (&mut scratch[i], body.v_index());
            let (inertia, force) = (s.inertia.map(F::load), s.f.map(F::load));
            if body.joint == JointKind::Floating {
                for c in 0..6 {
                    let column = inertia.momentum(unit::<F>(c)).to_array();
                    for (r, entry) in column.into_iter().enumerate() {
                        m[(k + r) * nv + k + c] = entry.store();
                    }
                    qdd[k + c] = (F::load(qdd[k + c]) - force.to_array()[c]).store();
                }
                continue;
            }
            let axis = s.axis.map(F::load);
            s.column = inertia.momentum(axis).map(F::store);
            let mut left = F::load(qdd[k]) - axis.dot(force);
            for_each_inertia(
                model,
                scratch,
                i,
                #[inline(always)]
                |column, entry: F| add(m, k * nv + column, entry),
            );
            if let Some(Drive { rotor, elastic }) = &body.drive
                && let Some(at) = carrier::<T, F>(rotor, scratch)
            {
                let spin = spin::<T, F>(rotor);
                let by_torque = F::from_param(rotor.inv_gear_ratio);
                if elastic.is_none() {
                    left -= spin * at.2.dot(scratch[at.0].a.ang.map(F::load));
                }
                for_each_carrying(
                    model,
                    scratch,
                    at,
                    #[inline(always)]
                    |on: OnCarrier<F>| {
                        if elastic.is_some() {
                            r[on.column * nv + k] = (by_torque * on.speed).store();
                            add(d_qdd, on.column * width + thetad + k, -(spin * on.across));
                        } else {
                            add(m, k * nv + on.column, spin * on.speed);
                        }
                    },
                );
            }
            add(m, k * nv + k, body.rigid_reflected_inertia::<F>());
            qdd[k] = left.store();
            hand_on::<T, F>(body, i, scratch);
        }
        factorise::<T, F>(model, m);
        solve::<T, F>(model, m, qdd, 1);

        // Pass 3, base to tips: accelerations, ψ̈, and what they add to the forces: Iᶜ Δa, and Iᶜ S q̈ of the joints beyond.
        for i in 0..bodies.len() {
            let (body, s) = (&bodies[i], &scratch[i]);
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

        // Pass 4, tips to base: −∂(M q̈ + b), −∂(n·α)/N.
        for (i, body) in bodies.iter().enumerate().rev() {
            let (k, s) = (body.v_index(), &mut scratch[i]);
            let mut beyond = s.beyond.map(F::load);
            s.add_force(beyond);
            for_each_pair(
                model,
                scratch,
                i,
                #[inline(always)]
                |at: Entries<F>| {
                    add(d_qdd, at.row * width + q + at.column, -at.q);
                    add(d_qdd, at.row * width + qd + at.column, -at.qd);
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
            let Some(Drive { rotor, elastic }) = &body.drive else { continue };
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
                        add(d_thetadd, k * width + q + on.column, -(by_speed * on.q));
                        add(d_thetadd, k * width + qd + on.column, -(by_speed * on.qd));
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
                    add(d_qdd, on.column * width + qd + k, -(spin * on.across));
                    add(d_qdd, k * width + q + on.column, -(spin * on.q));
                    add(d_qdd, k * width + qd + on.column, -(spin * on.qd));
                },
            );
        }

        // Solve for −∂(M q̈ + b), in the columns of θ and τ for R and 1: M⁻¹ R = ∂q̈/∂(−r), M⁻¹ = ∂q̈/∂τ_J
        for body in bodies {
            let k = body.v_index();
            if body.joint == JointKind::Floating {
                for k in k..k + 6 {
                    on_link[4 * nv + k] = T::one();
                }
                continue;
            }
            let by = sensitivity(body, joint(k, body.q_index()), model.knots);
            for block in 0..5 {
                on_link[block * nv + k] = by.on_link[block].store();
                on_rotor[block * nv + k] = by.on_rotor[block].store();
            }
        }
        for k in 0..nv {
            let row = &mut d_qdd[k * width..][..width];
            row[theta..theta + nv].copy_from_slice(&r[k * nv..][..nv]);
            row[tau_at + k] = T::one();
        }
        solve::<T, F>(model, m, d_qdd, width);
        // Then ∂q̈ = −M⁻¹ ∂(M q̈ + b) + M⁻¹ ∂(τ_J − friction) − M⁻¹ R ∂r, where what acts on a joint depends on its own coordinates alone.
        for row in d_qdd.chunks_exact_mut(width.max(1)) {
            for k in 0..nv {
                let (by_rotor, by_link) = (F::load(row[theta + k]), F::load(row[tau_at + k]));
                (row[theta + k], row[tau_at + k]) = (T::zero(), T::zero());
                for block in [q, qd, theta, thetad, tau_at] {
                    let entry = &mut row[block + k];
                    let (link, rotor) = (F::load(on_link[block + k]), F::load(on_rotor[block + k]));
                    *entry = (-by_rotor).mul_add(rotor, by_link.mul_add(link, F::load(*entry))).store();
                }
            }
        }

        // ∂θ̈ = … − Rᵀ ∂q̈;   θ̈ = r/B − n·α/N,   rigid: τ_J less what the rotor takes
        for body in bodies {
            let (k, rows) = (body.v_index(), body.v_index() * width..(body.v_index() + body.joint.nv()) * width);
            let Some(Drive { rotor, .. }) = body.drive.as_ref().filter(|drive| drive.elastic.is_some()) else {
                d_thetadd[rows.clone()].copy_from_slice(&d_qdd[rows]);
                for k in k..k + body.joint.nv() {
                    thetadd[k] = qdd[k];
                }
                if let Some(rotor) = body.rigid_rotor() {
                    let alpha = at_carrier::<T, F>(rotor, scratch);
                    let taken =
                        F::from_param(rotor.reflected_inertia).mul_add(F::load(qdd[k]), spin::<T, F>(rotor) * alpha);
                    tau_j[k] = (F::load(tau_j[k]) - taken).store();
                }
                continue;
            };
            let own = F::load(thetadd[k]) * F::from_param(rotor.inv_reflected_inertia);
            thetadd[k] = (own - at_carrier::<T, F>(rotor, scratch) * F::from_param(rotor.inv_gear_ratio)).store();
            for block in 0..5 {
                let own = F::load(on_rotor[block * nv + k]) * F::from_param(rotor.inv_reflected_inertia);
                add(d_thetadd, k * width + block * nv + k, own);
            }
            let mut at = last_coordinate(model, rotor.mount());
            while let Some(p) = at {
                subtract::<T, F>(&mut d_thetadd[rows.clone()], F::load(r[p * nv + k]), &d_qdd[p * width..][..width]);
                at = supporting(model, p);
            }
        }
        Ok(())
    }
}

/// `n·α` of a rotor's carrier; zero on the fixed world.
#[inline(always)]
fn at_carrier<T: Scalar, F: Over<T>>(rotor: &Rotor<T::Param>, scratch: &[DerivativeScratch<T>]) -> F {
    carrier::<T, F>(rotor, scratch).map_or(F::zero(), |(m, _, n)| n.dot(scratch[m].a.ang.map(F::load)))
}

/// The last velocity coordinate of a body's joint.
#[inline(always)]
fn last_coordinate<P: Scalar>(model: &Model<P>, body: Option<usize>) -> Option<usize> {
    let body = model.bodies.get(body?)?;
    Some(body.v_index() + body.joint.nv() - 1)
}
