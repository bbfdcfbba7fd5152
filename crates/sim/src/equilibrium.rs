//! Static equilibrium: the torques that hold a robot at rest, and the motor positions at which its transmissions carry them.

use crate::contact::THRESHOLD;
use crate::dynamics::Dynamics;
use crate::error::Error;
use gyroflex::dynamics::{
    Acceleration, Constrained, Constraint, External, Inverse, Regularisation, State, TorqueDistribution,
};
use gyroflex::model::{Drive, Knot, Spring};
use gyroflex::spatial::Force;

/// Solves for equilibrium, again and again without allocating.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    rest: Vec<f64>,
    tau_j: Vec<f64>,
    theta: Vec<f64>,
    tau: Vec<f64>,
}

/// What forces cost beside torques: next to nothing, but enough to determine all of them.
const NEXT_TO_NOTHING: f64 = 1e-6;
/// Part of the largest load that may be left where nothing bears it: rounding.
const UNBORNE: f64 = 1e-9;

impl Equilibrium {
    /// Room for a robot whose velocity vectors have `nv` entries.
    pub fn new(nv: usize) -> Self {
        let [rest, tau_j, theta, tau] = [(); 4].map(|()| vec![0.0; nv]);
        Self { rest, tau_j, theta, tau }
    }

    /// Writes the reflected motor positions `theta` at which the transmissions hold the links at `q` against gravity and `ext`,
    /// and the motor torques `tau` that hold the motors there; both have `nv` entries. Without an elastic transmission
    /// `theta` is the joint's own position. Modes of links that bend are held where they are: `tau` has the forces on them. On a floating root `tau` is the wrench that would hold it.
    ///
    /// # Errors
    /// A slice that does not fit the model.
    pub fn solve(
        &mut self,
        dynamics: &mut Dynamics,
        q: &[f64],
        ext: External<f64>,
        theta: &mut [f64],
        tau: &mut [f64],
    ) -> Result<(), Error> {
        let rest = self.rest.as_slice();
        let state = State { q, qd: rest, theta: rest, thetad: rest };
        let accel = Acceleration { qdd: rest, thetadd: rest };
        dynamics.inverse(state, accel, ext, Inverse { tau_j: &mut self.tau_j, tau })?;
        self.motors(dynamics, q, theta, tau);
        Ok(())
    }

    /// Reflected motor positions at which a robot stands that is held beside its joints, while its motors bear as little as they can: nothing where
    /// there are none. Joints without a drive and a floating root bear nothing. The forces of what is held are in `multipliers` then.
    ///
    /// # Errors
    /// A slice or a constraint that does not fit the model.
    pub fn held(
        &mut self,
        dynamics: &mut Dynamics,
        q: &[f64],
        ext: External<f64>,
        (constraints, multipliers): (&[Constraint<f64>], &mut [f64]),
    ) -> Result<Option<&[f64]>, Error> {
        let (nv, model) = (self.rest.len(), dynamics.model());
        let driven = |k: usize| model.bodies().iter().any(|body| body.v_index() == k && body.drive.is_some());
        let passive: Vec<usize> = (0..nv).filter(|k| !driven(*k)).collect();
        let (ones, costs) = (vec![1.0; nv], vec![NEXT_TO_NOTHING; multipliers.len()]);
        let distribution = TorqueDistribution { torques: &ones, passive: &passive, multipliers: &costs, wanted: &[] };
        let rest = self.rest.as_slice();
        let mut wrenches = vec![Force::zero(); constraints.len()];
        dynamics.constrained_inverse(
            State { q, qd: rest, theta: rest, thetad: rest },
            Acceleration { qdd: rest, thetadd: rest },
            ext,
            constraints,
            distribution,
            Regularisation::rank_revealing(THRESHOLD),
            Inverse { tau_j: &mut self.tau_j, tau: &mut self.tau },
            Constrained { multipliers: &mut *multipliers, wrenches: &mut wrenches },
        )?;
        let borne = self.tau_j.iter().chain(&*multipliers).fold(1.0, |most: f64, x| most.max(x.abs()));
        if !passive.iter().all(|k| self.tau_j[*k].abs() <= UNBORNE * borne) {
            return Ok(None);
        }
        let (mut theta, mut tau) = (std::mem::take(&mut self.theta), std::mem::take(&mut self.tau));
        self.motors(dynamics, q, &mut theta, &mut tau);
        (self.theta, self.tau) = (theta, tau);
        Ok(Some(&self.theta))
    }

    /// Where the motors are, and what holds them there, while the transmissions exert `tau_j`.
    fn motors(&self, dynamics: &Dynamics, q: &[f64], theta: &mut [f64], tau: &mut [f64]) {
        let model = dynamics.model();
        // A mode has no motor.
        theta[model.nv()..].copy_from_slice(&q[model.nq()..]);
        for body in model.bodies() {
            let (i, k) = (body.q_index(), body.v_index());
            if body.joint.nv() != 1 {
                theta[k..k + body.joint.nv()].fill(0.0);
                continue;
            }
            theta[k] = q[i];
            if let Some(drive) = body.drive.as_ref().filter(|d| d.elastic.is_some()) {
                let (position, share) = motor_position(drive, model.knots(), q[i], self.tau_j[k]);
                theta[k] = position;
                tau[k] = share * self.tau_j[k];
            }
        }
    }

    /// Torques through the transmissions at the last equilibrium, `nv` entries [N m or N].
    pub fn tau_j(&self) -> &[f64] {
        &self.tau_j
    }
}

/// The reflected motor position at which the transmission exerts `tau_j` on a joint at `q`, and `1 − e'` there, the share of
/// that torque the motor feels. Without an elastic transmission: `q` and 1.
pub fn motor_position(drive: &Drive<f64>, knots: &[Knot<f64>], q: f64, tau_j: f64) -> (f64, f64) {
    let Some(elastic) = &drive.elastic else { return (q, 1.0) };
    let target = q + deflection(&elastic.spring, knots, tau_j);
    let Some(error) = &elastic.error else { return (target, 1.0) };
    // θ − e(θ) = q + δ, and |e| ≤ A.
    let ratio = drive.rotor.gear_ratio;
    let reach = error.amplitude.abs();
    let theta = root(target - reach, target + reach, target, |theta| {
        let (e, slope) = error.value_and_slope(theta, ratio);
        (theta - e - target, 1.0 - slope)
    });
    (theta, 1.0 - error.value_and_slope(theta, ratio).1)
}

/// The deflection at which a spring exerts `torque`.
pub fn deflection(spring: &Spring<f64>, knots: &[Knot<f64>], torque: f64) -> f64 {
    let residual = |d: f64| (spring.torque(d, knots) - torque, spring.slope(d, knots));
    // k increases strictly: widen until the root is inside.
    let guess = torque / spring.stiffness;
    let mut reach = guess.abs();
    while reach > 0.0 && reach < f64::MAX && (residual(reach).0 < 0.0 || residual(-reach).0 > 0.0) {
        reach *= 2.0;
    }
    root(-reach, reach, guess, residual)
}

/// The root between `low` and `high` of an increasing function given with its slope: Newton's method, and bisection where
/// that would leave the bracket.
fn root(mut low: f64, mut high: f64, guess: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = guess;
    for _ in 0..MAX_ITERATIONS {
        let (value, slope) = f(x);
        if value == 0.0 {
            break;
        }
        if value > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - x).abs() <= f64::EPSILON * x.abs() {
            return next;
        }
        x = next;
    }
    x
}

/// Bisection alone closes any bracket of doubles in about a thousand halvings; Newton needs a handful.
const MAX_ITERATIONS: usize = 1100;
