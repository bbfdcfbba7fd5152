//! Seeded random robots and states: the same seed and options give the same robot on every machine.

mod beams;
mod constraint;
mod drive;
mod flexible;
mod robot;
mod state;

pub use constraint::anchored_at;
pub use flexible::{FlexibleOptions, RandomFlexible, with_random_modes};
pub use robot::RandomRobot;
pub use state::random_point;

use core::ops::RangeInclusive;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use gyroflex::spatial::{Mat3, Transform, Vec3};

/// What random robots may have. Numbers are probabilities, zero switching a feature off.
#[derive(Clone, Debug)]
pub struct Options {
    /// How many bodies.
    pub bodies: RangeInclusive<usize>,
    /// The root floats.
    pub floating: f64,
    /// A joint is prismatic.
    pub prismatic: f64,
    /// A body hangs on any earlier one instead of on the one before it.
    pub branching: f64,
    /// A joint has a drive.
    pub driven: f64,
    /// A drive has an elastic transmission, not a rigid gear.
    pub elastic: f64,
    /// A rotor sits on an ancestor other than the parent, or on the world.
    pub remote_mount: f64,
    /// A remote rotor is allowed behind a rigid gear, in any model.
    pub remote_rigid: bool,
    /// The link's inertia contains the rotor.
    pub contained: f64,
    /// A spring stiffens with the third power of its deflection.
    pub cubic: f64,
    /// A spring is a table.
    pub table: f64,
    /// A transmission is damped.
    pub damping: f64,
    /// A gear has a transmission error.
    pub transmission_error: f64,
    /// A shaft, on either side, has friction.
    pub friction: f64,
}

impl Default for Options {
    /// Everything, mixed.
    fn default() -> Self {
        Self {
            bodies: 1..=30,
            floating: 0.25,
            prismatic: 0.2,
            branching: 0.3,
            driven: 0.8,
            elastic: 0.7,
            remote_mount: 0.25,
            remote_rigid: true,
            contained: 0.2,
            cubic: 0.3,
            table: 0.2,
            damping: 0.6,
            transmission_error: 0.3,
            friction: 0.5,
        }
    }
}

impl Options {
    /// No motion of theirs costs energy: no friction, no damping.
    pub fn lossless(self) -> Self {
        Self { damping: 0.0, friction: 0.0, ..self }
    }
}

/// The generator, with the distributions robots are made of.
struct Dice(ChaCha8Rng);

impl Dice {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    fn chance(&mut self, p: f64) -> bool {
        self.0.random_bool(p)
    }

    fn below(&mut self, n: usize) -> usize {
        self.0.random_range(0..n)
    }

    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        self.0.random_range(lo..hi)
    }

    /// Uniform on a logarithmic scale.
    fn magnitude(&mut self, lo: f64, hi: f64) -> f64 {
        self.within(lo.ln(), hi.ln()).exp()
    }

    fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.within(-size, size))
    }

    fn rotation(&mut self) -> UnitQuaternion<f64> {
        loop {
            let q = Quaternion::from_vector(nalgebra::Vector4::from_fn(|_, _| self.within(-1.0, 1.0)));
            if (0.1..1.0).contains(&q.norm()) {
                return UnitQuaternion::from_quaternion(q);
            }
        }
    }

    /// Often a coordinate axis of either direction, as in real robots.
    fn axis(&mut self) -> Vec3<f64> {
        if self.chance(0.4) {
            let mut a = [0.0; 3];
            a[self.below(3)] = self.sign();
            return a.into();
        }
        let v = self.rotation() * Vector3::z();
        [v.x, v.y, v.z].into()
    }

    /// Right angles as files have them: to so many digits.
    fn quarter_turns(&mut self) -> Mat3<f64> {
        let [roll, pitch, yaw] = [(); 3].map(|()| {
            let error = self.sign() * self.magnitude(1e-17, 1e-2);
            (self.below(4) as f64).mul_add(core::f64::consts::FRAC_PI_2, error)
        });
        Mat3::from_rpy(roll, pitch, yaw)
    }

    fn placement(&mut self, size: f64) -> Transform<f64> {
        let p = self.vector(size);
        let rotation = match self.within(0.0, 1.0) {
            x if x < 0.3 => Mat3::identity(),
            x if x < 0.5 => self.quarter_turns(),
            _ => matrix(self.rotation()),
        };
        Transform::from_pose(rotation, [p.x, p.y, p.z].into())
    }
}

fn matrix(q: UnitQuaternion<f64>) -> Mat3<f64> {
    let r = q.to_rotation_matrix();
    let row = |i: usize| Vec3::new(r[(i, 0)], r[(i, 1)], r[(i, 2)]);
    Mat3::from_rows(row(0), row(1), row(2))
}
