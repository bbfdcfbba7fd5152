//! Linear-quadratic regulators: state feedback that holds a robot at a pose, for a controller that ticks.
//!
//! Of the linear model about the pose, sampled with torques held in between ([`zero_order_hold`]), the regulator `u = −K x` is the one
//! with the least `Σ xᵀ Q x + uᵀ R u` over all samples to come. The weights are Bryson's: the reciprocal squares of deviations that
//! are as bad as each other (Bryson, Ho, *Applied Optimal Control*, Hemisphere 1975, §5.2).

mod riccati;

pub use riccati::{Riccati, riccati};

use crate::error::{Error, ErrorKind};
use crate::linearize::{KeptFriction, Layout, Linearization, Linearizer, OperatingPoint, zero_order_hold};
use crate::robot::Robot;
use nalgebra::{DMatrix, DVector};

/// Deviations that are as bad as each other, all above zero. Positions and velocities may be infinite, which makes them free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviations {
    /// Of link positions, `q` [rad or m].
    pub link_position: f64,
    /// Of link velocities, `q̇` [rad/s or m/s].
    pub link_velocity: f64,
    /// Of reflected motor positions behind elastic transmissions, `θ` [rad or m].
    pub motor_position: f64,
    /// Of their velocities, `θ̇` [rad/s or m/s].
    pub motor_velocity: f64,
    /// Of reflected motor torques, `τ` [N m or N].
    pub torque: f64,
}

impl Default for Deviations {
    /// A milliradian, a tenth of a radian a second, ten newton metres.
    fn default() -> Self {
        Self { link_position: 1e-3, link_velocity: 0.1, motor_position: 1e-3, motor_velocity: 0.1, torque: 10.0 }
    }
}

/// A regulator about an operating point.
#[derive(Clone, Debug, PartialEq)]
pub struct Regulator {
    /// `K`, a row an input, a column a state: `u = −K x` in the order of [`Linearizer::layout`].
    pub gain: DMatrix<f64>,
    /// `X`: from `x` to rest costs `xᵀ X x` [–].
    pub cost: DMatrix<f64>,
    /// `A` of the sampled model.
    pub a: DMatrix<f64>,
    /// `B` of the sampled model.
    pub b: DMatrix<f64>,
    /// Largest size of an eigenvalue of `A − B K` [–], below 1.
    pub radius: f64,
    /// Residual of the Riccati equation, relative to `X` [–].
    pub residual: f64,
    /// Time between two ticks [s].
    pub step: f64,
    /// What `x` and `u` deviate from.
    pub point: OperatingPoint,
}

impl Regulator {
    /// For a robot in its own model at rest at the positions `q` (`nq` entries), without dry friction, `rate` ticks a second [Hz].
    ///
    /// # Errors
    /// Positions, a rate or deviations that make no sense, a floating root, and a robot that cannot be held.
    pub fn new(robot: &Robot, q: &[f64], rate: f64, deviations: &Deviations) -> Result<Self, Error> {
        let mut linearizer = Linearizer::new(robot, robot.fidelity, KeptFriction::Viscous)?;
        let point = linearizer.equilibrium_at(q)?;
        let linear = linearizer.linearize(&point, &crate::linearize::Output::defaults())?;
        Self::of(&linear, linearizer.layout(), rate, deviations)
    }

    /// For a linear model in continuous time with the states of `layout`.
    ///
    /// # Errors
    /// Like [`Regulator::new`], and a model that is sampled.
    pub fn of(linear: &Linearization, layout: &Layout, rate: f64, deviations: &Deviations) -> Result<Self, Error> {
        deviations.check()?;
        if !(rate.is_finite() && rate > 0.0) {
            return Err(fault("rate", format!("it is {rate} Hz"), "give a number of ticks a second above zero"));
        }
        if linear.step.is_some() {
            return Err(fault("model", "it is sampled".to_owned(), "give the model in continuous time"));
        }
        if layout.floating() {
            let problem = "its root floats, and no motor holds it".to_owned();
            return Err(fault("robot", problem, "fix the root"));
        }
        let step = rate.recip();
        let (a, b) = zero_order_hold(&linear.a, &linear.b, step)?;
        let q = DMatrix::from_diagonal(&deviations.state_weights(layout));
        let r = DMatrix::from_diagonal_element(b.ncols(), b.ncols(), deviations.torque.powi(-2));
        let solved = riccati(&a, &b, &q, &r, &|i| linear.states[i].clone())?;
        let Riccati { x: cost, gain, radius, residual } = solved;
        Ok(Self { gain, cost, a, b, radius, residual, step, point: linear.point.clone() })
    }
}

impl Deviations {
    /// The diagonal of `Q`.
    fn state_weights(&self, layout: &Layout) -> DVector<f64> {
        let (nv, half) = (layout.nv(), layout.positions());
        DVector::from_fn(2 * half, |i, _| {
            let [link, motor] = match i < half {
                true => [self.link_position, self.motor_position],
                false => [self.link_velocity, self.motor_velocity],
            };
            if i % half < nv { link.powi(-2) } else { motor.powi(-2) }
        })
    }

    fn check(&self) -> Result<(), Error> {
        let all = [
            ("link_position", self.link_position),
            ("link_velocity", self.link_velocity),
            ("motor_position", self.motor_position),
            ("motor_velocity", self.motor_velocity),
            ("torque", self.torque),
        ];
        // The square of a number outside of these bounds is no weight.
        let usable = |x: f64| (1e-100..=1e100).contains(&x);
        match all.into_iter().find(|(name, x)| !(usable(*x) || *x == f64::INFINITY && *name != "torque")) {
            None => Ok(()),
            Some((name, x)) => {
                Err(fault(name, format!("the allowed deviation is {x}"), "give a number above zero, in SI units"))
            }
        }
    }
}

fn fault(element: &str, problem: String, remedy: &str) -> Error {
    Error {
        kind: ErrorKind::Shape,
        file: String::new(),
        element: element.to_owned(),
        problem,
        remedy: remedy.to_owned(),
    }
}
