//! A robot as its user describes it: own frames, SI units, `f64`.

use super::{Friction, JointKind, TransmissionError};
use crate::spatial::{SpatialInertia, SymMat3, Transform, Vec3};

/// Which physics of the rotors a model keeps (PHYSICS: "four models, one code path").
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Fidelity {
    /// Every rotor a body of its own, elastic where the transmission is (Zhao, Yu, Wang, Tomizuka 2015, eq. 10).
    #[default]
    Complete,
    /// Elastic, but a rotor's kinetic energy is that of its own spin alone (Spong 1987; Zhao et al. eq. 11).
    Reduced,
    /// Every transmission rigid, `theta = q`, with the full gyroscopics of the rotors.
    Rigid,
    /// Every transmission rigid and only `B = N² J` added to the diagonal: "armature" elsewhere.
    RigidReflected,
}

impl Fidelity {
    /// All four, from the most to the least complete.
    pub const ALL: [Self; 4] = [Self::Complete, Self::Reduced, Self::Rigid, Self::RigidReflected];

    /// Whether transmissions declared elastic are.
    pub const fn is_elastic(self) -> bool {
        matches!(self, Self::Complete | Self::Reduced)
    }

    /// Whether rotors and the links that carry them act on each other.
    pub const fn is_gyroscopic(self) -> bool {
        matches!(self, Self::Complete | Self::Rigid)
    }

    /// The name used in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Reduced => "reduced",
            Self::Rigid => "rigid",
            Self::RigidReflected => "rigid_reflected",
        }
    }
}

/// A whole robot, parents before children.
#[derive(Clone, Copy, Debug)]
pub struct RobotSpec<'a> {
    /// One entry per moving body, parents before children. Body `i` is moved by joint `i`.
    pub bodies: &'a [BodySpec],
    /// Points `[deflection, torque]` of all spring tables, one table after the other; see [`SpringSpec::Table`].
    pub spring_tables: &'a [[f64; 2]],
    /// Acceleration of gravity in world axes [m/s²].
    pub gravity: Vec3<f64>,
}

/// A link and the joint that moves it.
#[derive(Clone, Copy, Debug)]
pub struct BodySpec {
    /// Index of the parent body; `None` hangs the joint on the fixed world.
    pub parent: Option<usize>,
    /// How the joint moves.
    pub joint: JointKind,
    /// Unit axis of the joint, in the axes of the joint frame. Not read for a floating root.
    pub axis: Vec3<f64>,
    /// Pose of the joint frame in the parent's link frame. At `q = 0` the link frame coincides with the joint frame.
    pub placement: Transform<f64>,
    /// Inertia of the link about the origin of its frame.
    pub inertia: SpatialInertia<f64>,
    /// Friction on the link side, in joint velocity and joint torque.
    pub friction: Friction<f64>,
    /// The motor that drives the joint, if one does.
    pub drive: Option<DriveSpec>,
}

/// A motor, its gear and its transmission.
#[derive(Clone, Copy, Debug)]
pub struct DriveSpec {
    /// The rotor.
    pub rotor: RotorSpec,
    /// `N`: rotor turns per joint turn [–], or rotor radians per metre for a prismatic joint; either sign, not zero.
    pub gear_ratio: f64,
    /// What lies between gear and link.
    pub transmission: TransmissionSpec,
    /// Friction on the motor side, in rotor velocity and motor torque.
    pub friction: Friction<f64>,
}

/// A balanced rotor, symmetric about its spin axis.
#[derive(Clone, Copy, Debug)]
pub struct RotorSpec {
    /// `J`: inertia about the spin axis [kg m²], motor side.
    pub inertia: f64,
    /// Mass and transverse inertia, to be added to the mount link; `None` if the link's inertia contains the rotor at rest.
    pub body: Option<RotorBody>,
    /// Where the rotor sits.
    pub mount: MountSpec,
}

impl RotorSpec {
    /// `I_r`: inertia of the rotor at rest in the mount link's frame, if it is not part of the link's.
    pub(crate) fn at_rest(&self) -> Option<SpatialInertia<f64>> {
        // I_r = J_t (1 − n nᵀ) + J n nᵀ about the rotor's centre.
        let (RotorBody { mass, transverse_inertia: jt }, place) = (self.body?, self.mount.placement);
        let axis = place.rotation() * self.mount.axis;
        let about_centre = SymMat3::diagonal(jt, jt, jt) + SymMat3::outer(axis).scale(self.inertia - jt);
        Some(SpatialInertia::from_com(mass, place.pos, about_centre))
    }
}

/// The part of a rotor's inertia that its spin does not show.
#[derive(Clone, Copy, Debug)]
pub struct RotorBody {
    /// Mass [kg], centred on the origin of the mount frame.
    pub mass: f64,
    /// `J_t`: inertia about any axis across the spin axis [kg m²].
    pub transverse_inertia: f64,
}

/// The place and direction of a rotor.
#[derive(Clone, Copy, Debug)]
pub struct MountSpec {
    /// The body that carries the rotor: the joint's parent or a body further in; `None` is the fixed world.
    pub body: Option<usize>,
    /// Pose of the mount frame in the link frame of that body.
    pub placement: Transform<f64>,
    /// Unit spin axis, in the axes of the mount frame.
    pub axis: Vec3<f64>,
}

/// What lies between gear and link.
#[derive(Clone, Copy, Debug)]
pub enum TransmissionSpec {
    /// Nothing that gives: `theta = q`.
    Rigid,
    /// A spring and a damper side by side, link side, with an optional error of the gear.
    Elastic {
        /// Torque over deflection.
        spring: SpringSpec,
        /// `D ≥ 0` [N m s/rad], or [N s/m] for a prismatic joint.
        damping: f64,
        /// Periodic error of the gear.
        error: TransmissionError<f64>,
    },
}

/// The law of a transmission spring, strictly increasing.
#[derive(Clone, Copy, Debug)]
pub enum SpringSpec {
    /// `k(δ) = K δ + K₃ δ³`.
    Polynomial {
        /// `K > 0` [N m/rad].
        stiffness: f64,
        /// `K₃ ≥ 0` [N m/rad³].
        cubic: f64,
    },
    /// A monotone cubic through the points `spring_tables[first..first + len]`, straight beyond its ends.
    /// Both columns increase strictly. A table that starts at `[0, 0]` is continued oddly to negative deflections.
    Table {
        /// Index of its first point.
        first: usize,
        /// Number of points, at least two.
        len: usize,
    },
}
