//! Random states of random robots.

use super::drive::TORQUE;
use super::{Dice, RandomRobot};
use crate::State;
use gyroflex::model::{BodySpec, JointKind, SpringSpec, TransmissionError, TransmissionSpec};

impl RandomRobot {
    /// A state of this robot with all loads; `index` makes a robot's states differ.
    pub fn state(&self, index: u64) -> State {
        let seed = self.seed ^ (index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        random_point(&self.bodies, &self.spring_tables, seed)
    }
}

/// A state of any robot with all loads.
///
/// Deflections are such that transmissions carry torques of the size of the motors'. Motor coordinates of joints without an
/// elastic transmission are filled with unrelated numbers: nobody may read them.
pub fn random_point(bodies: &[BodySpec], spring_tables: &[[f64; 2]], seed: u64) -> State {
    let mut dice = Dice::new(seed);
    let nv = bodies.iter().map(|b| b.joint.nv()).sum();
    let mut s = State::default();
    for body in bodies {
        match body.joint {
            JointKind::Revolute => s.q.push(dice.within(-3.0, 3.0)),
            JointKind::Prismatic => s.q.push(dice.within(-0.5, 0.5)),
            JointKind::Floating => {
                let p = dice.vector(1.0);
                let o = dice.rotation();
                s.q.extend([p.x, p.y, p.z, o.i, o.j, o.k, o.w]);
            }
        }
    }
    let (mut iq, mut iv) = (0, 0);
    s.theta = (0..nv).map(|_| dice.within(-3.0, 3.0)).collect();
    for body in bodies {
        if let Some(theta) = motor_position(&mut dice, body, spring_tables, s.q[iq]) {
            s.theta[iv] = theta;
        }
        (iq, iv) = (iq + body.joint.nq(), iv + body.joint.nv());
    }
    let mut all = |size: f64| (0..nv).map(|_| dice.within(-size, size)).collect();
    s.qd = all(2.0);
    s.thetad = all(2.0);
    s.qdd = all(10.0);
    s.thetadd = all(10.0);
    s.tau = all(30.0);
    s.tau_ext = all(10.0);
    s.wrenches = (0..bodies.len()).map(|_| core::array::from_fn(|_| dice.within(-5.0, 5.0))).collect();
    s
}

/// `θ` with `θ − e(θ) = q + δ`.
fn motor_position(dice: &mut Dice, body: &BodySpec, spring_tables: &[[f64; 2]], q: f64) -> Option<f64> {
    let drive = body.drive?;
    let TransmissionSpec::Elastic { spring, error, .. } = drive.transmission else { return None };
    let stiffness = match spring {
        SpringSpec::Polynomial { stiffness, .. } => stiffness,
        SpringSpec::Table { first, .. } => {
            let [a, b] = [spring_tables[first], spring_tables[first + 1]];
            (b[1] - a[1]) / (b[0] - a[0])
        }
    };
    let target = q + dice.within(-1.0, 1.0) * TORQUE / stiffness;
    // A contraction: |e'| < 1/2.
    Some((0..60).fold(target, |theta, _| target + transmission_error(&error, drive.gear_ratio, theta)))
}

fn transmission_error(e: &TransmissionError<f64>, gear: f64, theta: f64) -> f64 {
    e.amplitude * (e.cycles_per_rotor_turn * gear * theta + e.phase).sin()
}
