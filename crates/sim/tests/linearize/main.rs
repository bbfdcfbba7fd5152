//! Laws of linear models: their derivatives, operating points, samples, modes and frequency responses.

#[path = "../arm/mod.rs"]
mod arm;
mod derivatives;
mod differences;
mod modes;
mod motion;
mod outputs;
mod points;
mod response;
mod sampled;
mod single_link;

use gyroflex::integrate::{difference, integrate};
use gyroflex_sim::linearize::{KeptFriction, Layout, Linearizer};
use gyroflex_sim::simulate::StateVec;
use gyroflex_sim::{Dynamics, Fidelity};
use nalgebra::DVector;

/// The arm in every model, with its root fixed and floating.
fn arms() -> Vec<(String, Linearizer, Dynamics)> {
    let all = [false, true].into_iter().flat_map(|floating| Fidelity::ALL.map(|model| (floating, model)));
    all.map(|(floating, model)| {
        let robot = arm::arm(floating);
        let name = format!("{}, {} root", model.name(), if floating { "floating" } else { "fixed" });
        let dynamics = Dynamics::new(robot.model(model).expect("the arm is physical"));
        (name, Linearizer::new(&robot, model, KeptFriction::All).expect("the arm is physical"), dynamics)
    })
    .collect()
}

/// Numbers between −1 and 1 without a pattern, the same ones for the same seed.
fn numbers(seed: u64, n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| (12.9898 * (seed + 1) as f64 + 78.233 * (i + 1) as f64).sin() * 43758.5453)
        .map(|x| 2.0 * x.fract() - x.signum())
        .collect()
}

/// A pose in the middle of things.
fn pose(linearizer: &Linearizer) -> Vec<f64> {
    let mut q = linearizer.zero_position();
    let joints = linearizer.layout().inputs().len();
    let first = q.len() - joints;
    if linearizer.layout().floating() {
        let (x, w) = (0.6_f64.sin(), 0.6_f64.cos());
        q[..7].copy_from_slice(&[0.3, -0.2, 0.9, 0.48 * x, -0.6 * x, 0.64 * x, w]);
    }
    q[first..].copy_from_slice(&[0.7, -0.5, 0.2]);
    q
}

/// A state that moves, its transmissions bent a little, and motor torques.
fn moving(linearizer: &Linearizer, dynamics: &Dynamics) -> (StateVec, Vec<f64>) {
    let (q, nv) = (pose(linearizer), dynamics.nv());
    let mut theta = q[q.len() - nv..].to_vec();
    theta.iter_mut().zip(numbers(1, nv)).for_each(|(t, x)| *t += 2e-3 * x);
    let state = StateVec { q, qd: numbers(2, nv), theta, thetad: numbers(3, nv) };
    (state, numbers(4, nv).iter().map(|x| 20.0 * x).collect())
}

/// The state that lies at `x` from another one.
fn displaced(dynamics: &Dynamics, layout: &Layout, from: &StateVec, x: &DVector<f64>) -> StateVec {
    let (nv, half) = (layout.nv(), layout.positions());
    let mut to = from.clone();
    integrate(&dynamics.model(), &from.q, &x.as_slice()[..nv], &mut to.q).expect("slices fit");
    (0..nv).for_each(|k| to.qd[k] += x[half + k]);
    for (i, &k) in layout.elastic().iter().enumerate() {
        to.theta[k] += x[nv + i];
        to.thetad[k] += x[half + nv + i];
    }
    to
}

/// Where a state lies from another one.
fn deviation(dynamics: &Dynamics, layout: &Layout, from: &StateVec, to: &StateVec) -> DVector<f64> {
    let (nv, half) = (layout.nv(), layout.positions());
    let mut x = DVector::zeros(2 * half);
    difference(&dynamics.model(), &from.q, &to.q, &mut x.as_mut_slice()[..nv]).expect("slices fit");
    (0..nv).for_each(|k| x[half + k] = to.qd[k] - from.qd[k]);
    for (i, &k) in layout.elastic().iter().enumerate() {
        x[nv + i] = to.theta[k] - from.theta[k];
        x[half + nv + i] = to.thetad[k] - from.thetad[k];
    }
    x
}

/// Asserts that numbers agree relative to the largest of them.
#[track_caller]
fn assert_close<'a>(
    what: &str,
    got: impl IntoIterator<Item = &'a f64>,
    want: impl IntoIterator<Item = &'a f64>,
    tolerance: f64,
) {
    let (got, want): (Vec<f64>, Vec<f64>) = (got.into_iter().copied().collect(), want.into_iter().copied().collect());
    assert_eq!(got.len(), want.len(), "{what}");
    let size = want.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    for (i, (g, w)) in got.iter().zip(&want).enumerate() {
        assert!((g - w).abs() <= tolerance * size, "{what}, entry {i}: {g} instead of {w}, beside {size}");
    }
}
