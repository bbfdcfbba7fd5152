//! Running a law over many robots.

use core::fmt;
use gyroflex::model::Fidelity;
use gyroflex_testkit::random::{Options, RandomRobot};

/// Where a law was when it broke: enough to grow the same robot again.
#[derive(Clone, Copy, Debug)]
pub struct Context<'a> {
    robot: &'a RandomRobot,
    fidelity: Fidelity,
    scalar: &'static str,
}

impl<'a> Context<'a> {
    /// A robot, the model and the scalar it is looked at in.
    pub fn new(robot: &'a RandomRobot, fidelity: Fidelity, scalar: &'static str) -> Self {
        Self { robot, fidelity, scalar }
    }
}

impl fmt::Display for Context<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (n, root) = (self.robot.bodies.len(), if self.robot.is_floating() { "floating" } else { "fixed" });
        write!(f, "seed {}, {n} bodies, {root} root, model {}, {}", self.robot.seed, self.fidelity.name(), self.scalar)
    }
}

/// Grows `count` robots from consecutive seeds and shows each to the law.
pub fn for_robots(count: u64, first_seed: u64, options: &Options, mut law: impl FnMut(&RandomRobot)) {
    for seed in first_seed..first_seed + count {
        law(&RandomRobot::new(seed, options));
    }
}
