//! Figure 7, right: a square in space.

use crate::arm::{N, Tip, robot};
use crate::following::{Motion, ROBOT};
use gyroflex::control::reference::{PointToPoint, Reference};
use gyroflex::spatial::{Transform, Vec3};
use gyroflex_sim::Error;
use gyroflex_sim::scenario::{JointReference, References};
use nalgebra::{SMatrix, SVector};

/// Corners beyond the start, in the order passed, from the centre [m]; seen from above they are passed clockwise.
const CORNERS: [[f64; 2]; 4] = [[-HALF, HALF], [HALF, HALF], [HALF, -HALF], [-HALF, -HALF]];
/// Half a side [m].
pub const HALF: f64 = 0.1;
/// Pose whose tip is the centre [rad]: the tool points down.
const CENTRE: [f64; N] = [0.0, 0.45, 0.0, 1.5, 0.0, std::f64::consts::PI - 1.95, 0.0];
/// How long the arm rests before the first side [s].
const BEFORE: f64 = 0.1;
/// Duration of a side [s], and of half a side.
const SIDE: [f64; 2] = [1.1, 0.8];
/// How long the arm is watched afterwards [s].
const AFTER: f64 = 0.5;
/// Time between two points of the joints' splines [s], and their degree.
const SPACING: f64 = 0.02;
const DEGREE: usize = 9;
/// Vanishing derivatives where a side begins and ends.
const ORDER: usize = 6;
/// Damping of the least squares [–], and steps from one point to the next.
const DAMPING: f64 = 1e-4;
const STEPS: usize = 20;

/// The square, and the motion of the joints around it.
pub struct Square {
    /// Its centre [m].
    pub centre: Vec3<f64>,
    /// The motion.
    pub motion: Motion,
}

impl Square {
    /// Finds positions of the joints along the square for a tool that keeps its orientation and an elbow that stays in its plane.
    ///
    /// # Errors
    /// Files that cannot be read.
    pub fn new() -> Result<Self, Error> {
        let robot = robot(ROBOT)?;
        let tip = Tip::new(&robot)?;
        let centre = tip.pose(&CENTRE)?;
        let end = BEFORE + 3.0 * SIDE[0] + 2.0 * SIDE[1];
        let times: Vec<f64> = (0..=(end / SPACING).round() as usize).map(|i| i as f64 * SPACING).collect();
        let mut q = CENTRE;
        let mut positions: [Vec<f64>; N] = Default::default();
        for t in &times {
            let wanted = Transform { pos: centre.pos + place(*t), ..centre };
            q = reach(&tip, wanted, q)?;
            positions.iter_mut().zip(q).for_each(|(all, q)| all.push(q));
        }
        let mut reference = References::default();
        for (joint, positions) in robot.joints.iter().zip(positions) {
            let times = times.clone();
            let spline = JointReference::Waypoints { times, positions, degree: DEGREE };
            reference.joints.insert(joint.name.clone(), spline);
        }
        Ok(Self { centre: centre.pos, motion: Motion { reference, duration: end + AFTER } })
    }

    /// The point of the square that is nearest to a place [m].
    pub fn nearest(&self, place: Vec3<f64>) -> Vec3<f64> {
        let p = place - self.centre;
        let on_side = |i: usize| {
            let (a, b) = (corner(CORNERS[i]), corner(CORNERS[(i + 1) % 4]));
            let side = b - a;
            a + side.scale(((p - a).dot(side) / side.dot(side)).clamp(0.0, 1.0))
        };
        let nearer = |best: Vec3<f64>, i: usize| {
            let other = on_side(i);
            if (p - other).norm() < (p - best).norm() { other } else { best }
        };
        self.centre + (1..4).fold(on_side(0), nearer)
    }

    /// Distance of a place from there [m].
    pub fn distance(&self, place: Vec3<f64>) -> f64 {
        (place - self.nearest(place)).norm()
    }
}

fn corner([x, y]: [f64; 2]) -> Vec3<f64> {
    [x, y, 0.0].into()
}

/// Where the tip is to be at time `t` [s], from the centre [m]: from rest to rest along every side.
fn place(t: f64) -> Vec3<f64> {
    let start = [-HALF, 0.0];
    let (mut from, mut begin, mut at) = (corner(start), BEFORE, corner(start));
    for (i, to) in CORNERS.into_iter().chain([start]).enumerate() {
        let (to, duration) = (corner(to), if i % 4 == 0 { SIDE[1] } else { SIDE[0] });
        let side = PointToPoint::new(0.0, 1.0, begin, duration, ORDER).expect("a side takes its time");
        let mut s = [0.0];
        side.derivatives(t, &mut s);
        at += (to - from).scale(s[0]);
        (from, begin) = (to, begin + duration);
    }
    at
}

/// Joint positions at which the tip has this pose while joint 3 keeps the elbow where it is, near `q`: damped least squares.
fn reach(tip: &Tip, wanted: Transform<f64>, mut q: [f64; N]) -> Result<[f64; N], Error> {
    for _ in 0..STEPS {
        let (now, columns) = (tip.pose(&q)?, tip.jacobian(&q)?);
        let far = wanted.pos - now.pos;
        // Half the sum of the axes' cross products: the rotation vector when it is small.
        let mut turn = Vec3::zero();
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from) {
            turn += (now.rotation() * axis).cross(wanted.rotation() * axis).scale(0.5);
        }
        let error = [far.to_array(), turn.to_array()].concat();
        let error = SVector::<f64, N>::from_fn(|i, _| if i < 6 { error[i] } else { CENTRE[2] - q[2] });
        let jacobian = SMatrix::<f64, N, N>::from_fn(|i, j| match i {
            0..3 => columns[j].lin.to_array()[i],
            3..6 => columns[j].ang.to_array()[i - 3],
            _ => f64::from(u8::from(j == 2)),
        });
        let damped = jacobian * jacobian.transpose() + SMatrix::identity() * DAMPING.powi(2);
        let step = jacobian.transpose() * damped.cholesky().expect("it is positive definite").solve(&error);
        q.iter_mut().zip(step.iter()).for_each(|(q, s)| *q += s);
    }
    Ok(q)
}
