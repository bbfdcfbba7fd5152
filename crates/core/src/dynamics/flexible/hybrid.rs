//! Inverse dynamics of joints, forward dynamics of modes: the joints move as asked, the links bend as they must.

use super::modes::substitute;
use super::outward::Known;
use super::rnea::check_inverse;
use super::scratch::FlexibleScratch;
use crate::Scalar;
use crate::dynamics::{Acceleration, External, Inverse, State};
use crate::model::{FlexibleModel, JointKind, SizeError};
use crate::spatial::Motion;

/// Torques that make the joints and motors accelerate as asked while every mode is free, and the accelerations of the modes.
///
/// What [`flexible_rnea`](super::flexible_rnea) says of joints and motors holds here, too. Entries of modes in `accel` are not read, in
/// `out` they are zero; `etadd` has one entry per mode. A joint that is not asked to move costs no torque but what holds it.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn flexible_hybrid<T: Scalar>(
    model: &FlexibleModel<T::Param>,
    state: State<T>,
    accel: Acceleration<T>,
    ext: External<T>,
    mut scratch: FlexibleScratch<T>,
    out: Inverse<T>,
    etadd: &mut [T],
) -> Result<(), SizeError> {
    let known = Known::of(model, state, ext)?;
    scratch.check(model)?;
    check_inverse(model, &accel, &out)?;
    SizeError::check("etadd", etadd.len(), model.modes())?;
    let (bodies, rigid) = (model.rigid.bodies, model.rigid.nv);

    known.outward(&mut scratch);
    for (j, mode) in scratch.modes.iter_mut().enumerate() {
        mode.p -= ext.tau.get(rigid + j).copied().unwrap_or(T::zero());
    }
    // A rotor of known speed turns with its carrier: J n nᵀ is the carrier's again.
    known.burden_carriers(&accel, &mut scratch, None);
    for (i, body) in bodies.iter().enumerate().filter(|(i, _)| model.link_of(*i).is_none()) {
        scratch.bodies[i].ia.ang += body.rotors.map(T::from_param);
    }
    for (s, station) in scratch.stations.iter_mut().zip(model.stations) {
        s.ia.ang += station.rotors.map(T::from_param);
    }

    for (i, body) in bodies.iter().enumerate().rev() {
        let (ia, p) = known.articulate(i, &mut scratch);
        let s = &mut scratch.bodies[i];
        (s.ia, s.p) = (ia, p);
        if body.joint != JointKind::Floating {
            // pᵃ = Xᵀ (Iᴬ (c + S q̈) + pᴬ)
            let asked = body.joint.moved(s.c, accel.qdd[body.v_index()]);
            let x = known.across(i, s);
            let (ia, p) = (x.inv_articulated(ia), x.inv_force(ia.force(asked) + p));
            known.hang(i, &mut scratch, ia, p);
        }
    }

    let base: Motion<T> = known.base(accel.qdd, &mut scratch);
    for i in 0..bodies.len() {
        known.accelerate(i, accel.qdd, &mut scratch, base);
        let s = &mut scratch.bodies[i];
        s.p = s.ia.force(s.a) + s.p;
        if let Some(link) = model.link_of(i) {
            substitute(&mut scratch.modes[link.mode_range()], &scratch.matrix[link.pair_range()], s.a);
            known.accelerate_stations(i, &mut scratch);
        }
    }
    for (j, (mode, etadd)) in scratch.modes.iter_mut().zip(etadd).enumerate() {
        *etadd = mode.etadd;
        mode.p = ext.tau.get(rigid + j).copied().unwrap_or(T::zero());
    }
    known.answer(&accel, &scratch, base, out);
    Ok(())
}
