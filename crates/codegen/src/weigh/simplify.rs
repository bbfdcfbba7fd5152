//! A model with the terms that matter.

use super::Motion;
use super::contribution::Term;
use super::definite::Factor;
use super::rank::{Place, Weight, rank, relative, scales};
use crate::explicit::ExplicitModel;
use crate::quantity::Quantity;
use rustc_hash::FxHashSet;

/// A simpler model, and what it costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Simplified {
    /// The model.
    pub model: ExplicitModel,
    /// What it costs.
    pub report: Report,
}

/// What a simpler model costs along the motion for which it was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// The tolerance that was asked for.
    pub tolerance: f64,
    /// Terms of the whole model.
    pub terms: usize,
    /// Terms that were kept.
    pub kept: usize,
    /// Terms below the tolerance that were taken back, because without them the inertia matrix was not positive definite.
    pub restored: usize,
    /// Operations of forward dynamics.
    pub forward_operations: usize,
    /// Operations of inverse dynamics.
    pub inverse_operations: usize,
    /// Largest errors of the torques of all equations, of coordinates, then of motors, as parts of the largest torques there.
    pub torque_errors: Vec<f64>,
    /// Largest errors of the accelerations under the same torques, in the same order, as parts of the largest accelerations.
    pub acceleration_errors: Vec<f64>,
    /// Whether nothing is left of the coupling of links and motors: the reduced model appeared by itself.
    pub uncoupled: bool,
}

impl Report {
    /// The largest error of a torque, as part of the largest torque of its equation.
    pub fn torque_error(&self) -> f64 {
        self.torque_errors.iter().copied().fold(0.0, f64::max)
    }

    /// The largest error of an acceleration, as part of the largest acceleration of its coordinate or motor.
    pub fn acceleration_error(&self) -> f64 {
        self.acceleration_errors.iter().copied().fold(0.0, f64::max)
    }
}

/// Drops all terms whose contribution along a motion is below a tolerance.
///
/// Terms are dropped as wholes, so the inertia matrix stays symmetric and energy is conserved. Where the inertia matrix is not positive
/// definite any more at a sample, dropped terms of it are taken back, the weightiest first, until it is.
pub fn simplify(model: &ExplicitModel, samples: &[Motion], tolerance: f64) -> Simplified {
    let weights = rank(model, samples);
    let (mut kept, mut dropped): (Vec<Weight>, Vec<Weight>) =
        weights.iter().partition(|weight| weight.contribution >= tolerance);
    let mut simpler = reduced(model, &kept);
    let mut restored = 0;
    while dropped.iter().any(|w| w.place.is_inertia()) && !samples.iter().all(|at| Factor::of(&simpler, at).is_some()) {
        // A tenth at a time: where much is missing, one by one takes long.
        let mut many = dropped.iter().filter(|w| w.place.is_inertia()).count().div_ceil(10);
        restored += many;
        dropped.retain(|weight| {
            let back = many > 0 && weight.place.is_inertia();
            if back {
                many -= 1;
                kept.push(*weight);
            }
            !back
        });
        simpler = reduced(model, &kept);
    }
    let [torque_errors, acceleration_errors] = errors(model, &simpler, samples, &dropped);
    let operations = |quantity| simpler.function(quantity).map_or(0, |f| f.operations().total());
    let report = Report {
        tolerance,
        terms: weights.len(),
        kept: kept.len(),
        restored,
        forward_operations: operations(Quantity::Forward),
        inverse_operations: operations(Quantity::Inverse),
        torque_errors,
        acceleration_errors,
        uncoupled: model.is_coupled() && !simpler.is_coupled(),
    };
    Simplified { model: simpler, report }
}

/// The model with some of its terms.
fn reduced(model: &ExplicitModel, kept: &[Weight]) -> ExplicitModel {
    let kept: FxHashSet<(Place, usize)> = kept.iter().map(|weight| (weight.place, weight.number)).collect();
    let mut out = model.clone();
    let n = model.nv();
    for i in 0..n {
        for j in i..n {
            out.mass[model.upper(i, j)].retain(|number| kept.contains(&(Place::Mass(i, j), number)));
        }
        for j in 0..n {
            out.coupling[i * n + j].retain(|number| kept.contains(&(Place::Coupling(i, j), number)));
        }
    }
    out.potential.retain(|number| kept.contains(&(Place::Potential, number)));
    for (i, joint) in out.joints.iter_mut().enumerate() {
        let Some(transmission) = joint.drive.as_mut().and_then(|drive| drive.transmission.as_mut()) else { continue };
        transmission.damping.retain(|number| kept.contains(&(Place::Damping(i), number)));
        transmission.cubic.retain(|number| kept.contains(&(Place::Cubic(i), number)));
    }
    let modes = model.modes();
    for j in 0..modes {
        for k in 0..modes {
            let (low, high) = (j.min(k), j.max(k));
            if !kept.contains(&(Place::ModalStiffness(low, high), 0)) {
                out.modal_stiffness[j * modes + k] = 0.0;
            }
            if !kept.contains(&(Place::ModalDamping(low, high), 0)) {
                out.modal_damping[j * modes + k] = 0.0;
            }
        }
    }
    out
}

/// Largest relative errors of torques and of accelerations, by what was dropped.
fn errors(model: &ExplicitModel, simpler: &ExplicitModel, samples: &[Motion], dropped: &[Weight]) -> [Vec<f64>; 2] {
    let n = model.nv();
    let terms: Vec<Term> = dropped.iter().map(|weight| Term::of(model, weight.place, weight.number)).collect();
    let (mut asked, mut torques, mut accelerations) = (vec![0.0; 2 * n], vec![0.0; 2 * n], vec![0.0; 2 * n]);
    for at in samples {
        let (mut missing, inputs) = (vec![0.0; 2 * n], at.inputs(model));
        terms.iter().for_each(|term| term.add_to(model, at, &inputs, &mut missing));
        largest(&mut torques, &missing);
        largest(&mut asked, &[&at.qdd[..], &at.thetadd].concat());
        // Torques that what was dropped does not take accelerate what is left.
        match Factor::of(simpler, at) {
            Some(factor) => largest(&mut accelerations, &factor.solved(&missing)),
            None => accelerations.fill(f64::INFINITY),
        }
    }
    let parts = |of: &[f64], whole: &[f64]| of.iter().zip(whole).map(|(x, scale)| relative(*x, *scale)).collect();
    [parts(&torques, &scales(model, samples)), parts(&accelerations, &asked)]
}

/// Keeps the larger magnitudes.
fn largest(of: &mut [f64], new: &[f64]) {
    of.iter_mut().zip(new).for_each(|(of, new)| *of = of.max(new.abs()));
}
