//! What a user says of a constraint.

use crate::Scalar;
use crate::dynamics::kinematics::Frame;
use crate::model::{Model, SizeError};
use crate::spatial::{Transform, Vec3};
use core::fmt;

/// Some of the six relative motions of two frames: 0 to 2 are rotations about x, y and z, 3 to 5 motions along them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Directions(u8);

impl Directions {
    /// No motion of the origin: a point is held.
    pub const POINT: Self = Self(0b11_1000);
    /// No relative motion at all.
    pub const ALL: Self = Self(0b11_1111);
    /// The origin's motion along x and z: a point of a planar robot is held.
    pub const PLANAR_POINT: Self = Self(0b10_1000);

    /// The directions listed, of 0 to 5; others are ignored.
    pub const fn of(listed: &[usize]) -> Self {
        let (mut bits, mut rest) = (0, listed);
        while let [direction, tail @ ..] = rest {
            if *direction < 6 {
                bits |= 1 << *direction;
            }
            rest = tail;
        }
        Self(bits)
    }

    /// Whether a direction is among them.
    pub const fn contains(self, direction: usize) -> bool {
        direction < 6 && self.0 >> direction & 1 == 1
    }

    /// How many there are.
    pub const fn count(self) -> usize {
        self.0.count_ones() as usize
    }
}

/// Where a frame is held: a frame of the world or of a body, in whose axes the constrained directions are.
#[derive(Clone, Copy, Debug)]
pub struct Anchor<T> {
    /// Index of the body; `None` is the world.
    pub body: Option<usize>,
    /// Pose in the body's link frame, or in the world.
    pub placement: Transform<T>,
}

/// What is held to what.
#[derive(Clone, Copy, Debug)]
pub enum Hold<T> {
    /// A frame to an anchor. Three rotations keep the axes parallel, two keep the axis of the third parallel, one is for planar
    /// robots.
    Frame {
        /// The frame.
        frame: Frame<T>,
        /// Where it is held.
        anchor: Anchor<T>,
        /// Which of its motions relative to the anchor are held, in the anchor's axes.
        directions: Directions,
    },
    /// A joint of one degree of freedom to another: `q_joint = ratio q_follows + offset`.
    Joints {
        /// Index of the body that the joint moves.
        joint: usize,
        /// Index of the body that the other joint moves.
        follows: usize,
        /// `ratio`.
        ratio: T,
        /// `offset` [rad or m].
        offset: T,
    },
}

/// What makes a held point a contact: it can be pushed, not pulled.
#[derive(Clone, Copy, Debug)]
pub struct Contact<T> {
    /// The constrained direction along which the anchor only pushes the frame: 3, 4 or 5 for x, y or z.
    pub normal: usize,
    /// Ratio of the speed of separation to that of approach in an impact: 0 is plastic, 1 loses nothing.
    pub restitution: T,
    /// Force along the anchor's axes for every newton of normal force, where the contact slips: `−μ v/|v|`. `None`: it sticks.
    pub slip: Option<Vec3<T>>,
}

/// Something held.
#[derive(Clone, Copy, Debug)]
pub struct Constraint<T> {
    /// What is held to what.
    pub hold: Hold<T>,
    /// `ω`: how fast an error of position or velocity is drawn back, critically damped [rad/s]; zero leaves it.
    pub stabilisation: T,
    /// What makes it a contact, if it is one.
    pub contact: Option<Contact<T>>,
}

impl<T: Scalar> Constraint<T> {
    /// How many directions it constrains: as many multipliers it has.
    pub const fn rows(&self) -> usize {
        match &self.hold {
            Hold::Frame { directions, .. } => directions.count(),
            Hold::Joints { .. } => 1,
        }
    }

    /// Whether a direction is constrained; a coupling of joints has one, direction 0.
    pub(super) const fn holds(&self, direction: usize) -> bool {
        match &self.hold {
            Hold::Frame { directions, .. } => directions.contains(direction),
            Hold::Joints { .. } => direction == 0,
        }
    }
}

/// Number of multipliers of all constraints.
pub const fn constraint_rows<T: Scalar>(constraints: &[Constraint<T>]) -> usize {
    let (mut rows, mut rest) = (0, constraints);
    while let [constraint, tail @ ..] = rest {
        rows += constraint.rows();
        rest = tail;
    }
    rows
}

/// Records that constraints need for forces on their way to the base.
pub fn propagated_len<P: Scalar, T: Scalar>(model: &Model<P>, constraints: &[Constraint<T>]) -> usize {
    model.bodies.len() * constraints.len()
}

/// Entries of the matrix that the multipliers are solved in.
pub const fn constraint_matrix_len<T: Scalar>(constraints: &[Constraint<T>]) -> usize {
    let rows = constraint_rows(constraints);
    2 * rows * rows + 2 * rows
}

/// A constraint that does not fit the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstraintError {
    /// A slice of the wrong length.
    Size(SizeError),
    /// A constraint names a body that the robot has not.
    NoSuchBody {
        /// Index of the constraint.
        constraint: usize,
        /// The body.
        body: usize,
    },
    /// A coupling of joints names a body that no joint of one degree of freedom moves, or the same one twice.
    NoSuchJoint {
        /// Index of the constraint.
        constraint: usize,
        /// The body.
        body: usize,
    },
    /// A frame is held to its own body.
    HeldToItself {
        /// Index of the constraint.
        constraint: usize,
    },
    /// A contact's normal is not one of the constraint's directions along x, y or z.
    NoSuchNormal {
        /// Index of the constraint.
        constraint: usize,
        /// The direction.
        normal: usize,
    },
}

impl From<SizeError> for ConstraintError {
    fn from(error: SizeError) -> Self {
        Self::Size(error)
    }
}

impl fmt::Display for ConstraintError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size(error) => error.fmt(f),
            Self::NoSuchBody { constraint, body } => {
                write!(f, "constraint {constraint} is on body {body}, which the model has not")
            }
            Self::NoSuchJoint { constraint, body } => write!(
                f,
                "constraint {constraint} couples the joint of body {body}: name two bodies that joints of one degree of freedom move"
            ),
            Self::HeldToItself { constraint } => {
                write!(f, "constraint {constraint} holds a body to itself: hold it to another, or to the world")
            }
            Self::NoSuchNormal { constraint, normal } => write!(
                f,
                "constraint {constraint} is a contact with the normal {normal}: give one of its directions 3, 4 or 5 (x, y, z)"
            ),
        }
    }
}

impl core::error::Error for ConstraintError {}

/// Refuses constraints that do not fit the model.
pub(super) fn check<P: Scalar, T: Scalar>(
    model: &Model<P>,
    constraints: &[Constraint<T>],
) -> Result<(), ConstraintError> {
    let bodies = model.bodies.len();
    for (k, constraint) in constraints.iter().enumerate() {
        match &constraint.hold {
            Hold::Frame { frame, anchor, .. } => {
                if let Some(body) = [Some(frame.body), anchor.body].into_iter().flatten().find(|body| *body >= bodies) {
                    return Err(ConstraintError::NoSuchBody { constraint: k, body });
                }
                if anchor.body == Some(frame.body) {
                    return Err(ConstraintError::HeldToItself { constraint: k });
                }
            }
            Hold::Joints { joint, follows, .. } => {
                let first = if model.floating { 1 } else { 0 };
                for body in [*joint, *follows] {
                    if body < first || body >= bodies || joint == follows {
                        return Err(ConstraintError::NoSuchJoint { constraint: k, body });
                    }
                }
            }
        }
        if let Some(contact) = &constraint.contact
            && (contact.normal < 3
                || !matches!(constraint.hold, Hold::Frame { .. })
                || !constraint.holds(contact.normal))
        {
            return Err(ConstraintError::NoSuchNormal { constraint: k, normal: contact.normal });
        }
    }
    Ok(())
}
