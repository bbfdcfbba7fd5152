//! How much every term matters along a motion.

use super::Motion;
use super::contribution::Term;
use crate::explicit::ExplicitModel;
use crate::quantity::Quantity;

/// Where a term stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Place {
    /// In `M_l`, row and column; the other way round, too.
    Mass(usize, usize),
    /// In `S`, link and motor.
    Coupling(usize, usize),
    /// In the potential energy of gravity.
    Potential,
    /// In `D` of a transmission.
    Damping(usize),
    /// In `K₃` of a transmission.
    Cubic(usize),
    /// In `K` of the modes.
    ModalStiffness(usize, usize),
    /// In `D` of the modes.
    ModalDamping(usize, usize),
}

/// A term and how much it matters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    /// Where it stands.
    pub place: Place,
    /// Which of the terms there it is.
    pub number: usize,
    /// The equation in which it matters most: of a coordinate, or, from the number of coordinates on, of a motor.
    pub equation: usize,
    /// The largest torque that it causes there along the motion, as part of the largest torque of that equation.
    pub contribution: f64,
}

/// All terms, the weightiest first.
///
/// What a term causes in an equation is what `d/dt (∂T/∂q̇) − ∂T/∂q + ∂V/∂q` makes of it, together: parts that cancel do not count. The
/// torque of an equation is that of the transmission or gear for a joint, and that of the motor for an elastic rotor. A mode is driven
/// from outside by nothing: its torque is the largest of its inertia, velocity, gravity and spring forces.
pub fn rank(model: &ExplicitModel, samples: &[Motion]) -> Vec<Weight> {
    let scales = scales(model, samples);
    let inputs: Vec<Vec<f64>> = samples.iter().map(|at| at.inputs(model)).collect();
    let mut all = Vec::new();
    let mut forces = vec![0.0; 2 * model.nv()];
    for (place, terms) in Place::all(model) {
        for number in 0..terms {
            let term = Term::of(model, place, number);
            let mut weight = Weight { place, number, equation: 0, contribution: 0.0 };
            for (at, inputs) in samples.iter().zip(&inputs) {
                forces.fill(0.0);
                term.add_to(model, at, inputs, &mut forces);
                for (equation, (force, scale)) in forces.iter().zip(&scales).enumerate() {
                    let contribution = relative(force.abs(), *scale);
                    if contribution > weight.contribution {
                        (weight.equation, weight.contribution) = (equation, contribution);
                    }
                }
            }
            all.push(weight);
        }
    }
    all.sort_by(|a, b| b.contribution.total_cmp(&a.contribution));
    all
}

/// Part of a scale; all of it where the scale is zero.
pub(super) fn relative(x: f64, scale: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x / scale }
}

/// The largest torque of every equation along the motion, of coordinates, then of motors.
pub(super) fn scales(model: &ExplicitModel, samples: &[Motion]) -> Vec<f64> {
    let (n, first) = (model.nv(), model.joints().len());
    let inverse = model.function(Quantity::Inverse).expect("explicit equations say it");
    let mut scales = vec![0.0_f64; 2 * n];
    for at in samples {
        let mut arguments = [&at.q[..], &at.qd].concat();
        if model.is_elastic() {
            arguments.extend([&at.theta[..], &at.thetad, &at.qdd, &at.thetadd].concat());
        } else {
            arguments.extend(&at.qdd);
        }
        arguments.extend(model.options().kept.iter().map(|p| p.nominal()));
        let torques = inverse.evaluate(&arguments);
        let (link, motor) = (&torques[0], torques.last().unwrap_or(&torques[0]));
        for i in 0..n {
            scales[i] = scales[i].max(link[i].abs());
            scales[n + i] = scales[n + i].max(motor[i].abs());
        }
    }
    // Of the modes, part by part.
    let kinds: [fn(Place) -> bool; 3] = [
        Place::is_inertia,
        |place| place == Place::Potential,
        |place| matches!(place, Place::ModalStiffness(..) | Place::ModalDamping(..)),
    ];
    for kind in kinds.into_iter().filter(|_| first < n) {
        let places = Place::all(model).into_iter().filter(|(place, _)| kind(*place));
        let terms: Vec<Term> = places.flat_map(|(p, terms)| (0..terms).map(move |k| Term::of(model, p, k))).collect();
        for at in samples {
            let still = Motion { qd: vec![0.0; n], thetad: vec![0.0; n], ..at.clone() };
            let falling = Motion { qdd: vec![0.0; n], thetadd: vec![0.0; n], ..at.clone() };
            for at in [&still, &falling] {
                let mut forces = vec![0.0; 2 * n];
                let inputs = at.inputs(model);
                terms.iter().for_each(|term| term.add_to(model, at, &inputs, &mut forces));
                (first..n).for_each(|i| scales[i] = scales[i].max(forces[i].abs()));
            }
        }
    }
    scales
}
