//! Inverse dynamics: the recursive Newton–Euler algorithm ([`rnea`](crate::dynamics::rnea)) with modes, whose accelerations are asked for, too.

use super::link::Deflected;
use super::outward::Known;
use super::scratch::FlexibleScratch;
use crate::Scalar;
use crate::dynamics::drive_torque::{rotor_torque, transmission_error};
use crate::dynamics::tree::RootMotion;
use crate::dynamics::{Acceleration, External, Inverse, State};
use crate::model::{Body, Drive, FlexibleModel, JointKind, SizeError};
use crate::spatial::{ArticulatedInertia, Motion, SpatialInertia, Vec3};

/// Torques and generalised forces on the modes that make the robot, at the given state, accelerate as asked.
///
/// What [`rnea`](crate::dynamics::rnea) says of joints and motors holds here, too. The entries of a mode are what must act on it from
/// outside, besides its own stiffness and damping: zero for a motion that forward dynamics gives.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn flexible_rnea<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    state: State<T>,
    accel: Acceleration<T>,
    ext: External<T>,
    mut scratch: FlexibleScratch<T>,
    out: Inverse<T>,
) -> Result<(), SizeError> {
    let known = Known::of(model, state, ext)?;
    scratch.check(model)?;
    check_inverse(model, &accel, &out)?;
    known.outward(&mut scratch);
    for (j, mode) in scratch.modes.iter_mut().enumerate() {
        mode.etadd = accel.qdd[model.rigid.nv + j];
    }
    let base = known.base(accel.qdd, &mut scratch);
    for i in 0..model.rigid.bodies.len() {
        known.accelerate(i, accel.qdd, &mut scratch, base);
        known.accelerate_stations(i, &mut scratch);
    }
    known.burden_carriers(&accel, &mut scratch, Some(base));
    known.forces(&mut scratch);
    known.answer(&accel, &scratch, base, out);
    Ok(())
}

pub(super) fn check_inverse<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    accel: &Acceleration<T>,
    out: &Inverse<T>,
) -> Result<(), SizeError> {
    let nv = model.nv();
    SizeError::check("qdd", accel.qdd.len(), nv)?;
    SizeError::check("thetadd", accel.thetadd.len(), nv)?;
    SizeError::check("tau_j", out.tau_j.len(), nv)?;
    SizeError::check("tau", out.tau.len(), nv)
}

impl<T: Scalar> Known<'_, T> {
    /// Acceleration of the base as a point in space, gravity for an acceleration upwards; a floating root's goes to its record, too.
    pub(super) fn base(&self, qdd: &[T], scratch: &mut FlexibleScratch<T>) -> Motion<T> {
        let lift = -self.model.rigid.gravity.map(T::from_param);
        if let Some(body) = self.model.rigid.bodies.first().filter(|body| body.joint == JointKind::Floating) {
            // From the spatial to the classical acceleration: + ω × v
            let at = RootMotion::<T>::of(self.state.q, self.state.qd);
            let asked = Motion::from(core::array::from_fn(|k| qdd[body.v_index() + k]));
            let lin = at.v.ang.cross_plus(at.v.lin, asked.lin) + at.rot * lift;
            scratch.bodies[0].a = Motion { ang: asked.ang, lin };
        }
        Motion { ang: Vec3::zero(), lin: lift }
    }

    /// Puts on its carrier the couple `ḣ n + ω × h n` that every rotor needs. Without `base`, the acceleration of the world, those of
    /// carriers are not known yet, and their inertia must contain `J n nᵀ` instead.
    pub(super) fn burden_carriers(
        &self,
        accel: &Acceleration<T>,
        scratch: &mut FlexibleScratch<T>,
        base: Option<Motion<T>>,
    ) {
        for (i, body) in self.model.rigid.bodies.iter().enumerate() {
            let Some(Drive { rotor, elastic }) = &body.drive else { continue };
            let (thetad, thetadd) = self.motor_motion(body, accel);
            let zero = Vec3::zero();
            let (mut alpha, omega) = (zero, self.of_carrier(i, scratch, (|s| s.omega, |b| b.omega), zero));
            let mut h = rotor.axial_momentum(thetad, zero);
            if elastic.is_some() {
                h = rotor.axial_momentum(thetad, omega);
                if let Some(base) = base {
                    alpha = self.of_carrier(i, scratch, (|s| s.a.ang, |b| b.a.ang), base.ang);
                }
            }
            let axis = rotor.axis_in::<T>();
            let couple = omega.cross_plus(axis.scale(h), axis.scale(rotor.axial_momentum(thetadd, alpha)));
            self.burden_carrier(i, scratch, couple);
        }
    }

    /// Reflected velocity and acceleration of the rotor of a joint that has one.
    fn motor_motion(&self, body: &Body<T::Param>, accel: &Acceleration<T>) -> (T, T) {
        let v = body.v_index();
        if body.is_elastic() { (self.state.thetad[v], accel.thetadd[v]) } else { (self.state.qd[v], accel.qdd[v]) }
    }

    /// Tips to base: the force of every body with what hangs on it in `p`, the generalised force of every mode in its `p`.
    pub(super) fn forces(&self, scratch: &mut FlexibleScratch<T>) {
        for (i, body) in self.model.rigid.bodies.iter().enumerate().rev() {
            let s = &scratch.bodies[i];
            let mut f = ArticulatedInertia::from(s.inertia).force(s.a) + s.p;
            if let Some(link) = self.model.link_of(i) {
                let own = Deflected::<T::Param, T>::of(self.model, link, self.eta, self.etad);
                let (a, n) = (s.a, link.n());
                let modes = &mut scratch.modes[link.mode_range()];
                for j in 0..n {
                    // Q_j = U_j·a + Σ M_jk η̈_k + p_j
                    let mut q = a.dot(modes[j].u_cap) + modes[j].p;
                    for (k, other) in modes.iter().enumerate() {
                        q += own.modal_mass(j, k) * other.etadd;
                    }
                    modes[j].p = q;
                    f = f.plus_scaled(modes[j].etadd, modes[j].u_cap);
                }
                for (k, station) in scratch.stations[link.station_range()].iter().enumerate() {
                    let lumps: SpatialInertia<T> =
                        self.model.stations[link.station_range()][k].inertia.map(T::from_param);
                    let on_station = ArticulatedInertia::from(lumps).force(station.a) + station.p;
                    for (mode, column) in modes.iter_mut().zip(&scratch.shapes[link.shape_range(k)]) {
                        mode.p += column.dot(on_station);
                    }
                    f += station.x.inv_force(on_station);
                }
            }
            scratch.bodies[i].p = f;
            if body.joint != JointKind::Floating {
                let on_parent = self.across(i, &scratch.bodies[i]).inv_force(f);
                self.hang(i, scratch, ArticulatedInertia::zero(), on_parent);
            }
        }
    }

    /// Writes what the forces across the joints, in `p`, mean for transmissions and motors.
    pub(super) fn answer(
        &self,
        accel: &Acceleration<T>,
        scratch: &FlexibleScratch<T>,
        base: Motion<T>,
        out: Inverse<T>,
    ) {
        let load = |k: usize| self.ext.tau.get(k).copied().unwrap_or(T::zero());
        for (i, (body, s)) in self.model.rigid.bodies.iter().zip(&*scratch.bodies).enumerate() {
            let v = body.v_index();
            if body.joint == JointKind::Floating {
                for (k, f) in s.p.to_array().into_iter().enumerate() {
                    (out.tau_j[v + k], out.tau[v + k]) = (f - load(v + k), f - load(v + k));
                }
                continue;
            }
            // τ_J = Sᵀ f + f_l(q̇) − τ_ext,   τ = (1 − e') τ_J + B θ̈ + N J n·α + N f_m
            let joint = body.joint.along(s.p) + body.friction.torque(self.qd(body)) - load(v);
            let mut motor = joint;
            if let Some(Drive { rotor, elastic }) = &body.drive {
                if let Some(elastic) = elastic {
                    motor = (T::one() - transmission_error(elastic, rotor, self.state.theta[v]).1) * joint;
                }
                let (thetad, thetadd) = self.motor_motion(body, accel);
                let alpha = self.of_carrier(i, scratch, (|s| s.a.ang, |b| b.a.ang), base.ang);
                motor += rotor_torque(rotor, thetadd, alpha) + rotor.reflected_friction(thetad);
            }
            (out.tau_j[v], out.tau[v]) = (joint, motor);
        }
        let rigid = self.model.rigid.nv;
        for (j, mode) in scratch.modes.iter().enumerate() {
            let force = mode.p - load(rigid + j);
            (out.tau_j[rigid + j], out.tau[rigid + j]) = (force, force);
        }
    }
}
