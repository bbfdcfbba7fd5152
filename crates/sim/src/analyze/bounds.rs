//! Bounds of the matrices over the joint limits, which proofs of stability and choices of gains ask for.

use super::search::{Found, largest};
use super::workspace::{Sequence, ranges};
use super::{Options, fault};
use crate::dynamics::Dynamics;
use crate::error::Error;
use crate::robot::Robot;
use gyroflex::dynamics::{CoriolisMatrices, State};
use gyroflex::model::Fidelity;
use nalgebra::DMatrix;
use serde::Serialize;

/// Bounds over the joint limits, each with where it is attained. They are the best of samples and local searches: nothing larger
/// (or smaller) was found, none is proved. Norms of robots with sliding joints mix units.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Bounds {
    /// Largest `‖M(q)‖₂`, the link side's inertia matrix in the complete model [kg m²].
    pub inertia_max: Bound,
    /// Smallest `‖M(q)‖₂` [kg m²].
    pub inertia_min: Bound,
    /// Smallest eigenvalue of `M(q)` [kg m²].
    pub eigenvalue_min: Bound,
    /// Largest `‖C(q, q̇)‖₂ / ‖q̇‖`: the whole Coriolis matrix over links and motors in Christoffel form, in the complete model, the
    /// motors turning with their joints [kg m²].
    pub coriolis_max: Bound,
    /// Largest `‖g(q)‖` [N m].
    pub gravity_max: Bound,
}

/// A bound and where it is attained.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Bound {
    /// The value.
    pub value: f64,
    /// The pose, one entry per joint [rad or m].
    pub q: Vec<f64>,
    /// The unit velocity, one entry per joint, where one counts.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub qd: Vec<f64>,
}

/// Searches for the bounds, from `options.samples` quasi-random points each.
///
/// # Errors
/// A floating root, or a robot that is not physical.
pub fn bounds(robot: &Robot, options: &Options) -> Result<Bounds, Error> {
    if robot.is_floating() {
        let problem = "the robot has a floating root, whose place has no limits".to_owned();
        return Err(fault(&robot.name, problem, "leave the bounds out, or load it with a fixed root"));
    }
    let limits: Vec<[f64; 2]> = ranges(robot, options).iter().map(|r| r.q).collect();
    let n = limits.len();
    if n == 0 {
        return Ok(Bounds::default());
    }
    robot.refuse_bending("the search for bounds", crate::bending::RIGID)?;
    let mut complete = Dynamics::new(robot.model(Fidelity::Complete)?);
    let search = |limits: &[[f64; 2]], f: &mut dyn FnMut(&[f64]) -> Result<f64, Error>| -> Result<Found, Error> {
        let mut sequence = Sequence::new(limits.len(), options.seed);
        let spread = |u: Vec<f64>| u.iter().zip(limits).map(|(u, [low, high])| low + (high - low) * u).collect();
        let found = largest((0..options.samples).map(|_| spread(sequence.next())), limits, f)?;
        found.filter(|f| f.value.is_finite()).ok_or_else(|| {
            let problem = "a bound of its matrices is not a finite number".to_owned();
            fault(&robot.name, problem, "check the size of the robot's numbers")
        })
    };
    let mut m = vec![0.0; n * n];
    let mut eigenvalues = |q: &[f64]| -> Result<[f64; 2], Error> {
        complete.mass_matrix(q, &mut m)?;
        let values = DMatrix::from_row_slice(n, n, &m).symmetric_eigenvalues();
        Ok([values.min(), values.max()])
    };
    let inertia_max = search(&limits, &mut |q| Ok(eigenvalues(q)?[1]))?;
    let inertia_min = search(&limits, &mut |q| Ok(-eigenvalues(q)?[1]))?;
    let eigenvalue_min = search(&limits, &mut |q| Ok(-eigenvalues(q)?[0]))?;

    let mut g = vec![0.0; n];
    let gravity_max = search(&limits, &mut |q| {
        complete.gravity_torques(q, &mut g)?;
        Ok(norm(&g))
    })?;
    let with_velocity: Vec<[f64; 2]> = limits.iter().copied().chain(vec![[-1.0, 1.0]; n]).collect();
    let coriolis_max = search(&with_velocity, &mut |x| {
        let (q, u) = x.split_at(n);
        coriolis_norm(&mut complete, q, &unit(u))
    })?;
    let at = |f: Found, sign: f64| Bound { value: sign * f.value, q: f.at, qd: Vec::new() };
    let (q, u) = coriolis_max.at.split_at(n);
    Ok(Bounds {
        inertia_max: at(inertia_max, 1.0),
        inertia_min: at(inertia_min, -1.0),
        eigenvalue_min: at(eigenvalue_min, -1.0),
        coriolis_max: Bound { value: coriolis_max.value, q: q.to_vec(), qd: unit(u) },
        gravity_max: at(gravity_max, 1.0),
    })
}

/// `‖[C C₁; C₂ 0]‖₂` with motors that turn with their joints.
///
/// # Errors
/// A slice that does not fit the model.
pub fn coriolis_norm(dynamics: &mut Dynamics, q: &[f64], qd: &[f64]) -> Result<f64, Error> {
    let n = qd.len();
    let [mut c, mut c1, mut c2] = [(); 3].map(|()| vec![0.0; n * n]);
    let out = CoriolisMatrices { c: &mut c, c1: &mut c1, c2: &mut c2 };
    dynamics.coriolis_matrices(State { q, qd, theta: q, thetad: qd }, out)?;
    let whole = DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => c[i * n + j],
        (true, false) => c1[i * n + j - n],
        (false, true) => c2[(i - n) * n + j],
        (false, false) => 0.0,
    });
    Ok(whole.singular_values().max())
}

fn norm(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The direction of `v`; nothing of nothing.
fn unit(v: &[f64]) -> Vec<f64> {
    let length = norm(v).max(f64::MIN_POSITIVE);
    v.iter().map(|x| x / length).collect()
}
