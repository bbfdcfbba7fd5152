//! Running a law over many robots, in both scalars.

use core::fmt;
use gyroflex::model::Fidelity;
use gyroflex_testkit::dense::Oracle;
use gyroflex_testkit::random::{Options, RandomRobot};
use gyroflex_testkit::tolerance::{Real, Tolerance, assert_close_above};
use gyroflex_testkit::{EnergyOracle, State};

use crate::Core;

/// One robot in one model and scalar at one state: what a law is about.
#[derive(Debug)]
pub struct Trial<'a, T: Real> {
    /// The robot.
    pub robot: &'a RandomRobot,
    /// The model.
    pub fidelity: Fidelity,
    /// The state; representable in the scalar.
    pub state: State,
    /// The core's algorithms on the robot.
    pub core: Core<T>,
    tolerance: f64,
}

impl<'a, T: Real> Trial<'a, T> {
    /// Lowers the robot and picks the part of the tolerances meant for the scalar.
    pub fn new(robot: &'a RandomRobot, fidelity: Fidelity, state: State, tolerance: Tolerance) -> Self {
        let core = Core::new(&robot.spec(), fidelity);
        // Deflections are small differences of positions: both sides must start from the same numbers.
        let state = if T::NAME == "f32" { state.rounded_to_f32() } else { state };
        Self { robot, fidelity, state, core, tolerance: T::pick(tolerance) }
    }

    /// The oracle of the same robot and model.
    pub fn oracle(&self) -> Oracle<'_> {
        Oracle::new(self.robot.spec(), self.fidelity)
    }

    /// The oracle of energies, of the same.
    pub fn energies(&self) -> EnergyOracle<'_> {
        EnergyOracle::new(self.robot.spec(), self.fidelity)
    }

    /// Asserts that two vectors agree, relative to the larger of `want` and `floor`.
    ///
    /// # Panics
    /// If they do not.
    #[track_caller]
    pub fn assert_close(&self, what: &str, got: &[f64], want: &[f64], floor: f64) {
        assert_close_above(what, self, got, want, self.tolerance, floor);
    }
}

impl<T: Real> fmt::Display for Trial<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (n, root) = (self.robot.bodies.len(), if self.robot.is_floating() { "floating" } else { "fixed" });
        let (seed, model) = (self.robot.seed, self.fidelity.name());
        write!(f, "seed {seed}, {n} bodies, {root} root, model {model}, {}", T::NAME)
    }
}

/// Shows a law `count` robots grown from consecutive seeds, at one state each.
pub fn for_trials<T: Real>(
    count: u64,
    options: &Options,
    fidelities: &[Fidelity],
    tolerance: Tolerance,
    law: impl Fn(&Trial<'_, T>),
) {
    for seed in 0..count {
        let robot = RandomRobot::new(seed, options);
        for &fidelity in fidelities {
            law(&Trial::new(&robot, fidelity, robot.state(0), tolerance));
        }
    }
}

/// Robots for single precision: few enough bodies that the condition of their inertia matrix leaves it some digits.
pub fn small() -> Options {
    Options { bodies: 1..=8, ..Options::default() }
}
