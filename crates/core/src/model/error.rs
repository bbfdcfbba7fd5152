//! What can be wrong with a robot's description.

use core::fmt;

/// A defect and the body it was found at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelError {
    /// Index of the body (and of its joint) in the description.
    pub body: usize,
    /// What is wrong there.
    pub defect: Defect,
}

/// What is wrong with a body, its joint or its drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defect {
    /// The parent's index is not smaller than the body's own.
    ParentNotBefore,
    /// A floating joint elsewhere than at body 0 on the world, with a drive or friction, or placed: its pose is `q`.
    FloatingNotAtRoot,
    /// A body on the world beside a floating root: all bodies of one robot hang together.
    BesideFloating,
    /// A number is infinite or not a number; names which.
    NotFinite(&'static str),
    /// A vector that must have unit length; names which and gives its length.
    NotUnit(&'static str, f64),
    /// A rotation matrix that is not one.
    NotARotation(&'static str),
    /// A quantity that must not be negative; names which and gives its value.
    Negative(&'static str, f64),
    /// A quantity that must be positive; names which and gives its value.
    NotPositive(&'static str, f64),
    /// The link's rotational inertia about its centre of mass has a negative principal moment.
    InertiaNotPositive,
    /// Mass zero, but the first moment of mass is not.
    MasslessInertia,
    /// Nothing beyond this joint resists its motion: every force would accelerate it without bound.
    NothingToMove,
    /// Taking the spin inertia of its rotors out of the link leaves no physical inertia: the URDF link does not contain them.
    RotorLargerThanLink,
    /// The gear ratio is zero.
    ZeroGearRatio,
    /// A rotor must be carried by the joint's parent, a body further in, or the world.
    MountNotAncestor,
    /// A transverse inertia less than half the spin inertia: no rotor is that flat.
    RotorTooFlat {
        /// The transverse inertia [kg m²].
        transverse: f64,
        /// The spin inertia [kg m²].
        spin: f64,
    },
    /// A spring table with fewer than two points, or whose columns do not both increase strictly.
    SpringTableNotIncreasing,
    /// More points than the storage for spring knots holds.
    TooFewKnots,
    /// Storage for fewer records than the description has bodies, or more bodies than an index can hold.
    TooFewBodies,
    /// `|e'| ≥ 1`: the transmission error would turn the motor's motion around.
    TransmissionErrorTooSteep(f64),
    /// The records of flexible links do not fit together; names those that are too few, too many or out of order.
    FlexibleRecords(&'static str),
    /// The body hangs on a link that bends, or its rotor sits on one, but its seat names none of that link's stations.
    NoStation,
    /// A rigidly geared rotor on another body than its joint's parent, or on another station of it than the joint, in a robot whose
    /// links bend.
    RemoteRigidRotor,
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ParentNotBefore => f.write_str("its parent does not come before it"),
            Self::FloatingNotAtRoot => {
                f.write_str(
                    "a floating joint must be the first body, hang on the world with the identity for placement (its pose is q) \
                     and have neither drive nor friction",
                )
            }
            Self::BesideFloating => f.write_str("it hangs on the world, although the robot's root floats: hang it on another body"),
            Self::NotFinite(what) => write!(f, "{what} is not a finite number"),
            Self::NotUnit(what, norm) => write!(f, "{what} has length {norm}, not 1"),
            Self::NotARotation(what) => write!(f, "{what} is not a rotation matrix"),
            Self::Negative(what, value) => write!(f, "{what} is {value}, but must not be negative"),
            Self::NotPositive(what, value) => write!(f, "{what} is {value}, but must be positive"),
            Self::InertiaNotPositive => {
                f.write_str("the inertia about the centre of mass has a negative principal moment")
            }
            Self::MasslessInertia => f.write_str("the mass is zero but the first moment of mass is not"),
            Self::NothingToMove => f.write_str(
                "no mass or inertia beyond this joint resists its motion; give the links it moves a mass, or fix the joint",
            ),
            Self::RotorLargerThanLink => f.write_str(
                "the rotors' spin inertia is larger than the inertia of the link that should contain them; \
                 give `rotor.mass`, so that they are added to the link",
            ),
            Self::ZeroGearRatio => f.write_str("the gear ratio is zero; give rotor turns per joint turn, 1 for a direct drive"),
            Self::MountNotAncestor => {
                f.write_str("its rotor is mounted on a link that its own joint moves, or on another branch of the tree")
            }
            Self::RotorTooFlat { transverse, spin } => write!(
                f,
                "the rotor's transverse inertia {transverse} is less than half its spin inertia {spin}, which no rotor's can be"
            ),
            Self::SpringTableNotIncreasing => {
                f.write_str("the spring table needs at least two points, strictly increasing in deflection and in torque")
            }
            Self::TooFewKnots => f.write_str("the storage for spring knots is too small"),
            Self::TooFewBodies => f.write_str("the storage for bodies is too small"),
            Self::TransmissionErrorTooSteep(slope) => write!(
                f,
                "the transmission error changes by {slope} per radian, but must stay below 1; amplitude or cycles are too large"
            ),
            Self::FlexibleRecords(which) => write!(f, "the records of flexible links do not fit together: {which}"),
            Self::NoStation => {
                f.write_str("a link that bends carries it or its rotor, but its seat names none of that link's stations")
            }
            Self::RemoteRigidRotor => f.write_str(
                "its rotor has a rigid gear and sits on a link other than the joint's parent, or on another station of it than the \
                 joint, which a robot with flexible links cannot have; mount it where the joint sits, or make the \
                 transmission elastic",
            ),
        }
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "body {}: {}", self.body, self.defect)
    }
}

impl core::error::Error for ModelError {}
