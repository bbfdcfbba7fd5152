//! Lagrange's equations of anything whose points are known functions of its coordinates, by automatic differentiation.

use crate::Dual;
use gyroflex::Scalar;
use gyroflex::spatial::Vec3;
use nalgebra::{DMatrix, DVector};

/// `weight · ȧ·ḃ`: a part of a kinetic energy, by two points that move.
#[derive(Clone, Copy, Debug)]
pub struct Pair<T> {
    /// What the product counts: half the mass of a point, if both are that point.
    pub weight: f64,
    /// One point.
    pub a: Vec3<T>,
    /// The other.
    pub b: Vec3<T>,
}

/// A mechanism: where its points are and what potential its forces have. Nothing in it says how anything moves.
pub trait Mechanism {
    /// All pairs of points that the kinetic energy is the sum of, at the configuration `x`.
    fn pairs<T: Scalar<Param = f64>>(&self, x: &[T]) -> Vec<Pair<T>>;

    /// Potential energy [J].
    fn potential<T: Scalar<Param = f64>>(&self, x: &[T]) -> T;

    /// `ẋ` of the velocities `u`: where these are the rates of coordinates, they themselves.
    fn rates<T: Scalar<Param = f64>>(&self, _x: &[T], u: &[f64]) -> Vec<T> {
        u.iter().map(|u| T::from_f64(*u)).collect()
    }

    /// `[a, b]` of two velocities, which vanishes where these are the rates of coordinates.
    fn bracket(&self, a: &DVector<f64>, _b: &DVector<f64>) -> DVector<f64> {
        DVector::zeros(a.len())
    }
}

/// `M u̇ + h = Q`.
#[derive(Clone, Debug)]
pub struct Equations {
    /// `M`.
    pub mass: DMatrix<f64>,
    /// `h`: forces of inertia due to velocities, and the slopes of the potential.
    pub bias: DVector<f64>,
}

/// `M`: the kinetic energy polarised on unit velocities.
pub fn mass_matrix(mechanism: &impl Mechanism, x: &[f64], size: usize) -> DMatrix<f64> {
    let x: Vec<Dual> = x.iter().map(|x| Dual::from_f64(*x)).collect();
    let unit: Vec<_> = (0..size).map(|k| motion(mechanism, &x, &unit(size, k))).collect();
    DMatrix::from_fn(size, size, |i, j| polarised(&unit[i], &unit[j]).value)
}

/// `T` [J].
pub fn kinetic(mechanism: &impl Mechanism, x: &[f64], u: &DVector<f64>) -> f64 {
    let x: Vec<Dual> = x.iter().map(|x| Dual::from_f64(*x)).collect();
    let motion = motion(mechanism, &x, u);
    0.5 * polarised(&motion, &motion).value
}

/// Lagrange's equations, Hamel's where the velocities are not the rates of coordinates: with the momentum `p = ∂T/∂u` and the slopes
/// `E_i` along unit velocities, `ṗ_i − p·[u, e_i] − E_i T + E_i U = Q_i`.
pub fn equations(mechanism: &impl Mechanism, x: &[f64], u: &DVector<f64>) -> Equations {
    let size = u.len();
    let mass = mass_matrix(mechanism, x, size);
    let momentum = &mass * u;
    let moving = along(mechanism, x, u);
    let now = motion(mechanism, &moving, u);
    let bias = DVector::from_fn(size, |i, _| {
        let e = unit(size, i);
        let rate = polarised(&motion(mechanism, &moving, &e), &now).slope;
        let there = along(mechanism, x, &e);
        let same = motion(mechanism, &there, u);
        rate - momentum.dot(&mechanism.bracket(u, &e)) - 0.5 * polarised(&same, &same).slope
            + mechanism.potential(&there).slope
    });
    Equations { mass, bias }
}

/// The configuration on its way with the velocity `u`.
pub fn along(mechanism: &impl Mechanism, x: &[f64], u: &DVector<f64>) -> Vec<Dual> {
    let rates = mechanism.rates(x, u.as_slice());
    x.iter().zip(rates).map(|(x, rate)| Dual::new(*x, rate)).collect()
}

/// The unit velocity `k`.
pub fn unit(size: usize, k: usize) -> DVector<f64> {
    DVector::from_fn(size, |i, _| f64::from(u8::from(i == k)))
}

/// Velocities of all pairs, from a place that may be on its way itself.
fn motion(mechanism: &impl Mechanism, x: &[Dual], u: &DVector<f64>) -> Vec<Pair<Dual>> {
    let rates = mechanism.rates(x, u.as_slice());
    let moving: Vec<Dual<Dual>> = x.iter().zip(rates).map(|(x, rate)| Dual::new(*x, rate)).collect();
    let velocity = |p: Vec3<Dual<Dual>>| p.map(|x| x.slope);
    let of = |p: Pair<Dual<Dual>>| Pair { weight: p.weight, a: velocity(p.a), b: velocity(p.b) };
    mechanism.pairs(&moving).into_iter().map(of).collect()
}

/// Twice the kinetic energy, polarised on two motions from the same place.
fn polarised(m: &[Pair<Dual>], n: &[Pair<Dual>]) -> Dual {
    let of = |(p, q): (&Pair<Dual>, &Pair<Dual>)| (p.a.dot(q.b) + p.b.dot(q.a)) * Dual::from_f64(p.weight);
    m.iter().zip(n).map(of).fold(Dual::zero(), |sum, t| sum + t)
}
