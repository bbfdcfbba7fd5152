//! Random states inside a robot's limits.

use crate::coordinates::Coordinates;
use crate::random::Random;
use crate::robot::Robot;
use std::f64::consts::PI;

/// How many, so that no branch predictor learns one by heart.
pub(super) const STATES: usize = 1024;

/// Where limits are not given: [rad/s or m/s], and [N m or N].
const VELOCITY: f64 = 2.0;
const TORQUE: f64 = 20.0;
/// Deflection of a transmission [rad or m], and its rate.
const DEFLECTION: f64 = 1e-3;
const DEFLECTION_RATE: f64 = 1e-2;
/// Acceleration asked of inverse dynamics [rad/s² or m/s²].
const ACCELERATION: f64 = 10.0;

/// A state, and what the algorithms are asked there.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    pub(super) theta: Vec<f64>,
    pub(super) thetad: Vec<f64>,
    pub(super) tau: Vec<f64>,
    pub(super) qdd: Vec<f64>,
}

/// Always the same ones of a robot.
pub(super) fn random(robot: &Robot) -> Vec<Point> {
    let mut random = Random::new(0);
    (0..STATES).map(|_| point(robot, &mut random)).collect()
}

fn point(robot: &Robot, random: &mut Random) -> Point {
    let coordinates = Coordinates::of(robot);
    let lead = if coordinates.floating { 6 } else { 0 };
    let nv = lead + coordinates.len();
    let mut p = Point {
        q: Vec::new(),
        qd: vec![0.0; nv],
        theta: vec![0.0; nv],
        thetad: vec![0.0; nv],
        tau: vec![0.0; nv],
        qdd: vec![0.0; nv],
    };
    if coordinates.floating {
        p.q.extend((0..3).map(|_| random.within(1.0)));
        p.q.extend(random.rotation());
        p.qd[..6].fill_with(|| random.within(VELOCITY));
        p.qdd[..6].fill_with(|| random.within(ACCELERATION));
    }
    for c in &coordinates.joints {
        let joint = &robot.joints[c.body];
        let turns = joint.urdf_type != "prismatic";
        let [low, high] = joint.limits.unwrap_or(if turns { [-PI, PI] } else { [-1.0, 1.0] });
        let q = 0.5 * (low + high) + random.within(0.5 * (high - low));
        let qd = random.within(joint.max_velocity.unwrap_or(VELOCITY));
        p.q.push(q);
        (p.qd[c.v], p.theta[c.v]) = (qd, q + random.within(DEFLECTION));
        p.thetad[c.v] = qd + random.within(DEFLECTION_RATE);
        p.tau[c.v] = random.within(joint.max_torque.unwrap_or(TORQUE));
        p.qdd[c.v] = random.within(ACCELERATION);
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{LoadOptions, load};
    use std::path::Path;

    fn iiwa(floating: bool) -> Robot {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/iiwa14/robot.yaml");
        load(&path, &LoadOptions { floating, ..LoadOptions::default() }).unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn states_fill_the_limits_and_stay_inside() {
        let robot = iiwa(false);
        let points = random(&robot);
        for (i, joint) in robot.joints.iter().enumerate() {
            let [low, high] = joint.limits.expect("the iiwa's joints have limits");
            let inside = points.iter().filter(|p| (low..=high).contains(&p.q[i])).count();
            assert_eq!(inside, STATES, "{}", joint.name);
            let quarter = 0.25 * (high - low);
            let near_low = points.iter().filter(|p| p.q[i] < low + quarter).count();
            let near_high = points.iter().filter(|p| p.q[i] > high - quarter).count();
            assert!(
                near_low.min(near_high) > STATES / 8,
                "{}: {near_low} and {near_high} in the outer quarters",
                joint.name
            );
            let fastest = joint.max_velocity.expect("the iiwa's joints have velocity limits");
            assert!(points.iter().all(|p| p.qd[i].abs() <= fastest), "{}", joint.name);
        }
    }

    #[test]
    fn a_floating_root_has_a_unit_quaternion() {
        for p in random(&iiwa(true)) {
            assert_eq!((p.q.len(), p.qd.len()), (14, 13));
            let norm: f64 = p.q[3..7].iter().map(|x| x * x).sum();
            assert!((norm - 1.0).abs() < 1e-15, "{norm}");
        }
    }
}
