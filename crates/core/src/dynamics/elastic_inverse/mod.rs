//! Inverse dynamics of a robot with elastic joints: from the motion of the links to the motions and torques of the motors
//! (PHYSICS §4; De Luca & Tomei 1996; Thümmel, Otter & Bals, eq. 1–2).
//!
//! The motor of an elastic joint must be where the transmission carries the torque that the joint needs, and to know its acceleration
//! is to know two derivatives of that torque. Everything is therefore computed as a Taylor series in time, in the sweeps of
//! [`super::rnea`]: out with the motions, in with the forces. On the way in, the torque through a joint gives the deflection of
//! its transmission, this the position of its motor, and this the couple of the rotor on its carrier, which is nearer to the base:
//! one sweep serves the complete model.
//!
//! Each body carries as many coefficients as the torques depend on ([`required_smoothness`](super::required_smoothness)).
//!
//! Cost O(n K²) for K coefficients. No allocation, no panic, no branch on values.

mod base;
mod error;
mod inward;
mod joint;
mod outward;
mod sizes;
mod transmission;

pub use error::InverseError;

use super::moving::Moving;
use super::smoothness::Smoothness;
use super::tree::Tree;
use super::{External, check_scratch_len};
use crate::Scalar;
use crate::dispatch::Kernel;
use crate::model::{Model, SizeError};
use crate::spatial::{Force, Mat3, Turn};
use joint::JointOutputs;
use sizes::{rounded, with_size};

/// A motion of the links up to some derivative.
#[derive(Clone, Copy, Debug)]
pub struct JointMotion<'a, T> {
    /// Positions: `nq` entries, as in [`State`](super::State).
    pub q: &'a [T],
    /// Their time derivatives one after the other, `q̇, q̈, q⁽³⁾, …`, `nv` entries each; of a floating root its twist in its own frame and
    /// the derivatives of those six numbers.
    pub derivatives: &'a [T],
}

/// The internal state of the inverse: deflections of elastic transmissions that are damped.
#[derive(Clone, Copy, Debug)]
pub struct Deflections<'a, T> {
    /// Deflections `δ`: `nv` entries, read at damped elastic joints [rad or m].
    pub now: &'a [T],
    /// The time after which [`ElasticInverse::deflection`] is wanted [s].
    pub step: T,
}

/// What [`elastic_inverse`] writes. Rows of `nv` entries: a quantity, then its time derivatives.
#[derive(Debug)]
pub struct ElasticInverse<'a, T> {
    /// Reflected motor positions `θ, θ̇, θ̈` and as many further derivatives as of the torques: at least three rows. Without an elastic
    /// transmission those of the joint; of a floating root zeros for a position, then its twist.
    pub theta: &'a mut [T],
    /// Torques `τ_J` that the transmissions exert on the joints, link side [N m or N]: a row, and a row a derivative.
    pub tau_j: &'a mut [T],
    /// Torques `τ` of the motors, reflected [N m or N]: as many rows.
    pub tau: &'a mut [T],
    /// Deflections after [`Deflections::step`]: `nv` entries [rad or m]; the next call's [`Deflections::now`].
    pub deflection: &'a mut [T],
    /// Their present rates: `nv` entries [rad/s or m/s].
    pub deflection_rate: &'a mut [T],
}

/// One Taylor coefficient of what the algorithm keeps for a body.
#[derive(Clone, Copy, Debug)]
pub struct ElasticInverseScratch<T> {
    /// Sine and cosine of the joint's angle.
    turn: Turn<T>,
    moving: Moving<T>,
    /// `Ω` of the body.
    field: Mat3<T>,
    /// Force that the body needs, then with all that hangs on it.
    f: Force<T>,
}

impl<T: Scalar> ElasticInverseScratch<T> {
    /// Scratch with any content.
    pub fn new() -> Self {
        Self { turn: Turn::none(), moving: Moving::at_rest(), field: Mat3::zero(), f: Force::zero() }
    }
}

impl<T: Scalar> Default for ElasticInverseScratch<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Records of scratch that [`elastic_inverse`] needs: one per coefficient of every body and of the base; `None` if it needs more
/// coefficients than there is code for.
pub fn elastic_inverse_len<P: Scalar>(model: &Model<P>, smoothness: &Smoothness) -> Option<usize> {
    Some((model.bodies.len() + 1) * rounded(smoothness.coefficients())?)
}

/// The most Taylor coefficients of accelerations there can be code for.
pub const MAX_COEFFICIENTS: usize = sizes::LARGEST;

/// Motions and torques of the motors that make the links move as asked.
///
/// `motion` must have the derivatives that `smoothness`, found for this model, names for every joint; derivatives beyond are not
/// looked at. Loads of `ext` may be given as rows as well: a quantity, then its time derivatives; those left out are zero.
/// `MAX` is the number of coefficients ([`Smoothness::coefficients`]) up to which code is generated, at most [`MAX_COEFFICIENTS`]: a controller
/// in little memory gives what its robot needs.
///
/// The deflection of a damped transmission obeys `D δ̇ = τ_J − k(δ)` and is the caller's to keep: `deflections` go in, and those a step later
/// come out, by an exponential step that is exact for straight springs up to the coefficients of `τ_J`, and stable however
/// stiff the spring is (Hochbruck & Ostermann, *Exponential integrators*, 2010, eq. 2.34 and 2.42).
///
/// # Errors
/// [`InverseError`] names the joint. What was written then means nothing.
pub fn elastic_inverse<T: Scalar, const MAX: usize>(
    model: &Model<T::Param>,
    smoothness: &Smoothness,
    motion: JointMotion<T>,
    ext: External<T>,
    deflections: Deflections<T>,
    scratch: &mut [ElasticInverseScratch<T>],
    out: ElasticInverse<T>,
) -> Result<(), InverseError> {
    let (bodies, nv) = (model.bodies, model.nv);
    let needed = smoothness.coefficients();
    let too_many = InverseError::TooManyDerivatives { needed, compiled: MAX.min(MAX_COEFFICIENTS) };
    let stride = rounded(needed).filter(|_| needed <= MAX).ok_or(too_many)?;
    let rows = 1 + smoothness.torque_derivatives;
    SizeError::check("smoothness.joints", smoothness.joints.len(), bodies.len())?;
    SizeError::check("q", motion.q.len(), model.nq)?;
    SizeError::check("theta", out.theta.len(), (2 + rows) * nv)?;
    SizeError::check("tau_j", out.tau_j.len(), rows * nv)?;
    SizeError::check("tau", out.tau.len(), rows * nv)?;
    SizeError::check("deflections", deflections.now.len(), nv)?;
    SizeError::check("deflection", out.deflection.len(), nv)?;
    SizeError::check("deflection_rate", out.deflection_rate.len(), nv)?;
    check_scratch_len(scratch, (bodies.len() + 1) * stride)?;
    let given = check_rows("derivatives", motion.derivatives.len(), nv)?;
    check_rows("external tau", ext.tau.len(), nv)?;
    check_rows("external wrenches", ext.wrenches.len(), bodies.len())?;
    for (body, order) in smoothness.joints.iter().enumerate() {
        let needed = usize::from(order.position);
        if needed > given {
            return Err(InverseError::NotSmooth { body, needed, given });
        }
    }

    let tree = Tree::of(model);
    let mut out = JointOutputs { rows, nv, out };
    let block = |body: Option<u16>| tree.joint(body).map_or(0, |i| (i + 1) * stride);
    let first_body = bodies.len() - tree.joints.len();

    // Pass 1, base to tips: motions, and the forces that the bodies need.
    with_size!(needed, MAX, N => base::Base::<T, N> { model, motion, nv, scratch: &mut *scratch });
    for (i, body) in tree.joints.iter().enumerate() {
        let (Some(order), own) = (smoothness.joints.get(first_body + i), (i + 1) * stride) else { break };
        let (before, rest) = scratch.split_at_mut_checked(own).ok_or(too_many)?;
        let parent = before.get(block(body.parent)..).unwrap_or(&[]);
        let rates = Rates { of: motion.derivatives, nv, k: body.v_index() };
        let q = motion.q.get(body.q_index()).map_or(T::zero(), |q| *q);
        with_size!(usize::from(order.motion) + 1, MAX, N => outward::Outward::<T, N> {
            body, q, rates, parent, own: rest
        });
        let wrenches = Rates { of: ext.wrenches, nv: bodies.len(), k: first_body + i };
        outward::subtract_wrench(body, wrenches, rest.get_mut(..stride).unwrap_or(&mut []));
    }

    // Pass 2, tips to base: torques, motors, and what both ask of the bodies nearer to the base.
    for (i, body) in tree.joints.iter().enumerate().rev() {
        let (Some(order), own) = (smoothness.joints.get(first_body + i), (i + 1) * stride) else { break };
        let (before, rest) = scratch.split_at_mut_checked(own).ok_or(too_many)?;
        let k = body.v_index();
        let rates = Rates { of: motion.derivatives, nv, k };
        let q = motion.q.get(body.q_index()).map_or(T::zero(), |q| *q);
        let carrier = before.get_mut(block(body.carrier())..).unwrap_or(&mut []);
        let joint = joint::Site {
            index: first_body + i,
            body,
            knots: model.knots,
            damped: order.damped,
            q,
            rates,
            tau_ext: Rates { of: ext.tau, nv, k },
            deflection: deflections.now.get(k).map_or(T::zero(), |d| *d),
            step: deflections.step,
        };
        with_size!(usize::from(order.force) + 1, MAX, N => joint::Joint::<T, N> {
            site: joint, own: rest, carrier, out: &mut out
        })?;
        // The fixed world bears whatever comes.
        let parent_order = match body.parent() {
            None => continue,
            Some(parent) => smoothness.joints.get(parent).map_or(0, |order| usize::from(order.force)),
        };
        let parent = before.get_mut(block(body.parent)..).unwrap_or(&mut []);
        with_size!(parent_order + 1, MAX, N => inward::Inward::<T, N> { body, q, rates, own: rest, parent });
    }
    if let Some(root) = tree.root {
        base::finish(root, ext, bodies.len(), motion, scratch, &mut out)?;
    }
    Ok(())
}

/// Rows of one entry each: the time derivatives of one coordinate or body.
pub(super) struct Rates<'a, X> {
    of: &'a [X],
    nv: usize,
    k: usize,
}

impl<X> Clone for Rates<'_, X> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<X> Copy for Rates<'_, X> {}

impl<'a, X> Rates<'a, X> {
    /// Row `row`, if it is given.
    #[inline(always)]
    fn row(&self, row: usize) -> Option<&'a X> {
        self.of.get(row * self.nv + self.k)
    }
}

/// How many rows of `width` entries a slice has.
fn check_rows(argument: &'static str, given: usize, width: usize) -> Result<usize, SizeError> {
    if width == 0 {
        return SizeError::check(argument, given, 0).map(|()| usize::from(u8::MAX));
    }
    let rows = given / width;
    SizeError::check(argument, given, rows * width)?;
    Ok(rows)
}
