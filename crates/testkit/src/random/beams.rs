//! Random serial arms of slender beams.

use super::{Dice, Options, RandomFlexible, RandomRobot, flexible::point_mass};
use crate::flexible::{BendingLink, Particle, Seats, Section, Shapes};
use gyroflex::model::{
    BodySpec, DriveSpec, Friction, JointKind, MountSpec, RotorBody, RotorSpec, SpringSpec, TransmissionError,
    TransmissionSpec,
};
use gyroflex::spatial::{SpatialInertia, Transform, Vec3};
use nalgebra::DMatrix;

/// Particles of a beam.
const PARTICLES: usize = 6;

impl RandomFlexible {
    /// A serial arm of `n` revolute joints and straight beams along `x`, each with one to four modes of bending, stretch and torsion in
    /// one; with `elastic`, linear elastic joints whose rotors, if any, are the point masses at the end of the beam before.
    pub fn beams(seed: u64, n: usize, elastic: bool) -> Self {
        let mut dice = Dice::new(seed ^ 0x51ab_0de5);
        // For its gravity.
        let robot = RandomRobot::new(seed, &Options { bodies: 0..=0, floating: 0.0, ..Options::default() });
        let mut out = Self { robot, links: Vec::new(), seats: Vec::new() };
        let mut end = Transform::identity();
        for body in 0..n {
            let rotation = super::matrix(dice.rotation());
            let link = beam(&mut dice, body);
            let placement = Transform::from_pose(rotation, end.pos);
            end.pos = link.sections[0].at;
            let parent = body.checked_sub(1);
            out.robot.bodies.push(BodySpec {
                parent,
                joint: JointKind::Revolute,
                // Not along the beam, which has no inertia about itself.
                axis: Vec3::new(0.0, 0.0, 1.0),
                placement,
                inertia: link.cloud.iter().map(point_mass).fold(SpatialInertia::zero(), |sum, p| sum + p),
                friction: Friction::none(),
                drive: elastic.then(|| drive(&mut dice)),
            });
            let joint = parent.map(|_| 0);
            out.links.push(link);
            out.seats.push(Seats { joint, rotor: None });
        }
        out
    }
}

fn beam(dice: &mut Dice, body: usize) -> BendingLink {
    let (n, length, mass) = (1 + dice.below(4), dice.within(0.3, 0.8), dice.within(0.5, 2.0));
    // Clamped at its root: stretch as x/l, bending as (x/l)² and (x/l)³, and torsion as x/l.
    let modes: Vec<[f64; 6]> = (0..n).map(|_| core::array::from_fn(|_| dice.within(-1.0, 1.0))).collect();
    let at = |x: f64| {
        let t = x / length;
        let displacement =
            |m: &[f64; 6]| Vec3::new(m[0] * t, m[1] * t * t + m[2] * t.powi(3), m[3] * t * t + m[4] * t.powi(3));
        Shapes { displacement: modes.iter().map(displacement).collect(), shortening: Vec::new() }
    };
    let particle = |k: usize| {
        let x = length * (k as f64 + 0.5) / PARTICLES as f64;
        Particle { mass: mass / PARTICLES as f64, at: Vec3::new(x, 0.0, 0.0), shapes: at(x) }
    };
    // A section turns by (torsion, −z', y').
    let turn =
        |m: &[f64; 6]| Vec3::new(2.0 * m[5], -(2.0 * m[3] + 3.0 * m[4]) / length, (2.0 * m[1] + 3.0 * m[2]) / length);
    let mut cloud: Vec<Particle> = (0..PARTICLES).map(particle).collect();
    let end = Vec3::new(length, 0.0, 0.0);
    // The next joint's rotor and housing (eq. 40 of Cetinkunt & Book).
    cloud.push(Particle { mass: dice.within(0.1, 0.5), at: end, shapes: at(length) });
    let root = DMatrix::from_fn(n, n, |_, _| dice.within(-1.0, 1.0));
    BendingLink {
        body,
        hub: SpatialInertia::zero(),
        cloud,
        sections: vec![Section {
            at: end,
            shapes: at(length),
            turns: modes.iter().map(turn).collect(),
            lump: SpatialInertia::zero(),
        }],
        stiffness: (DMatrix::identity(n, n) * 0.1 + &root * root.transpose()) * 100.0,
        damping: DMatrix::zeros(n, n),
        stiffening: false,
    }
}

/// The rotor stands beside the robot: of its spin alone, its carrier does not matter, and its mass is a particle of the beam before.
fn drive(dice: &mut Dice) -> DriveSpec {
    let inertia = dice.magnitude(1e-5, 1e-4);
    DriveSpec {
        rotor: RotorSpec {
            inertia,
            body: Some(RotorBody { mass: 0.1, transverse_inertia: inertia }),
            mount: MountSpec { body: None, placement: Transform::identity(), axis: Vec3::new(0.0, 0.0, 1.0) },
        },
        gear_ratio: dice.magnitude(20.0, 100.0),
        transmission: TransmissionSpec::Elastic {
            spring: SpringSpec::Polynomial { stiffness: dice.magnitude(1e2, 1e3), cubic: 0.0 },
            damping: 0.0,
            error: TransmissionError::none(),
        },
        friction: Friction::none(),
    }
}
