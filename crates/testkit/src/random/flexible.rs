//! Random robots some of whose links bend.

use super::{Dice, Options, RandomRobot, robot::inertia};
use crate::State;
use crate::flexible::{BendingLink, FlexibleOracle, LoweredFlexible, Particle, Seats, Section, Shapes};
use core::ops::RangeInclusive;
use gyroflex::Scalar;
use gyroflex::model::{Fidelity, ModelError, RobotSpec};
use gyroflex::spatial::{SpatialInertia, SymMat3, Vec3};
use nalgebra::DMatrix;

/// What random robots with flexible links may have, beside what [`Options`] say of their trees and drives.
#[derive(Clone, Debug)]
pub struct FlexibleOptions {
    /// The robot whose links do not bend.
    pub robot: Options,
    /// A link bends; the first one does if no other, unless this is zero.
    pub flexible: f64,
    /// Modes of a link that bends.
    pub modes: RangeInclusive<usize>,
    /// Bending shortens a link.
    pub stiffening: f64,
    /// A rotor sits on another section than its joint.
    pub apart: f64,
    /// A bent link is damped.
    pub damping: f64,
}

impl Default for FlexibleOptions {
    /// Everything, mixed, of elastic transmissions that may be anywhere.
    fn default() -> Self {
        Self {
            robot: Options { bodies: 1..=8, remote_rigid: false, ..Options::default() },
            flexible: 0.5,
            modes: 1..=5,
            stiffening: 0.5,
            apart: 0.5,
            damping: 0.7,
        }
    }
}

impl FlexibleOptions {
    /// Such that the robot is one in this model, too: where all gears are rigid, rotors sit where their joints do.
    pub fn in_model(&self, fidelity: Fidelity) -> Self {
        if fidelity.is_elastic() {
            return self.clone();
        }
        Self { robot: Options { remote_mount: 0.0, ..self.robot.clone() }, apart: 0.0, ..self.clone() }
    }

    /// No motion costs energy.
    pub fn lossless(self) -> Self {
        Self { robot: self.robot.lossless(), damping: 0.0, ..self }
    }
}

/// A random robot with flexible links.
#[derive(Clone, Debug)]
pub struct RandomFlexible {
    /// The robot whose links do not bend; inertias of flexible links with cloud and lumps.
    pub robot: RandomRobot,
    /// The links that bend.
    pub links: Vec<BendingLink>,
    /// On what joints and rotors sit, one entry per body.
    pub seats: Vec<Seats>,
}

impl RandomFlexible {
    /// Grows a robot.
    pub fn new(seed: u64, options: &FlexibleOptions) -> Self {
        let robot = RandomRobot::new(seed, &options.robot);
        let mut dice = Dice::new(seed ^ 0x7f4a_7c15_9e37_79b9);
        let mut out = Self { seats: vec![Seats::default(); robot.bodies.len()], links: Vec::new(), robot };
        for body in 0..out.robot.bodies.len() {
            let last = body + 1 == out.robot.bodies.len() && out.links.is_empty();
            if dice.chance(options.flexible) || last && options.flexible > 0.0 {
                let link = bending_link(&mut dice, options, body, out.robot.bodies[body].inertia);
                out.links.push(link);
            }
        }
        for body in 0..out.robot.bodies.len() {
            out.seat(&mut dice, options, body);
        }
        for link in &out.links {
            let whole = link.cloud.iter().map(point_mass).chain(link.sections.iter().map(|s| s.lump));
            out.robot.bodies[link.body].inertia = whole.fold(link.hub, |sum, part| sum + part);
        }
        out
    }

    /// Joint and rotor of a body sit on random sections, the rotor often on the joint's.
    fn seat(&mut self, dice: &mut Dice, options: &FlexibleOptions, body: usize) {
        let spec = &self.robot.bodies[body];
        let mount = spec.drive.and_then(|d| d.rotor.mount.body);
        let mut section = |on: Option<usize>| {
            let link = self.links.iter().find(|link| Some(link.body) == on)?;
            Some(dice.below(link.sections.len()))
        };
        let (joint, mut rotor) = (section(spec.parent), section(mount));
        let rigid = spec.drive.is_some_and(|d| matches!(d.transmission, gyroflex::model::TransmissionSpec::Rigid));
        if mount == spec.parent && (rigid || !dice.chance(options.apart)) {
            rotor = joint.filter(|_| spec.drive.is_some());
        }
        self.seats[body] = Seats { joint, rotor };
        // A rotor that the description has in the link is part of what it sits on.
        let (Some(drive), Some(section)) = (spec.drive, rotor) else { return };
        if drive.rotor.body.is_none() {
            let n = drive.rotor.mount.placement.rotation() * drive.rotor.mount.axis;
            let own = SymMat3::outer(n).scale(drive.rotor.inertia);
            let link = self.links.iter_mut().find(|link| Some(link.body) == mount).expect("a section is of a link");
            link.hub.rotational = link.hub.rotational - own;
            link.sections[section].lump.rotational += own;
        }
    }

    /// The description whose links do not bend.
    pub fn spec(&self) -> RobotSpec<'_> {
        self.robot.spec()
    }

    /// Number of modal coordinates.
    pub fn modes(&self) -> usize {
        self.links.iter().map(BendingLink::modes).sum()
    }

    /// The oracle of the robot in a model.
    pub fn oracle(&self, fidelity: Fidelity) -> FlexibleOracle<'_> {
        FlexibleOracle::new(self.spec(), &self.links, &self.seats, fidelity)
    }

    /// The core's records of the robot in a model.
    ///
    /// # Errors
    /// Whatever the core finds wrong with it.
    pub fn lower<T: Scalar>(&self, fidelity: Fidelity) -> Result<LoweredFlexible<T>, ModelError> {
        LoweredFlexible::new(&self.spec(), &self.links, &self.seats, fidelity)
    }

    /// A state of this robot with all loads; motor coordinates of modes are filled with unrelated numbers.
    pub fn state(&self, index: u64) -> State {
        let seed = !self.robot.seed ^ (index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        with_random_modes(self.robot.state(index), self.modes(), seed)
    }
}

/// A state to which as many modes are added.
pub fn with_random_modes(mut s: State, modes: usize, seed: u64) -> State {
    let mut dice = Dice::new(seed);
    for (to, size) in [
        (&mut s.q, 0.05),
        (&mut s.qd, 0.5),
        (&mut s.qdd, 5.0),
        (&mut s.theta, 3.0),
        (&mut s.thetad, 2.0),
        (&mut s.thetadd, 10.0),
        (&mut s.tau, 5.0),
        (&mut s.tau_ext, 5.0),
    ] {
        to.extend((0..modes).map(|_| dice.within(-size, size)));
    }
    s
}

fn bending_link(dice: &mut Dice, options: &FlexibleOptions, body: usize, hub: SpatialInertia<f64>) -> BendingLink {
    let n = options.modes.start() + dice.below(options.modes.end() - options.modes.start() + 1);
    let stiffening = dice.chance(options.stiffening);
    let damped = dice.chance(options.damping);
    let particle = |dice: &mut Dice| Particle {
        mass: dice.magnitude(0.1, 1.0),
        at: vector(dice, 0.4),
        shapes: shapes(dice, n, stiffening),
    };
    let section = |dice: &mut Dice| {
        let at = vector(dice, 0.4);
        let lump = if dice.chance(0.6) { lump(dice, at) } else { SpatialInertia::zero() };
        Section { at, shapes: shapes(dice, n, stiffening), turns: (0..n).map(|_| vector(dice, 2.0)).collect(), lump }
    };
    BendingLink {
        body,
        hub,
        cloud: (0..3 + dice.below(6)).map(|_| particle(dice)).collect(),
        sections: (0..1 + dice.below(3)).map(|_| section(dice)).collect(),
        stiffness: positive(dice, n, 1e3),
        damping: if damped { positive(dice, n, 10.0) } else { DMatrix::zeros(n, n) },
        stiffening,
    }
}

fn shapes(dice: &mut Dice, n: usize, stiffening: bool) -> Shapes {
    let displacement = (0..n).map(|_| vector(dice, 1.0)).collect();
    let mut shortening = Vec::new();
    if stiffening {
        shortening = vec![Vec3::zero(); n * n];
        for j in 0..n {
            for k in 0..=j {
                let s = vector(dice, 1.0);
                (shortening[j * n + k], shortening[k * n + j]) = (s, s);
            }
        }
    }
    Shapes { displacement, shortening }
}

/// A symmetric positive definite matrix of this size.
fn positive(dice: &mut Dice, n: usize, size: f64) -> DMatrix<f64> {
    let root = DMatrix::from_fn(n, n, |_, _| dice.within(-1.0, 1.0));
    (DMatrix::identity(n, n) * 0.1 + &root * root.transpose()) * size
}

/// A tool or a motor's housing near a point.
fn lump(dice: &mut Dice, at: Vec3<f64>) -> SpatialInertia<f64> {
    let body = inertia(dice);
    body.map(|x| x * 0.2).moved(at)
}

pub(super) fn point_mass(p: &Particle) -> SpatialInertia<f64> {
    SpatialInertia::from_com(p.mass, p.at, SymMat3::zero())
}

fn vector(dice: &mut Dice, size: f64) -> Vec3<f64> {
    let v = dice.vector(size);
    [v.x, v.y, v.z].into()
}
