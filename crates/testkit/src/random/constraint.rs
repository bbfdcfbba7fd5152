//! Random constraints of random robots.

use super::{Dice, RandomRobot};
use gyroflex::dynamics::{Anchor, Constraint, Contact, Directions, Frame, Hold};
use gyroflex::model::JointKind;
use gyroflex::spatial::{Transform, Vec3};

impl RandomRobot {
    /// Constraints of this robot, with at most half as many directions as it has velocities; `index` makes them differ.
    ///
    /// Frames are held to the world or to other bodies in any directions, joints to other joints, all stabilised. Positions and velocities
    /// of a random state violate them.
    pub fn constraints(&self, index: u64) -> Vec<Constraint<f64>> {
        let mut dice = Dice::new(self.seed ^ (index + 1).wrapping_mul(0x9e6c_63d0_876a_68de));
        let (bodies, mut left) = (self.bodies.len(), self.nv() / 2);
        let mut out = Vec::new();
        for _ in 0..8 {
            let hold = if dice.chance(0.2) { self.joints(&mut dice) } else { self.frames(&mut dice, bodies) };
            let mut constraint = Constraint { hold, stabilisation: dice.within(0.0, 20.0), contact: None };
            if constraint.rows() > left || constraint.rows() == 0 {
                continue;
            }
            left -= constraint.rows();
            constraint.contact = contact(&mut dice, &hold);
            out.push(constraint);
        }
        out
    }

    fn joints(&self, dice: &mut Dice) -> Hold<f64> {
        let first = usize::from(self.bodies[0].joint == JointKind::Floating);
        let joints = self.bodies.len() - first;
        if joints < 2 {
            return self.frames(dice, self.bodies.len());
        }
        let joint = first + dice.below(joints);
        let follows = first + (joint - first + 1 + dice.below(joints - 1)) % joints;
        Hold::Joints { joint, follows, ratio: dice.within(-2.0, 2.0), offset: dice.within(-1.0, 1.0) }
    }

    fn frames(&self, dice: &mut Dice, bodies: usize) -> Hold<f64> {
        let body = dice.below(bodies);
        let other = dice.below(bodies);
        let anchor = (other != body && dice.chance(0.5)).then_some(other);
        let directions = match dice.below(4) {
            0 => Directions::ALL,
            1 => Directions::POINT,
            _ => {
                let listed: Vec<usize> = (0..6).filter(|_| dice.chance(0.4)).collect();
                Directions::of(&listed)
            }
        };
        Hold::Frame {
            frame: Frame { body, placement: dice.placement(0.3) },
            anchor: Anchor { body: anchor, placement: dice.placement(0.5) },
            directions,
        }
    }
}

/// A contact that sticks or slips, along one of the held directions.
fn contact(dice: &mut Dice, hold: &Hold<f64>) -> Option<Contact<f64>> {
    let Hold::Frame { directions, .. } = hold else { return None };
    let normals: Vec<usize> = (3..6).filter(|d| directions.contains(*d)).collect();
    if normals.is_empty() || dice.chance(0.5) {
        return None;
    }
    let normal = normals[dice.below(normals.len())];
    let slip = dice.chance(0.3).then(|| {
        let ratio = dice.vector(0.2);
        Vec3::new(ratio.x, ratio.y, ratio.z)
    });
    Some(Contact { normal, restitution: dice.within(0.0, 1.0), slip })
}

/// Where a frame is relative to its anchor must be small for its error of rotation to have the Jacobian for a derivative: the same constraint
/// with its anchor where the frame is.
pub fn anchored_at(hold: Hold<f64>, relative: Transform<f64>) -> Hold<f64> {
    match hold {
        Hold::Frame { frame, anchor, directions } => {
            Hold::Frame { frame, anchor: Anchor { placement: relative, ..anchor }, directions }
        }
        joints => joints,
    }
}
