//! Which friction a linear model keeps.

use crate::robot::Robot;
use gyroflex::model::Friction;

/// Which of the robot's friction acts.
///
/// Dry friction is steep at standstill: there, motors and joints are as good as stuck. A robot that moves, or is shaken out of
/// standstill as in most measurements of a frequency response, is better described without it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KeptFriction {
    /// All of it, the dry part with its slope at the operating point.
    #[default]
    All,
    /// The viscous part alone.
    Viscous,
    /// None.
    None,
}

impl KeptFriction {
    /// All of them by name.
    pub const NAMES: [(&'static str, Self); 3] = [("all", Self::All), ("viscous", Self::Viscous), ("none", Self::None)];

    /// Takes the rest away from a robot.
    pub(super) fn apply(self, robot: &mut Robot) {
        let left = |f: &mut Friction<f64>| match self {
            Self::All => {}
            Self::Viscous => *f = Friction::viscous(f.viscous),
            Self::None => *f = Friction::none(),
        };
        for body in &mut robot.bodies {
            left(&mut body.friction);
            body.drive.iter_mut().for_each(|d| left(&mut d.friction));
        }
    }

    /// Names of the joints whose dry friction counts.
    pub fn dry_joints(self, robot: &Robot) -> Vec<&str> {
        let dry = |f: &Friction<f64>| self == Self::All && f.dry;
        let joints = robot.joints.iter().zip(&robot.bodies);
        let rubs = joints.filter(|(_, b)| dry(&b.friction) || b.drive.is_some_and(|d| dry(&d.friction)));
        rubs.map(|(joint, _)| joint.name.as_str()).collect()
    }
}
