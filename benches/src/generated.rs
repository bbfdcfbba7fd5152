//! Robots of any size: every joint turns, and has a rotor on the previous link behind an elastic transmission.

use crate::Spec;
use gyroflex::model::{
    BodySpec, DriveSpec, Friction, JointKind, MountSpec, RotorBody, RotorSpec, SpringSpec, TransmissionError,
    TransmissionSpec,
};
use gyroflex::spatial::{Mat3, SpatialInertia, SymMat3, Transform, Vec3};
use std::f64::consts::FRAC_PI_2;

/// How the links hang together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One after the other, like an arm.
    Chain,
    /// Every link carries two more: the way from the base to a tip grows with the logarithm of their number.
    Tree,
}

impl Shape {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Chain => "chain",
            Self::Tree => "tree",
        }
    }

    fn parent(self, i: usize) -> Option<usize> {
        match self {
            Self::Chain => i.checked_sub(1),
            Self::Tree => Some(i.checked_sub(1)? / 2),
        }
    }
}

/// A robot of `n` links. Neighbouring axes are at right angles, as those of most arms; a chain of seven is such an arm.
pub fn generated(shape: Shape, n: usize) -> Spec {
    let bodies = (0..n).map(|i| turning(shape.parent(i), i)).collect();
    Spec { bodies, spring_tables: Vec::new(), gravity: Vec3::new(0.0, 0.0, -9.81) }
}

/// A link that turns on another one, number `i` of its robot.
pub(crate) fn turning(parent: Option<usize>, i: usize) -> BodySpec {
    let bend = if i.is_multiple_of(2) { -FRAC_PI_2 } else { FRAC_PI_2 };
    let rotation = Mat3::from_rpy(if parent.is_some() { bend } else { 0.0 }, 0.0, 0.3 * (i % 4) as f64);
    let placement = Transform::from_pose(rotation, Vec3::new(0.05, 0.02, 0.15));
    let (mass, centre) = (1.0 + 0.1 * (i % 5) as f64, Vec3::new(0.02, -0.01, 0.06));
    let at_centre = SymMat3::diagonal(6e-3, 5e-3, 4e-3);
    BodySpec {
        parent,
        joint: JointKind::Revolute,
        axis: Vec3::new(0.0, 0.0, 1.0),
        placement,
        inertia: SpatialInertia::from_com(mass, centre, at_centre),
        friction: Friction::<f64>::none(),
        drive: Some(drive(parent, placement)),
    }
}

fn drive(parent: Option<usize>, placement: Transform<f64>) -> DriveSpec {
    let body = Some(RotorBody { mass: 0.4, transverse_inertia: 1e-4 });
    let mount = MountSpec { body: parent, placement, axis: Vec3::new(0.0, 0.0, 1.0) };
    DriveSpec {
        rotor: RotorSpec { inertia: 5e-5, body, mount },
        gear_ratio: 100.0,
        transmission: TransmissionSpec::Elastic {
            spring: SpringSpec::Polynomial { stiffness: 1e4, cubic: 0.0 },
            damping: 10.0,
            error: TransmissionError { amplitude: 0.0, cycles_per_rotor_turn: 0.0, phase: 0.0 },
        },
        friction: Friction::<f64>::none(),
    }
}
