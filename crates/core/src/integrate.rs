//! Positions that respect the group of a floating root, and fixed-step schemes for real time.
//!
//! No allocation; the work per step does not depend on the values. Adaptive and stiff schemes live outside this crate.

use crate::Scalar;
use crate::dynamics::{External, Forward, ForwardScratch, State, forward_dynamics};
use crate::model::{JointKind, Model, SizeError};
use crate::spatial::screw::{product, rotation_vector, screw, screw_shift_inverse, unit};
use crate::spatial::{Mat3, Vec3};

/// `q ⊕ v`: moves `q` along the constant velocity `v` for unit time; a floating root along the screw of its twist.
/// `q` and `out` have `nq` entries, `v` has `nv`.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn integrate<T: Scalar>(model: &Model<T::Param>, q: &[T], v: &[T], out: &mut [T]) -> Result<(), SizeError> {
    SizeError::check("q", q.len(), model.nq)?;
    SizeError::check("v", v.len(), model.nv)?;
    SizeError::check("out", out.len(), model.nq)?;
    let mut rest = (q, v, &mut *out);
    let floating = model.bodies.first().is_some_and(|root| root.joint == JointKind::Floating);
    if floating && let (Some((q, qs)), Some((v, vs))) = (q.split_first_chunk(), v.split_first_chunk()) {
        let Some((out, outs)) = out.split_first_chunk_mut() else { return Ok(()) };
        *out = moved_root(*q, *v);
        rest = (qs, vs, outs);
    }
    let (q, v, out) = rest;
    for (out, (q, v)) in out.iter_mut().zip(q.iter().zip(v)) {
        *out = *q + *v;
    }
    Ok(())
}

/// A floating root moved along the screw of its twist.
fn moved_root<T: Scalar>([px, py, pz, x, y, z, w]: [T; 7], [wx, wy, wz, vx, vy, vz]: [T; 6]) -> [T; 7] {
    let (turn, shift) = screw(Vec3::new(wx, wy, wz), Vec3::new(vx, vy, vz));
    let moved = Mat3::from_quaternion([x, y, z, w]) * shift;
    let [x, y, z, w] = unit(product([x, y, z, w], turn));
    [px + moved.x, py + moved.y, pz + moved.z, x, y, z, w]
}

/// `to ⊖ from`: the constant velocity that moves `from` to `to` in unit time, so that `integrate(from, v) = to`; a floating
/// root turns by less than half a turn. `from` and `to` have `nq` entries, `out` has `nv`.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn difference<T: Scalar>(model: &Model<T::Param>, from: &[T], to: &[T], out: &mut [T]) -> Result<(), SizeError> {
    SizeError::check("from", from.len(), model.nq)?;
    SizeError::check("to", to.len(), model.nq)?;
    SizeError::check("out", out.len(), model.nv)?;
    for body in model.bodies {
        let (i, k) = (body.q_index(), body.v_index());
        if body.joint == JointKind::Floating {
            let start = [from[i + 3], from[i + 4], from[i + 5], from[i + 6]];
            let end = [to[i + 3], to[i + 4], to[i + 5], to[i + 6]];
            let [x, y, z, w] = start;
            let omega = rotation_vector(product([-x, -y, -z, w], end));
            let apart = Vec3::new(to[i] - from[i], to[i + 1] - from[i + 1], to[i + 2] - from[i + 2]);
            let lin = screw_shift_inverse(omega, Mat3::from_quaternion(start).transpose_mul(apart));
            out[k..k + 3].copy_from_slice(&omega.to_array());
            out[k + 3..k + 6].copy_from_slice(&lin.to_array());
        } else {
            out[k] = to[i] - from[i];
        }
    }
    Ok(())
}

/// `dq/dt` at `q` for the velocity `qd`: position and quaternion rates of a floating root, `qd` elsewhere.
/// `q` and `out` have `nq` entries, `qd` has `nv`.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn position_rate<T: Scalar>(model: &Model<T::Param>, q: &[T], qd: &[T], out: &mut [T]) -> Result<(), SizeError> {
    SizeError::check("q", q.len(), model.nq)?;
    SizeError::check("qd", qd.len(), model.nv)?;
    SizeError::check("out", out.len(), model.nq)?;
    for body in model.bodies {
        let (i, k) = (body.q_index(), body.v_index());
        if body.joint == JointKind::Floating {
            let quaternion = [q[i + 3], q[i + 4], q[i + 5], q[i + 6]];
            let lin = Mat3::from_quaternion(quaternion) * Vec3::new(qd[k + 3], qd[k + 4], qd[k + 5]);
            out[i..i + 3].copy_from_slice(&lin.to_array());
            let half = T::from_f64(0.5);
            let spin = product(quaternion, [qd[k], qd[k + 1], qd[k + 2], T::zero()]);
            out[i + 3..i + 7].copy_from_slice(&spin.map(|c| c * half));
        } else {
            out[i] = qd[k];
        }
    }
    Ok(())
}

/// Brings the quaternion of a floating root back to unit length. `q` has `nq` entries.
///
/// # Errors
/// [`SizeError`] if the slice does not fit the model; nothing is written then.
pub fn normalize<T: Scalar>(model: &Model<T::Param>, q: &mut [T]) -> Result<(), SizeError> {
    SizeError::check("q", q.len(), model.nq)?;
    for body in model.bodies.iter().filter(|b| b.joint == JointKind::Floating) {
        let i = body.q_index() + 3;
        let turned = unit([q[i], q[i + 1], q[i + 2], q[i + 3]]);
        q[i..i + 4].copy_from_slice(&turned);
    }
    Ok(())
}

/// The state of a robot in slices that a step may change; lengths as in [`State`].
#[derive(Debug)]
pub struct StateMut<'a, T> {
    /// Joint positions, `nq` entries.
    pub q: &'a mut [T],
    /// Joint velocities, `nv` entries.
    pub qd: &'a mut [T],
    /// Reflected motor positions, `nv` entries; kept equal to the joint's where there is no elastic transmission.
    pub theta: &'a mut [T],
    /// Reflected motor velocities, `nv` entries.
    pub thetad: &'a mut [T],
}

impl<T> StateMut<'_, T> {
    fn view(&self) -> State<'_, T> {
        State { q: self.q, qd: self.qd, theta: self.theta, thetad: self.thetad }
    }
}

/// Length of the `work` slice of [`semi_implicit_euler`].
pub fn euler_len<T: Scalar>(model: &Model<T>) -> usize {
    3 * model.nv() + model.nq()
}

/// One step of semi-implicit Euler, first order: `q̇ += h q̈`, then `q ⊕ h q̇`. Motor torques and loads are held over the step.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; the state is left alone then.
pub fn semi_implicit_euler<T: Scalar>(
    model: &Model<T::Param>,
    state: StateMut<T>,
    tau: &[T],
    ext: External<T>,
    step: T,
    scratch: ForwardScratch<T>,
    work: &mut [T],
) -> Result<(), SizeError> {
    let (nq, nv) = (model.nq(), model.nv());
    SizeError::check("work", work.len(), euler_len(model))?;
    let (qdd, rest) = work.split_at_mut(nv);
    let (thetadd, rest) = rest.split_at_mut(nv);
    let (shift, q_next) = rest.split_at_mut(nv);
    forward_dynamics(model, state.view(), tau, ext, scratch, Forward { qdd, thetadd, tau_j: shift })?;
    for k in 0..nv {
        state.qd[k] += step * qdd[k];
        state.thetad[k] += step * thetadd[k];
        shift[k] = step * state.qd[k];
        state.theta[k] += step * state.thetad[k];
    }
    integrate(model, state.q, shift, q_next)?;
    state.q.copy_from_slice(&q_next[..nq]);
    follow_joints(model, state);
    Ok(())
}

/// Length of the `work` slice of [`rk4`].
pub fn rk4_len<T: Scalar>(model: &Model<T>) -> usize {
    3 * (model.nq() + 3 * model.nv()) + model.nv()
}

/// One step of the classical Runge–Kutta scheme, fourth order. Motor torques and loads are held over the step. A floating
/// root's quaternion is integrated as four numbers and brought back to unit length, which keeps the order.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; the state is left alone then.
pub fn rk4<T: Scalar>(
    model: &Model<T::Param>,
    state: StateMut<T>,
    tau: &[T],
    ext: External<T>,
    step: T,
    scratch: ForwardScratch<T>,
    work: &mut [T],
) -> Result<(), SizeError> {
    let (nq, nv) = (model.nq(), model.nv());
    SizeError::check("work", work.len(), rk4_len(model))?;
    let (start, rest) = work.split_at_mut(nq + 3 * nv);
    let (slope, rest) = rest.split_at_mut(nq + 3 * nv);
    let (sum, tau_j) = rest.split_at_mut(nq + 3 * nv);
    let ForwardScratch { bodies, joint_space, matrix } = scratch;

    pack(&state.view(), start, nq, nv)?;
    sum.fill(T::zero());
    // x ← x₀ + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄), each slope taken at x₀ + (0, ½, ½, 1) h k.
    for (reach, weight) in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)] {
        {
            let (q_rate, rates) = slope.split_at_mut(nq);
            let (qdd, rates) = rates.split_at_mut(nv);
            let (theta_rate, thetadd) = rates.split_at_mut(nv);
            let scratch = ForwardScratch { bodies: &mut *bodies, joint_space: &mut *joint_space, matrix: &mut *matrix };
            let out = Forward { qdd, thetadd, tau_j: &mut *tau_j };
            forward_dynamics(model, state.view(), tau, ext, scratch, out)?;
            position_rate(model, state.q, state.qd, q_rate)?;
            theta_rate.copy_from_slice(state.thetad);
        }
        let (reach, weight) = (step * T::from_f64(reach), T::from_f64(weight));
        for (total, k) in sum.iter_mut().zip(slope.iter()) {
            *total += weight * *k;
        }
        for (next, (x0, k)) in unpacked(&mut *state.q, &mut *state.qd, &mut *state.theta, &mut *state.thetad)
            .zip(start.iter().zip(slope.iter()))
        {
            *next = *x0 + reach * *k;
        }
    }
    let sixth = step * T::from_f64(1.0 / 6.0);
    for (next, (x0, total)) in
        unpacked(&mut *state.q, &mut *state.qd, &mut *state.theta, &mut *state.thetad).zip(start.iter().zip(sum.iter()))
    {
        *next = *x0 + sixth * *total;
    }
    normalize(model, state.q)?;
    follow_joints(model, state);
    Ok(())
}

/// Copies a state into one slice, in the order `q, qd, theta, thetad`.
fn pack<T: Scalar>(state: &State<T>, out: &mut [T], nq: usize, nv: usize) -> Result<(), SizeError> {
    SizeError::check("q", state.q.len(), nq)?;
    SizeError::check("qd", state.qd.len(), nv)?;
    SizeError::check("theta", state.theta.len(), nv)?;
    SizeError::check("thetad", state.thetad.len(), nv)?;
    let all = state.q.iter().chain(state.qd).chain(state.theta).chain(state.thetad);
    for (slot, x) in out.iter_mut().zip(all) {
        *slot = *x;
    }
    Ok(())
}

/// The entries of a state in the order of [`pack`].
fn unpacked<'a, T>(
    q: &'a mut [T],
    qd: &'a mut [T],
    theta: &'a mut [T],
    thetad: &'a mut [T],
) -> impl Iterator<Item = &'a mut T> {
    q.iter_mut().chain(qd).chain(theta).chain(thetad)
}

/// Without an elastic transmission the motor turns with the joint; a floating root has none.
fn follow_joints<T: Scalar>(model: &Model<T::Param>, state: StateMut<T>) {
    for body in model.bodies {
        let (i, k) = (body.q_index(), body.v_index());
        match body.joint {
            JointKind::Floating => {
                state.theta[k..k + 6].fill(T::zero());
                state.thetad[k..k + 6].fill(T::zero());
            }
            _ if !body.is_elastic() => {
                state.theta[k] = state.q[i];
                state.thetad[k] = state.qd[k];
            }
            _ => {}
        }
    }
}
