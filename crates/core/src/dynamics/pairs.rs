//! Entries of matrices in base axes: for a joint whose load is complete and every joint that carries it (equations in
//! [`super::at_base`]).

use super::at_base::{DerivativeScratch, unit};
use crate::Scalar;
use crate::dispatch::Over;
use crate::model::{JointKind, Model};
use crate::spatial::Vec3;

/// `S_j·Iᶜ_i S_i` for joint `i`, complete, and every `j` that carries it, itself first: `put(j, entry)`.
#[inline(always)]
pub(super) fn for_each_inertia<T: Scalar, F: Over<T>>(
    model: &Model<T::Param>,
    scratch: &[DerivativeScratch<T>],
    i: usize,
    mut put: impl FnMut(usize, F),
) {
    let Some(column) = scratch.get(i).map(|s| s.column.map(F::load)) else { return };
    let mut at = Some(i);
    while let Some(p) = at {
        let (Some(on), Some(s)) = (model.bodies.get(p), scratch.get(p)) else { break };
        if on.joint == JointKind::Floating {
            for (c, entry) in column.to_array().into_iter().enumerate() {
                put(on.v_index() + c, entry);
            }
            break;
        }
        put(on.v_index(), s.axis.map(F::load).dot(column));
        at = on.parent();
    }
}

/// An entry of three matrices at once.
pub(super) struct Entries<F> {
    pub(super) row: usize,
    pub(super) column: usize,
    /// `∂τ/∂q`.
    pub(super) q: F,
    /// `∂τ/∂q̇`.
    pub(super) qd: F,
    /// `∂τ/∂q̈ = M`.
    pub(super) qdd: F,
    /// `C`: `S_i·(Bᶜ S_j + Iᶜ Ṡ_j)`, for which `Ṁ = C + Cᵀ`.
    pub(super) c: F,
}

/// How the torques at the joints change with the motion of joint `i`, and that of joint `i` with the motion of the joints that
/// carry it, when what `i` carries is complete: every pair of coordinates comes once.
#[inline(always)]
pub(super) fn for_each_pair<T: Scalar, F: Over<T>>(
    model: &Model<T::Param>,
    scratch: &[DerivativeScratch<T>],
    i: usize,
    mut put: impl FnMut(Entries<F>),
) {
    let (body, s) = (&model.bodies[i], &scratch[i]);
    let k = body.v_index();
    let half = F::from_f64(0.5);
    let (inertia, coriolis) = (s.inertia.map(F::load), s.coriolis.map(F::load));
    if body.joint == JointKind::Floating {
        let (v, lift) = (s.v.map(F::load), s.axis_acceleration.map(F::load));
        for c in 0..6 {
            let axis = unit(c);
            let by_q = inertia.momentum(lift.cross(axis)).to_array();
            let turned = inertia.momentum(v.cross(axis));
            let (by_qd, turned) = ((coriolis.force(axis) + turned).to_array(), turned.to_array());
            for (r, qdd) in inertia.momentum(axis).to_array().into_iter().enumerate() {
                let c_term = half * (by_qd[r] + turned[r]);
                put(Entries { row: k + r, column: k + c, q: by_q[r], qd: by_qd[r], qdd, c: c_term });
            }
        }
        return;
    }
    let (axis, rate, acceleration) = (s.axis.map(F::load), s.axis_rate.map(F::load), s.axis_acceleration.map(F::load));
    let by_q = coriolis.force(rate) + inertia.momentum(acceleration) + axis.cross_force(s.f.map(F::load));
    let by_qd = coriolis.force(axis) + inertia.momentum(rate + rate);
    let (u, b) = (s.column.map(F::load), coriolis.transpose_mul(axis));
    let qd = axis.dot(by_qd);
    put(Entries { row: k, column: k, q: axis.dot(by_q), qd, qdd: axis.dot(u), c: half * qd });
    let mut at = body.parent();
    while let Some(p) = at {
        let (Some(on), Some(s)) = (model.bodies.get(p), scratch.get(p)) else { break };
        let j = on.v_index();
        if on.joint == JointKind::Floating {
            let (v, lift) = (s.v.map(F::load), s.axis_acceleration.map(F::load));
            let (by_q, by_qd, inertia) = (by_q.to_array(), by_qd.to_array(), u.to_array());
            for c in 0..6 {
                let axis = unit(c);
                put(Entries { row: j + c, column: k, q: by_q[c], qd: by_qd[c], qdd: inertia[c], c: half * by_qd[c] });
                let turned = v.cross(axis).dot(u);
                let (q, qd) = (lift.cross(axis).dot(u), b.dot(axis.ang) + turned);
                put(Entries { row: k, column: j + c, q, qd, qdd: inertia[c], c: half * (qd + turned) });
            }
            break;
        }
        let (axis, rate, acceleration) =
            (s.axis.map(F::load), s.axis_rate.map(F::load), s.axis_acceleration.map(F::load));
        let (qd, qdd) = (axis.dot(by_qd), axis.dot(u));
        put(Entries { row: j, column: k, q: axis.dot(by_q), qd, qdd, c: half * qd });
        let (q, qd) = (b.dot(rate.ang) + acceleration.dot(u), b.dot(axis.ang) + (rate + rate).dot(u));
        put(Entries { row: k, column: j, q, qd, qdd, c: half * qd });
        at = on.parent();
    }
}

/// What a joint that carries a rotor's carrier does to the rotor.
pub(super) struct OnCarrier<F> {
    /// The joint's coordinate.
    pub(super) column: usize,
    /// `n·S`: how its speed turns the carrier about the rotor's axis.
    pub(super) speed: F,
    /// `S·(ω × n)`: what a couple across the axis gives at the joint.
    pub(super) across: F,
    /// `∂(n·α)/∂q`, `α` the carrier's angular acceleration.
    pub(super) q: F,
    /// `∂(n·α)/∂q̇`.
    pub(super) qd: F,
    /// `n·(Ṡ + ½ S × ω)`: the joint's part of `n·α` at rest accelerations, shared out as Christoffel does.
    pub(super) c: F,
}

/// The same for each joint that carries body `m`, of angular velocity `omega`, with a rotor about `n`:
/// `∂(n·α)/∂q = n·(ψ̈ + ψ̇ × ω)`, `∂(n·α)/∂q̇ = n·(ψ̇ + Ṡ + S × ω)`.
#[inline(always)]
pub(super) fn for_each_carrying<T: Scalar, F: Over<T>>(
    model: &Model<T::Param>,
    scratch: &[DerivativeScratch<T>],
    (m, omega, n): (usize, Vec3<F>, Vec3<F>),
    mut put: impl FnMut(OnCarrier<F>),
) {
    let (across, half) = (omega.cross(n), F::from_f64(0.5));
    let mut at = Some(m);
    while let Some(p) = at {
        let (Some(on), Some(s)) = (model.bodies.get(p), scratch.get(p)) else { break };
        let column = on.v_index();
        if on.joint == JointKind::Floating {
            let spin = s.v.ang.map(F::load);
            for c in 0..3 {
                let axis = unit::<F>(c).ang;
                let (speed, across) = (n.dot(axis), across.dot(axis));
                let qd = n.dot(spin.cross(axis)) + across;
                let c_term = qd - half * across;
                put(OnCarrier { column: column + c, speed, across, q: F::zero(), qd, c: c_term });
            }
            break;
        }
        let axis = s.axis.ang.map(F::load);
        let (rate, acceleration) = (s.axis_rate.ang.map(F::load), s.axis_acceleration.ang.map(F::load));
        let q = n.dot(acceleration) + across.dot(rate);
        let qd = n.dot(rate + rate) + across.dot(axis);
        put(OnCarrier { column, speed: n.dot(axis), across: across.dot(axis), q, qd, c: half * qd });
        at = on.parent();
    }
}
