//! Running a law over many robots with flexible links, in both scalars.

use crate::FlexibleCore;
use core::fmt;
use gyroflex::model::Fidelity;
use gyroflex_testkit::random::{FlexibleOptions, Options, RandomFlexible};
use gyroflex_testkit::tolerance::{Real, Tolerance, assert_close_above};
use gyroflex_testkit::{FlexibleOracle, State};

/// One robot in one model and scalar at one state.
#[derive(Debug)]
pub struct FlexibleTrial<'a, T: Real> {
    /// The robot.
    pub robot: &'a RandomFlexible,
    /// The model.
    pub fidelity: Fidelity,
    /// The state; representable in the scalar.
    pub state: State,
    /// The core's algorithms on the robot.
    pub core: FlexibleCore<T>,
    tolerance: f64,
}

impl<'a, T: Real> FlexibleTrial<'a, T> {
    /// Lowers the robot and picks the part of the tolerances meant for the scalar.
    pub fn new(robot: &'a RandomFlexible, fidelity: Fidelity, state: State, tolerance: Tolerance) -> Self {
        let core = FlexibleCore::new(robot, fidelity);
        // Deflections are small differences of positions: both sides must start from the same numbers.
        let state = if T::NAME == "f32" { state.rounded_to_f32() } else { state };
        Self { robot, fidelity, state, core, tolerance: T::pick(tolerance) }
    }

    /// The oracle of the same robot and model.
    pub fn oracle(&self) -> FlexibleOracle<'_> {
        self.robot.oracle(self.fidelity)
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

impl<T: Real> fmt::Display for FlexibleTrial<'_, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let robot = &self.robot.robot;
        let (n, root) = (robot.bodies.len(), if robot.is_floating() { "floating" } else { "fixed" });
        let (links, modes) = (self.robot.links.len(), self.robot.modes());
        let (seed, model) = (robot.seed, self.fidelity.name());
        write!(
            f,
            "seed {seed}, {n} bodies, {links} of them flexible with {modes} modes, {root} root, model {model}, {}",
            T::NAME
        )
    }
}

/// Shows a law `count` robots in every model, grown from consecutive seeds, at one state each.
pub fn for_flexible<T: Real>(
    count: u64,
    options: &FlexibleOptions,
    fidelities: &[Fidelity],
    tolerance: Tolerance,
    law: impl Fn(&FlexibleTrial<'_, T>),
) {
    for seed in 0..count {
        for &fidelity in fidelities {
            let robot = RandomFlexible::new(seed, &options.in_model(fidelity));
            law(&FlexibleTrial::new(&robot, fidelity, robot.state(0), tolerance));
        }
    }
}

/// Robots for single precision: few enough coordinates that the condition of their inertia matrix leaves it some digits.
pub fn small_flexible() -> FlexibleOptions {
    FlexibleOptions {
        robot: Options { bodies: 1..=4, remote_rigid: false, ..Options::default() },
        modes: 1..=3,
        ..FlexibleOptions::default()
    }
}
