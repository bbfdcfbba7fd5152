//! The terms of the equations of motion that depend on velocity, and gravity: as matrices and as vectors.
//!
//! In the 2n coordinates `x = (q, θ)` of PHYSICS §2 the Coriolis matrix of Christoffel symbols is `[[C, C₁], [C₂, 0]]`. Written by
//! bodies it is `C_ij = S_i·(B S_j + I Ṡ_j)` with the composite of the outer one of both joints (Echeandia & Wensing 2021, eq. 27). A
//! rotor of speed `N θ̇` about the axis `n` of a carrier that turns with `ω` adds `−N J θ̇ n×` to the carrier's `2B`, and the blocks
//!
//! ```text
//! C₁_ij = ½ N J S_i·(ω × n_j)      C₂_ji = N J n_j·(Ṡ_i + ½ S_i × ω)
//! ```
//!
//! Zhao et al. 2015 (eq. 7 to 10) put the whole of a product `q̇_i θ̇_j` into their `C₁`, which is twice this one; their `C` is then free
//! of `θ̇`. The sum `C q̇ + C₁ θ̇` is the same, but only with the form here is `Ṁ − 2C` skew.
//!
//! Cost O(n·depth), of the vectors O(n). No allocation, no branch on values.

use super::at_base::{DerivativeScratch, add, carrier, hand_on, load_carrier, outward, spin};
use super::pairs::{Entries, OnCarrier, for_each_carrying, for_each_pair};
use super::{State, check_scratch, check_state};
use crate::Scalar;
use crate::model::{Drive, JointKind, Model, SizeError};
use crate::spatial::{Mat3, Vec3};

/// The blocks of the Coriolis matrix in the coordinates of links and reflected motors, `nv × nv` by rows each [kg m²/s].
///
/// Behind a rigid gear `θ` is `q`, and the rotor's part is in [`CoriolisMatrices::c`]; rows of `c2` and columns of `c1` that belong to no
/// elastic transmission are zero.
#[derive(Debug)]
pub struct CoriolisMatrices<'a, T> {
    /// `C`: links by links; holds half of what the spin of rotors does.
    pub c: &'a mut [T],
    /// `C₁`: links by motors.
    pub c1: &'a mut [T],
    /// `C₂`: motors by links.
    pub c2: &'a mut [T],
}

/// `C, C₁, C₂` at a state, of which `theta` is not read.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn coriolis_matrices<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    scratch: &mut [DerivativeScratch<T>],
    out: CoriolisMatrices<T>,
) -> Result<(), SizeError> {
    let nv = model.nv;
    let CoriolisMatrices { c, c1, c2 } = out;
    check_state(model, &state)?;
    check_scratch(model, scratch)?;
    for (name, matrix) in [("c", &mut *c), ("c1", &mut *c1), ("c2", &mut *c2)] {
        SizeError::check(name, matrix.len(), nv * nv)?;
    }
    for matrix in [&mut *c, &mut *c1, &mut *c2] {
        matrix.fill(T::zero());
    }
    composites(model, &state, scratch, |row, column, entry| add(c, row * nv + column, entry))?;
    let half = T::from_f64(0.5);
    for_each_rotor(model, scratch, |k, elastic, spin, on| {
        let (to_link, to_motor) = (half * spin * on.across, spin * on.c);
        if elastic {
            add(c1, on.column * nv + k, to_link);
            add(c2, k * nv + on.column, to_motor);
        } else {
            add(c, on.column * nv + k, to_link);
            add(c, k * nv + on.column, to_motor);
        }
    });
    Ok(())
}

/// How fast inertia changes, `nv × nv` by rows each [kg m²/s].
#[derive(Debug)]
pub struct InertiaRates<'a, T> {
    /// `Ṁ_l` of [`super::crba`].
    pub m: &'a mut [T],
    /// `Ṡ` of [`super::coupling`].
    pub s: &'a mut [T],
}

/// `Ṁ_l = C + Cᵀ` and `Ṡ = C₁ + C₂ᵀ` at a state.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn inertia_rates<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    scratch: &mut [DerivativeScratch<T>],
    out: InertiaRates<T>,
) -> Result<(), SizeError> {
    let nv = model.nv;
    let InertiaRates { m, s } = out;
    check_state(model, &state)?;
    check_scratch(model, scratch)?;
    SizeError::check("m", m.len(), nv * nv)?;
    SizeError::check("s", s.len(), nv * nv)?;
    m.fill(T::zero());
    s.fill(T::zero());
    composites(model, &state, scratch, |row, column, entry| {
        add(m, row * nv + column, entry);
        add(m, column * nv + row, entry);
    })?;
    let half = T::from_f64(0.5);
    for_each_rotor(model, scratch, |k, elastic, spin, on| {
        let rate = spin * half.mul_add(on.across, on.c);
        if elastic {
            add(s, on.column * nv + k, rate);
        } else {
            add(m, on.column * nv + k, rate);
            add(m, k * nv + on.column, rate);
        }
    });
    Ok(())
}

/// Velocities and composites; `put(row, column, entry)` for what links and rotors make of `C` without the blocks of the rotors.
fn composites<T: Scalar>(
    model: &Model<T::Param>,
    state: &State<T>,
    scratch: &mut [DerivativeScratch<T>],
    mut put: impl FnMut(usize, usize, T),
) -> Result<(), SizeError> {
    outward::<T, T, false>(
        model,
        state.q,
        |k| state.qd[k],
        |_| T::zero(),
        |body| body.inertia_with_rotors::<T>(),
        scratch,
    )?;
    for body in model.bodies {
        let Some(drive) = &body.drive else { continue };
        let k = body.v_index();
        if let Some((m, _, n)) = carrier::<T, T>(&drive.rotor, scratch) {
            let h = spin::<T, T>(&drive.rotor) * drive.spin(state.qd[k], state.thetad[k]);
            load_carrier(scratch, m, Vec3::zero(), Mat3::skew(n.scale(-h)));
        }
    }
    for (i, body) in model.bodies.iter().enumerate().rev() {
        let s = &mut scratch[i];
        s.column = s.inertia.momentum(s.axis);
        for_each_pair(model, scratch, i, |at: Entries<T>| put(at.row, at.column, at.c));
        hand_on::<T, T>(body, i, scratch);
    }
    Ok(())
}

/// `put(coordinate of the joint, elastic, N J, joint that carries)` for every rotor and every joint that carries it.
fn for_each_rotor<T: Scalar>(
    model: &Model<T::Param>,
    scratch: &[DerivativeScratch<T>],
    mut put: impl FnMut(usize, bool, T, OnCarrier<T>),
) {
    for body in model.bodies {
        let Some(Drive { rotor, elastic }) = &body.drive else { continue };
        if let Some(at) = carrier::<T, T>(rotor, scratch) {
            let spin = spin::<T, T>(rotor);
            for_each_carrying(model, scratch, at, |on| put(body.v_index(), elastic.is_some(), spin, on));
        }
    }
}

/// Forces that depend on position and velocity alone, `nv` entries each [N m or N].
#[derive(Debug)]
pub struct Bias<'a, T> {
    /// On the link side, `C q̇ + C₁ θ̇ + g`; behind a rigid gear with the rotor's own part.
    pub link: &'a mut [T],
    /// On the motors, reflected, `C₂ q̇`; zero without an elastic transmission.
    pub motor: &'a mut [T],
}

/// The forces that must act for links and motors to go on without acceleration, without friction, springs and loads; no matrix
/// is formed. `theta` is not read.
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn bias<T: Scalar>(
    model: &Model<T::Param>,
    state: State<T>,
    scratch: &mut [DerivativeScratch<T>],
    out: Bias<T>,
) -> Result<(), SizeError> {
    let Bias { link, motor } = out;
    check_state(model, &state)?;
    check_scratch(model, scratch)?;
    SizeError::check("link", link.len(), model.nv)?;
    SizeError::check("motor", motor.len(), model.nv)?;
    outward::<T, T, false>(
        model,
        state.q,
        |k| state.qd[k],
        |_| T::zero(),
        |body| body.inertia_with_rotors::<T>(),
        scratch,
    )?;
    link.fill(T::zero());
    motor.fill(T::zero());
    for body in model.bodies {
        let Some(drive) = &body.drive else { continue };
        let (k, Some((m, omega, n))) = (body.v_index(), carrier::<T, T>(&drive.rotor, scratch)) else { continue };
        // Couple N J θ̇ ω × n on the carrier, N J n·α for the motor
        let spin = spin::<T, T>(&drive.rotor);
        let own = spin * n.dot(scratch[m].a.ang);
        load_carrier(scratch, m, omega.cross(n).scale(spin * drive.spin(state.qd[k], state.thetad[k])), Mat3::zero());
        if drive.elastic.is_some() {
            motor[k] = own;
        } else {
            link[k] = own;
        }
    }
    inward(model, scratch, link);
    Ok(())
}

/// `g(q)`: the generalised forces that hold the robot at rest against gravity, `nv` entries [N m or N].
///
/// # Errors
/// [`SizeError`] if a slice does not fit the model; nothing is written then.
pub fn gravity_torques<T: Scalar>(
    model: &Model<T::Param>,
    q: &[T],
    scratch: &mut [DerivativeScratch<T>],
    g: &mut [T],
) -> Result<(), SizeError> {
    SizeError::check("q", q.len(), model.nq)?;
    check_scratch(model, scratch)?;
    SizeError::check("g", g.len(), model.nv)?;
    outward::<T, T, false>(model, q, |_| T::zero(), |_| T::zero(), |body| body.inertia_with_rotors::<T>(), scratch)?;
    g.fill(T::zero());
    inward(model, scratch, g);
    Ok(())
}

/// Tips to base: adds `Sᵀ fᶜ` to every joint's entry.
fn inward<T: Scalar>(model: &Model<T::Param>, scratch: &mut [DerivativeScratch<T>], out: &mut [T]) {
    for (i, body) in model.bodies.iter().enumerate().rev() {
        let (k, s) = (body.v_index(), scratch[i]);
        if body.joint == JointKind::Floating {
            for (out, f) in out[k..].iter_mut().zip(s.f.to_array()) {
                *out += f;
            }
            continue;
        }
        out[k] += s.axis.dot(s.f);
        if let Some(parent) = body.parent().and_then(|p| scratch.get_mut(p)) {
            parent.f += s.f;
        }
    }
}
