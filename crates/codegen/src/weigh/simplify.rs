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
    /// Largest error of a torque, as part of the largest torque of its equation.
    pub torque_error: f64,
    /// Largest error of an acceleration under the same torques, as part of the largest acceleration of its coordinate or motor.
    pub acceleration_error: f64,
    /// Whether nothing is left of the coupling of links and motors: the reduced model appeared by itself.
    pub uncoupled: bool,
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
    let (torque_error, acceleration_error) = errors(model, &simpler, samples, &dropped);
    let operations = |quantity| simpler.function(quantity).map_or(0, |f| f.operations().total());
    let report = Report {
        tolerance,
        terms: weights.len(),
        kept: kept.len(),
        restored,
        forward_operations: operations(Quantity::Forward),
        inverse_operations: operations(Quantity::Inverse),
        torque_error,
        acceleration_error,
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
fn errors(model: &ExplicitModel, simpler: &ExplicitModel, samples: &[Motion], dropped: &[Weight]) -> (f64, f64) {
    let n = model.nv();
    let terms: Vec<Term> = dropped.iter().map(|weight| Term::of(model, weight.place, weight.number)).collect();
    let of_torques = scales(model, samples);
    let mut of_accelerations = vec![0.0_f64; 2 * n];
    for at in samples {
        for i in 0..n {
            of_accelerations[i] = of_accelerations[i].max(at.qdd[i].abs());
            of_accelerations[n + i] = of_accelerations[n + i].max(at.thetadd[i].abs());
        }
    }
    let (mut torque, mut acceleration) = (0.0_f64, 0.0_f64);
    for at in samples {
        let (mut missing, inputs) = (vec![0.0; 2 * n], at.inputs(model));
        terms.iter().for_each(|term| term.add_to(model, at, &inputs, &mut missing));
        for (x, scale) in missing.iter().zip(&of_torques) {
            torque = torque.max(relative(x.abs(), *scale));
        }
        // The same torques accelerate what is left by more: what was dropped takes nothing of them.
        let Some(factor) = Factor::of(simpler, at) else { return (torque, f64::INFINITY) };
        for (x, scale) in factor.solved(&missing).iter().zip(&of_accelerations) {
            acceleration = acceleration.max(relative(x.abs(), *scale));
        }
    }
    (torque, acceleration)
}
