//! Random trees of links.

use super::{Dice, Options};
use gyroflex::model::{BodySpec, Friction, JointKind, RobotSpec};
use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};
use nalgebra::{Matrix3, Vector3};

/// A random robot, and the seed it grew from.
#[derive(Clone, Debug)]
pub struct RandomRobot {
    /// The seed.
    pub seed: u64,
    /// One entry per moving body.
    pub bodies: Vec<BodySpec>,
    /// Points of all spring tables.
    pub spring_tables: Vec<[f64; 2]>,
    /// Acceleration of gravity in world axes, of any direction [m/s²].
    pub gravity: Vec3<f64>,
}

impl RandomRobot {
    /// Grows a robot.
    pub fn new(seed: u64, options: &Options) -> Self {
        let mut dice = Dice::new(seed);
        let n = options.bodies.start() + dice.below(options.bodies.end() - options.bodies.start() + 1);
        let floating = dice.chance(options.floating);
        let down = dice.rotation() * Vector3::z() * 9.81;
        let mut robot =
            Self { seed, bodies: Vec::new(), spring_tables: Vec::new(), gravity: [down.x, down.y, down.z].into() };
        for i in 0..n {
            let body = robot.grow_body(&mut dice, options, i, floating);
            robot.bodies.push(body);
        }
        robot.add_drives(&mut dice, options);
        robot
    }

    /// The description the core lowers.
    pub fn spec(&self) -> RobotSpec<'_> {
        RobotSpec { bodies: &self.bodies, spring_tables: &self.spring_tables, gravity: self.gravity }
    }

    /// Whether the root floats.
    pub fn is_floating(&self) -> bool {
        self.bodies.first().is_some_and(|b| b.joint == JointKind::Floating)
    }

    /// Length of `q`.
    pub fn nq(&self) -> usize {
        self.bodies.iter().map(|b| b.joint.nq()).sum()
    }

    /// Length of `qd`.
    pub fn nv(&self) -> usize {
        self.bodies.iter().map(|b| b.joint.nv()).sum()
    }

    fn grow_body(&self, dice: &mut Dice, options: &Options, i: usize, floating: bool) -> BodySpec {
        let parent = match i {
            0 => None,
            _ if dice.chance(options.branching) => Some(dice.below(i)),
            _ => Some(i - 1),
        };
        let joint = match i {
            0 if floating => JointKind::Floating,
            _ if dice.chance(options.prismatic) => JointKind::Prismatic,
            _ => JointKind::Revolute,
        };
        let friction = if joint != JointKind::Floating && dice.chance(options.friction) {
            Friction::coulomb(dice.within(0.0, 2.0), dice.within(0.0, 2.0), dice.within(0.05, 0.5))
                .with_stribeck(if dice.chance(0.5) { dice.within(0.0, 1.0) } else { 0.0 }, dice.within(0.1, 1.0))
        } else {
            Friction::none()
        };
        BodySpec {
            parent,
            joint,
            axis: dice.axis(),
            // A floating root has its pose for coordinates.
            placement: if joint == JointKind::Floating { Transform::identity() } else { dice.placement(0.3) },
            inertia: inertia(dice),
            friction,
            drive: None,
        }
    }

    /// Smallest principal moment about the centre of mass of a body [kg m²].
    pub(super) fn smallest_moment(&self, body: usize) -> f64 {
        let i = self.bodies[body].inertia;
        let c = Vector3::new(i.first_moment.x, i.first_moment.y, i.first_moment.z) / i.mass;
        let r = i.rotational;
        let about_origin = Matrix3::new(r.xx, r.xy, r.xz, r.xy, r.yy, r.yz, r.xz, r.yz, r.zz);
        (about_origin + c.cross_matrix() * c.cross_matrix() * i.mass).symmetric_eigenvalues().min()
    }
}

/// Of a body of mass: moments of second order are positive, which is all the triangle inequality says.
pub(super) fn inertia(dice: &mut Dice) -> SpatialInertia<f64> {
    let mass = dice.magnitude(0.5, 10.0);
    let second = Matrix3::from_diagonal(&Vector3::from_fn(|_, _| mass * dice.within(0.04, 0.2).powi(2)));
    let turn = dice.rotation().to_rotation_matrix();
    let i = turn * (Matrix3::identity() * second.trace() - second) * turn.transpose();
    let about_com =
        SymMat3 { xx: i[(0, 0)], yy: i[(1, 1)], zz: i[(2, 2)], xy: i[(0, 1)], xz: i[(0, 2)], yz: i[(1, 2)] };
    let com = dice.vector(0.15);
    SpatialInertia::from_com(mass, [com.x, com.y, com.z].into(), about_com)
}
