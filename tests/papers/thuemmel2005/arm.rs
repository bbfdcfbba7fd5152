//! The arm's files, and its tip.

use gyroflex::spatial::{Motion, Transform};
use gyroflex_sim::load::source::Disk;
use gyroflex_sim::load::{LoadOptions, load};
use gyroflex_sim::robot::Link;
use gyroflex_sim::{Dynamics, Error, Robot, ScenarioFile};
use std::path::{Path, PathBuf};

/// Joints.
pub const N: usize = 7;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots/lwr").join(name)
}

/// A robot of `robots/lwr`.
///
/// # Errors
/// A file that cannot be read.
pub fn robot(name: &str) -> Result<Robot, Error> {
    load(&file(name), &LoadOptions::default())
}

/// A scenario from there.
///
/// # Errors
/// A file that cannot be read.
pub fn scenario(name: &str) -> Result<ScenarioFile, Error> {
    ScenarioFile::load(&Disk, &file(name))
}

/// Where the tip of the arm is, and how the joints move it.
pub struct Tip {
    dynamics: Dynamics,
    link: Link,
}

impl Tip {
    /// The tip of a robot of `robots/lwr`.
    ///
    /// # Errors
    /// A robot that is not physical.
    pub fn new(robot: &Robot) -> Result<Self, Error> {
        let link = robot.links.iter().find(|l| l.name == "tool").expect("the robot has a tool").clone();
        Ok(Self { dynamics: Dynamics::new(robot.model(robot.fidelity)?), link })
    }

    /// Its pose in the world at the joint positions `q` [rad].
    ///
    /// # Errors
    /// Positions that do not fit the robot.
    pub fn pose(&self, q: &[f64]) -> Result<Transform<f64>, Error> {
        let mut poses = [Transform::identity(); N];
        self.dynamics.placements(q, &mut poses)?;
        Ok(self.link.placement.after(poses[N - 1]))
    }

    /// Its twist for unit velocity of each joint in turn, the columns of its Jacobian: in world axes, velocity of the tip itself.
    ///
    /// # Errors
    /// Positions that do not fit the robot.
    pub fn jacobian(&self, q: &[f64]) -> Result<[Motion<f64>; N], Error> {
        let axes = self.pose(q)?.rotation();
        let mut columns = [Motion::zero(); N];
        for (j, column) in columns.iter_mut().enumerate() {
            let (mut unit, mut twists) = ([0.0; N], [Motion::zero(); N]);
            unit[j] = 1.0;
            self.dynamics.velocities(q, &unit, &mut twists)?;
            let own = self.link.placement.motion(twists[N - 1]);
            *column = Motion { ang: axes * own.ang, lin: axes * own.lin };
        }
        Ok(columns)
    }
}
