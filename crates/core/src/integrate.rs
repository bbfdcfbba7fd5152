//! Positions that respect the group of a floating root, and fixed-step schemes for real time.
//!
//! No allocation; the work per step does not depend on the values. Adaptive and stiff schemes live outside this crate.

use crate::Scalar;
use crate::dynamics::{External, Forward, ForwardScratch, State, forward_dynamics};
use crate::model::{JointKind, Model, SizeError};
use crate::spatial::{Mat3, Vec3};

/// `q ⊕ v`: moves `q` along the constant velocity `v` for unit time; a floating root along the screw of its twist.
/// `q` and `out` have `nq` entries, `v` has `nv`.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn integrate<T: Scalar>(model: &Model<T>, q: &[T], v: &[T], out: &mut [T]) -> Result<(), SizeError> {
    SizeError::check("q", q.len(), model.nq)?;
    SizeError::check("v", v.len(), model.nv)?;
    SizeError::check("out", out.len(), model.nq)?;
    for body in model.bodies {
        let (i, k) = (body.q_index(), body.v_index());
        if body.joint == JointKind::Floating {
            let omega = Vec3::new(v[k], v[k + 1], v[k + 2]);
            let (turn, shift) = screw(omega, Vec3::new(v[k + 3], v[k + 4], v[k + 5]));
            let start = [q[i + 3], q[i + 4], q[i + 5], q[i + 6]];
            let moved = Mat3::from_quaternion(start) * shift;
            out[i] = q[i] + moved.x;
            out[i + 1] = q[i + 1] + moved.y;
            out[i + 2] = q[i + 2] + moved.z;
            out[i + 3..i + 7].copy_from_slice(&unit(product(start, turn)));
        } else {
            out[i] = q[i] + v[k];
        }
    }
    Ok(())
}

/// `to ⊖ from`: the constant velocity that moves `from` to `to` in unit time, so that `integrate(from, v) = to`; a floating
/// root turns by less than half a turn. `from` and `to` have `nq` entries, `out` has `nv`.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn difference<T: Scalar>(model: &Model<T>, from: &[T], to: &[T], out: &mut [T]) -> Result<(), SizeError> {
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
pub fn position_rate<T: Scalar>(model: &Model<T>, q: &[T], qd: &[T], out: &mut [T]) -> Result<(), SizeError> {
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
pub fn normalize<T: Scalar>(model: &Model<T>, q: &mut [T]) -> Result<(), SizeError> {
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
    model: &Model<T>,
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
    model: &Model<T>,
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
    let ForwardScratch { bodies, matrix } = scratch;

    pack(&state.view(), start, nq, nv)?;
    sum.fill(T::zero());
    // x ← x₀ + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄), each slope taken at x₀ + (0, ½, ½, 1) h k.
    for (reach, weight) in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)] {
        {
            let (q_rate, rates) = slope.split_at_mut(nq);
            let (qdd, rates) = rates.split_at_mut(nv);
            let (theta_rate, thetadd) = rates.split_at_mut(nv);
            let scratch = ForwardScratch { bodies: &mut *bodies, matrix: &mut *matrix };
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
fn follow_joints<T: Scalar>(model: &Model<T>, state: StateMut<T>) {
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

/// Hamilton product of quaternions `(x, y, z, w)`.
fn product<T: Scalar>([ax, ay, az, aw]: [T; 4], [bx, by, bz, bw]: [T; 4]) -> [T; 4] {
    let (a, b) = (Vec3::new(ax, ay, az), Vec3::new(bx, by, bz));
    let v = a.cross(b) + b.scale(aw) + a.scale(bw);
    [v.x, v.y, v.z, aw * bw - a.dot(b)]
}

fn unit<T: Scalar>(q: [T; 4]) -> [T; 4] {
    let [x, y, z, w] = q;
    let scale = T::one() / (x * x + y * y + z * z + w * w).sqrt();
    q.map(|c| c * scale)
}

/// Below this square of an angle, series of its functions are exact to rounding and divisions by it are not.
const SMALL: f64 = 1e-4;

/// The quaternion and the translation of unit time of the twist `(omega, lin)`: the exponential of SE(3).
fn screw<T: Scalar>(omega: Vec3<T>, lin: Vec3<T>) -> ([T; 4], Vec3<T>) {
    let f = T::from_f64;
    let x2 = omega.dot(omega);
    let small = |series: T, exact: T| x2.select_less(f(SMALL), series, exact);
    let x = x2.select_less(f(SMALL), f(1.0), x2).sqrt();
    let (s, (sh, ch)) = (x.sin_cos().0, (x * f(0.5)).sin_cos());
    // sin(x/2)/x and cos(x/2);  (1 − cos x)/x² = 2 (sin(x/2)/x)² and (x − sin x)/x³.
    let half_sinc = small(f(0.5) - x2 * (f(1.0 / 48.0) - x2 * f(1.0 / 3840.0)), sh / x);
    let half_cos = small(f(1.0) - x2 * (f(0.125) - x2 * f(1.0 / 384.0)), ch);
    let a = small(f(0.5) - x2 * (f(1.0 / 24.0) - x2 * f(1.0 / 720.0)), f(2.0) * (sh / x) * (sh / x));
    let b = small(f(1.0 / 6.0) - x2 * (f(1.0 / 120.0) - x2 * f(1.0 / 5040.0)), (x - s) / (x * x * x));
    let turn = omega.scale(half_sinc);
    // V = 1 + a ω× + b ω×ω×
    let wl = omega.cross(lin);
    let shift = lin + wl.scale(a) + omega.cross(wl).scale(b);
    ([turn.x, turn.y, turn.z, half_cos], shift)
}

/// The linear part of the twist whose screw of unit time shifts by `shift` while turning by `omega`: `V⁻¹ shift`.
fn screw_shift_inverse<T: Scalar>(omega: Vec3<T>, shift: Vec3<T>) -> Vec3<T> {
    let f = T::from_f64;
    let x2 = omega.dot(omega);
    let x = x2.select_less(f(SMALL), f(1.0), x2).sqrt();
    let (sh, ch) = (x * f(0.5)).sin_cos();
    // V⁻¹ = 1 − ½ ω× + (1 − (x/2) cot(x/2))/x² ω×ω×
    let exact = (f(1.0) - f(0.5) * x * ch / sh) / (x * x);
    let c = x2.select_less(f(SMALL), f(1.0 / 12.0) + x2 * (f(1.0 / 720.0) + x2 * f(1.0 / 30240.0)), exact);
    let ws = omega.cross(shift);
    shift - ws.scale(f(0.5)) + omega.cross(ws).scale(c)
}

/// The rotation vector of a unit quaternion, shorter than half a turn.
fn rotation_vector<T: Scalar>([x, y, z, w]: [T; 4]) -> Vec3<T> {
    let f = T::from_f64;
    // q and −q are the same rotation; take the one with w ≥ 0.
    let sign = w.select_less(T::zero(), f(-1.0), f(1.0));
    let (v, w) = (Vec3::new(x, y, z).scale(sign), w * sign);
    let s2 = v.dot(v);
    let s = s2.select_less(f(SMALL), f(1.0), s2).sqrt();
    let exact = f(2.0) * s.atan2(w) / s;
    // 2 atan(s/w)/s = (2/w) (1 − r²/3 + r⁴/5 − r⁶/7), r = s/w.
    let r2 = s2 / (w * w);
    let series = f(2.0) / w * (f(1.0) - r2 * (f(1.0 / 3.0) - r2 * (f(0.2) - r2 * f(1.0 / 7.0))));
    v.scale(s2.select_less(f(SMALL), series, exact))
}
