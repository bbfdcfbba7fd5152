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
//! their columns belong to `q̇` and `q̈`. What acts on a joint depends on its own coordinates alone.
//!
//! Cost O(n·depth) for the right-hand sides, then two dense products. No allocation, no branch on values.

use super::at_base::{
    DerivativeScratch, Entries, OnCarrier, add, carrier, for_each_carrying, for_each_inertia, for_each_pair, hand_on,
    load_carrier, outward, set, spin, subtract_wrenches, unit,
};
use super::dense::{invert, stride, transposed_times};
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
    let nv = model.nv;
    (2 * stride(nv) + 6 * nv + 2) * nv
}

/// The accelerations of [`super::forward_dynamics`] and how they change with state and motor torques, in all four models. Loads from
/// outside keep their coordinates: wrenches turn with their links. `scratch` has one record per body, `matrix`
/// [`derivative_matrix_len`] entries.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
///
/// # Example
///
/// The flexible link of the crate's example: the spring pulls link and rotor together.
///
/// ```
/// use gyroflex::dynamics::{DerivativeScratch, External, Forward, ForwardDerivatives, State, derivative_matrix_len, forward_derivatives};
/// # use gyroflex::model::*;
/// # use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};
/// # let axis = Vec3::new(0.0, 1.0, 0.0);
/// # let mount = MountSpec { body: None, placement: Transform::identity(), axis };
/// # let link = BodySpec {
/// #     parent: None,
/// #     joint: JointKind::Revolute,
/// #     axis,
/// #     placement: Transform::identity(),
/// #     inertia: SpatialInertia::from_com(2.0, Vec3::new(0.25, 0.0, 0.0), SymMat3::diagonal(1e-3, 0.04, 0.04)),
/// #     friction: Friction::none(),
/// #     drive: Some(DriveSpec {
/// #         rotor: RotorSpec { inertia: 2e-5, body: None, mount },
/// #         gear_ratio: 100.0,
/// #         transmission: TransmissionSpec::Elastic {
/// #             spring: SpringSpec::Polynomial { stiffness: 4000.0, cubic: 0.0 },
/// #             damping: 5.0,
/// #             error: TransmissionError::none(),
/// #         },
/// #         friction: Friction::none(),
/// #     }),
/// # };
/// # let robot = RobotSpec { bodies: &[link], spring_tables: &[], gravity: Vec3::new(0.0, 0.0, -9.81) };
/// let mut bodies = [Body::empty(); 1];
/// let model = robot.lower(Fidelity::Complete, &mut bodies, &mut [])?;
///
/// let (mut qdd, mut thetadd, mut tau_j) = ([0.0_f64], [0.0], [0.0]);
/// let (mut by_qdd, mut by_thetadd) = ([0.0; 5], [0.0; 5]);
/// let mut matrix = vec![0.0; derivative_matrix_len(&model)];
/// forward_derivatives(
///     &model,
///     State { q: &[0.3], qd: &[0.0], theta: &[0.3], thetad: &[0.0] },
///     &[0.0],
///     External::none(),
///     &mut [DerivativeScratch::new()],
///     &mut matrix,
///     Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
///     ForwardDerivatives { qdd: &mut by_qdd, thetadd: &mut by_thetadd },
/// )?;
/// let (inertia, rotor, stiffness) = (0.04 + 2.0 * 0.25 * 0.25, 2e-5 * 100.0 * 100.0, 4000.0);
/// let [by_q, _by_qd, by_theta, _by_thetad, by_tau] = by_thetadd;
/// assert!((by_qdd[2] - stiffness / inertia).abs() < 1e-9);
/// assert!((by_theta + stiffness / rotor).abs() < 1e-9 && (by_q - stiffness / rotor).abs() < 1e-9);
/// assert!((by_tau - 1.0 / rotor).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
        let [q, qd, _, thetad, tau_at] = [0, 1, 2, 3, 4].map(|block| block * nv);
        // M; M⁻¹; −R; M ∂q̈; what is left to accelerate the joints; pivots
        let (m, rest) = matrix.split_at_mut(stride(nv) * nv);
        let (inverse, rest) = rest.split_at_mut(stride(nv) * nv);
        let (r, rest) = rest.split_at_mut(nv * nv);
        let (rhs, rest) = rest.split_at_mut(width * nv);
        let (left, pivots) = rest.split_at_mut(nv);
        for all in [&mut *m, &mut *r, &mut *rhs, &mut *d_thetadd] {
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
        outward::<T, F, false>(
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
                    left[k] = (F::load(tau[k]) + load(k)).store();
                    tau_j[k] = tau[k];
                    add(rhs, k * width + tau_at + k, F::one());
                }
                continue;
            }
            let at = joint(k, body.q_index());
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

        // Pass 2, tips to base: composites, M, R, and what is left to accelerate the joints.
        for (i, body) in bodies.iter().enumerate().rev() {
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
        invert::<T, F>(nv, m, pivots, inverse);
        for (qdd, row) in qdd.iter_mut().zip(inverse.chunks_exact(stride(nv).max(1))) {
            let products = row.iter().zip(&*left);
            *qdd = products.fold(F::zero(), |sum, (m, left)| F::load(*m).mul_add(F::load(*left), sum)).store();
        }

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
            let by = sensitivity(body, joint(k, body.q_index()), model.knots);
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
                        let turned = by_speed * on.speed;
                        set(r, on.column * nv + k, -turned);
                        for (block, on_rotor) in by.on_rotor.into_iter().enumerate() {
                            add(rhs, on.column * width + block * nv + k, -(turned * on_rotor));
                        }
                        add(rhs, on.column * width + thetad + k, -(spin * on.across));
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

        transposed_times::<T, F, false>(nv, (inverse, stride(nv)), |_| nv, rhs, d_qdd, width);
        // A rotor is carried by joints before its own: R is strictly triangular.
        transposed_times::<T, F, true>(nv, (r, nv), |end| end - 1, d_qdd, d_thetadd, width);

        // θ̈ = r/B − n·α/N;   rigid: that of the joint, and τ_J less what the rotor takes
        for body in bodies {
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
        Ok(())
    }
}

/// `n·α` of a rotor's carrier; zero on the fixed world.
#[inline(always)]
fn at_carrier<T: Scalar, F: Over<T>>(rotor: &Rotor<T::Param>, scratch: &[DerivativeScratch<T>]) -> F {
    carrier::<T, F>(rotor, scratch).map_or(F::zero(), |(m, _, n)| n.dot(scratch[m].a.ang.map(F::load)))
}
