//! Inertia matrices of joints, modes and motors, column by column.

use super::outward::Known;
use super::scratch::FlexibleScratch;
use crate::Scalar;
use crate::dynamics::drive_torque::rotor_torque;
use crate::dynamics::{External, State};
use crate::model::{FlexibleModel, JointKind, SizeError};
use crate::spatial::{Force, Motion};

/// What [`flexible_mass_matrix`] writes, `nv × nv` by rows, ordered as [`FlexibleModel`] says.
#[derive(Debug)]
pub struct FlexibleMatrices<'a, T> {
    /// `M_l(q)`: inertia of joints and modes, as [`crba`](crate::dynamics::crba) says of joints.
    pub mass: &'a mut [T],
    /// `S(q)`: column `j` couples the elastic rotor of joint `j` to joints and modes, as [`coupling`](crate::dynamics::coupling) says of
    /// joints; zero columns for the rest.
    pub coupling: &'a mut [T],
}

/// Inertia of joints and modes, and what couples it to elastic rotors: `[[M_l, S], [Sᵀ, B]]` is that of the whole robot.
///
/// A column is what unit acceleration of one coordinate takes, a sweep out and a sweep in.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn flexible_mass_matrix<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    q: &[T],
    mut scratch: FlexibleScratch<T>,
    out: FlexibleMatrices<T>,
) -> Result<(), SizeError> {
    let (nv, rigid) = (model.nv(), model.rigid.nv);
    SizeError::check("q", q.len(), model.nq())?;
    SizeError::check("mass", out.mass.len(), nv * nv)?;
    SizeError::check("coupling", out.coupling.len(), nv * nv)?;
    scratch.check(model)?;
    // Velocities are of no concern: what the sweep makes of those that stand in for them is cleared for every column.
    let any = &q[..nv];
    let known = Known::of(model, State { q, qd: any, theta: any, thetad: any }, External::none())?;
    known.outward(&mut scratch);
    out.coupling.fill(T::zero());
    for column in 0..nv {
        known.clear(&mut scratch, |k| if k == column { T::one() } else { T::zero() });
        for i in 0..model.rigid.bodies.len() {
            known.accelerate_unit(i, column, &mut scratch);
            known.accelerate_stations(i, &mut scratch);
        }
        for (i, body) in model.rigid.bodies.iter().enumerate() {
            let Some(drive) = &body.drive else { continue };
            let (rotor, v) = (&drive.rotor, body.v_index());
            let alpha = known.of_carrier(i, &scratch, (|s| s.a.ang, |b| b.a.ang), Motion::zero().ang);
            let own = if v == column { T::one() } else { T::zero() };
            let axis = rotor.axis_in::<T>();
            // At rest beside its carrier, an elastic rotor needs J n (n·α); a rigid one is part of it, and turns with the joint.
            let rate = if drive.elastic.is_some() {
                out.coupling[column * nv + v] = rotor.coupling().dot(alpha);
                rotor.axial_momentum(T::zero(), alpha)
            } else {
                rotor.axial_momentum(own, Motion::zero().ang)
            };
            known.burden_carrier(i, &mut scratch, axis.scale(rate));
        }
        known.forces(&mut scratch);
        for (i, (body, s)) in model.rigid.bodies.iter().zip(&*scratch.bodies).enumerate() {
            let v = body.v_index();
            if body.joint == JointKind::Floating {
                for (k, f) in s.p.to_array().into_iter().enumerate() {
                    out.mass[(v + k) * nv + column] = f;
                }
                continue;
            }
            let mut entry = body.joint.along(s.p);
            if let Some(rotor) = body.rigid_rotor() {
                let alpha = known.of_carrier(i, &scratch, (|s| s.a.ang, |b| b.a.ang), Motion::zero().ang);
                entry += rotor_torque(rotor, if v == column { T::one() } else { T::zero() }, alpha);
            }
            out.mass[v * nv + column] = entry;
        }
        for (j, mode) in scratch.modes.iter().enumerate() {
            out.mass[(rigid + j) * nv + column] = mode.p;
        }
    }
    Ok(())
}

impl<T: Scalar> Known<'_, T> {
    /// Nothing moves, only coordinates accelerate, by `asked`.
    fn clear(&self, scratch: &mut FlexibleScratch<T>, asked: impl Fn(usize) -> T) {
        for s in scratch.bodies.iter_mut() {
            (s.c, s.p) = (Motion::zero(), Force::zero());
        }
        for s in scratch.stations.iter_mut() {
            (s.c, s.p) = (Motion::zero(), Force::zero());
        }
        for (j, mode) in scratch.modes.iter_mut().enumerate() {
            (mode.p, mode.etadd) = (T::zero(), asked(self.model.rigid.nv + j));
        }
    }

    /// Acceleration of body `i` where only coordinate `column` accelerates.
    fn accelerate_unit(&self, i: usize, column: usize, scratch: &mut FlexibleScratch<T>) {
        let body = &self.model.rigid.bodies[i];
        let unit = |k: usize| if k == column { T::one() } else { T::zero() };
        let v = body.v_index();
        if body.joint == JointKind::Floating {
            scratch.bodies[i].a = Motion::from(core::array::from_fn(|k| unit(v + k)));
            return;
        }
        let parent = self.of_parent(i, scratch, (|p| p.a, |p| p.a), Motion::zero());
        let s = &mut scratch.bodies[i];
        s.a = body.joint.moved(self.across(i, s).motion(parent), unit(v));
    }
}
