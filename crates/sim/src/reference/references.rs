//! The references of all joints of a run.

use super::{Point, Trajectory};
use gyroflex::control::reference::Reference;
use gyroflex::control::{Shaped, Shaper};

/// The most impulses of a shaper: four modes of three.
pub const MAX_IMPULSES: usize = 81;

/// One trajectory per joint in coordinate order, behind the shaper they share.
#[derive(Clone, Debug)]
pub struct References {
    pub(super) trajectories: Vec<Trajectory>,
    pub(super) shaper: Shaper<f64, MAX_IMPULSES>,
}

impl References {
    /// These trajectories, as they are.
    pub fn new(trajectories: Vec<Trajectory>) -> Self {
        Self { trajectories, shaper: Shaper::none() }
    }

    /// The same behind a shaper.
    pub fn with_shaper(self, shaper: Shaper<f64, MAX_IMPULSES>) -> Self {
        Self { shaper, ..self }
    }

    /// Number of joints.
    pub fn len(&self) -> usize {
        self.trajectories.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.trajectories.is_empty()
    }

    /// The shaper; a single impulse without one.
    pub fn shaper(&self) -> &Shaper<f64, MAX_IMPULSES> {
        &self.shaper
    }

    /// The trajectories before they are shaped.
    pub fn trajectories(&self) -> &[Trajectory] {
        &self.trajectories
    }

    /// Position, velocity and acceleration of one joint at time `t` [s]; at rest at zero where there is no such joint.
    pub fn point(&self, joint: usize, t: f64) -> Point {
        let mut out = [0.0; 3];
        self.derivatives(joint, t, &mut out);
        Point::from(out)
    }

    /// The same of all joints.
    pub fn points(&self, t: f64, out: &mut [Point]) {
        for (joint, point) in out.iter_mut().enumerate() {
            *point = self.point(joint, t);
        }
    }

    /// Position and derivatives of one joint at time `t` [s, then rad or m, per s, per s², …], whatever the length of `out`; zeros
    /// where there is no such joint.
    pub fn derivatives(&self, joint: usize, t: f64, out: &mut [f64]) {
        match self.trajectories.get(joint) {
            Some(reference) => Shaped { reference, shaper: &self.shaper }.derivatives(t, out),
            None => out.fill(0.0),
        }
    }

    /// How many derivatives of one joint's reference exist and are bounded, the last of which may jump; `None` for all.
    pub fn smoothness(&self, joint: usize) -> Option<usize> {
        self.trajectories.get(joint).and_then(Trajectory::smoothness)
    }
}
