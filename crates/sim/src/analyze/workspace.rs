//! Motions all over the workspace: quasi-random, the same for the same seed.

use super::{Motion, Options};
use crate::coordinates::Coordinates;
use crate::random::Random;
use crate::robot::Robot;
use std::f64::consts::PI;

/// Top speeds where neither the robot nor the user gives one [rad/s], [m/s].
const SPEEDS: [f64; 2] = [2.0, 1.0];
/// Reach of a sliding joint without limits to either side [m].
const REACH: f64 = 1.0;

/// How far and how fast a joint goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lowest and highest position [rad or m].
    pub q: [f64; 2],
    /// Top speed [rad/s or m/s].
    pub speed: f64,
    /// Whether the robot or the user gave the speed.
    pub speed_given: bool,
    /// Whether the joint slides.
    pub slides: bool,
}

/// The ranges of all joints of one degree of freedom.
pub fn ranges(robot: &Robot, options: &Options) -> Vec<Range> {
    let coordinates = Coordinates::of(robot);
    let range = |body: usize| {
        let joint = &robot.joints[body];
        let slides = joint.urdf_type == "prismatic";
        let given = options.speed.filter(|_| !slides).or(joint.max_velocity.filter(|v| *v > 0.0));
        let reach = if slides { REACH } else { PI };
        Range {
            q: joint.limits.unwrap_or([-reach, reach]),
            speed: given.unwrap_or(SPEEDS[usize::from(slides)]),
            speed_given: given.is_some(),
            slides,
        }
    };
    coordinates.joints.iter().map(|c| range(c.body)).collect()
}

/// Poses within the limits, speeds up to the top speeds, accelerations that reach those in `options.rise`. Every second motion
/// has all joints at top speed and full acceleration, either way: the largest errors are there. Motors turn with the joints.
pub fn motions(robot: &Robot, ranges: &[Range], options: &Options) -> Vec<Motion> {
    let coordinates = Coordinates::of(robot);
    let (n, root) = (ranges.len(), if coordinates.floating { 6 } else { 0 });
    let mut sequence = Sequence::new(3 * n, options.seed);
    let mut motion = |i: usize| {
        let u = sequence.next();
        let full = |x: f64| if i % 2 == 1 { 1.0_f64.copysign(x) } else { x };
        let mut m = Motion { t: i as f64, qd: vec![0.0; root], qdd: vec![0.0; root], ..Motion::default() };
        if coordinates.floating {
            m.q = vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        }
        m.theta = vec![0.0; root];
        for (k, range) in ranges.iter().enumerate() {
            let [low, high] = range.q;
            let q = low + (high - low) * u[k];
            m.q.push(q);
            m.theta.push(q);
            m.qd.push(range.speed * full(2.0 * u[n + k] - 1.0));
            m.qdd.push(range.speed / options.rise * full(2.0 * u[2 * n + k] - 1.0));
        }
        (m.thetad, m.thetadd) = (m.qd.clone(), m.qdd.clone());
        m
    };
    (0..options.samples).map(&mut motion).collect()
}

/// What the user should know about the ranges.
pub(super) fn notes(robot: &Robot, ranges: &[Range], options: &Options) -> Vec<String> {
    let coordinates = Coordinates::of(robot);
    let named = |keep: &dyn Fn(&Range) -> bool| -> String {
        let joints = coordinates.names().zip(ranges).filter(|(_, r)| keep(r)).map(|(name, _)| name);
        joints.collect::<Vec<_>>().join(", ")
    };
    let mut notes = Vec::new();
    let silent = named(&|r| !r.speed_given);
    if !silent.is_empty() {
        let taken = |slides: bool| ranges.iter().any(|r| r.slides == slides && !r.speed_given);
        let turn = taken(false).then(|| format!("{:.0} deg/s", SPEEDS[0].to_degrees()));
        let slide = taken(true).then(|| format!("{} m/s", SPEEDS[1]));
        let taken = turn.into_iter().chain(slide).collect::<Vec<_>>().join(" and ");
        notes.push(format!(
            "no speed limit is given for {silent}, {taken} is taken; choose with --speed or the URDF's <limit velocity>"
        ));
    }
    let sliding = named(&|r| r.slides);
    if options.speed.is_some() && !sliding.is_empty() {
        notes.push(format!("the speed given is one of turning joints; {sliding} keep their own"));
    }
    if coordinates.floating {
        notes.push("the floating root is taken to be at rest".to_owned());
    }
    notes
}

/// Points spread evenly over a cube: an additive recurrence whose steps are powers of the generalised golden ratio, the root of
/// `x^(d+1) = x + 1` (M. Roberts, *The unreasonable effectiveness of quasirandom sequences*, 2018).
#[derive(Clone, Debug)]
pub(super) struct Sequence {
    at: Vec<f64>,
    step: Vec<f64>,
}

impl Sequence {
    /// In `dimensions` dimensions, from a point that the seed chooses.
    pub(super) fn new(dimensions: usize, seed: u64) -> Self {
        let power = 1.0 / (dimensions as f64 + 1.0);
        let golden = (0..64).fold(1.5_f64, |x, _| (1.0 + x).powf(power));
        let mut random = Random::new(seed);
        Self {
            at: (0..dimensions).map(|_| 0.5 + random.within(0.5)).collect(),
            step: (1..=dimensions as i32).map(|k| golden.powi(-k)).collect(),
        }
    }

    /// The next point, every coordinate in `[0, 1)`.
    pub(super) fn next(&mut self) -> Vec<f64> {
        for (x, step) in self.at.iter_mut().zip(&self.step) {
            *x = (*x + step).fract();
        }
        self.at.clone()
    }
}
