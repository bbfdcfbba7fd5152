//! The view of a robot that every algorithm takes.

use super::{Body, Drive, JointKind, Knot, Rotor};
use crate::Scalar;
use crate::spatial::Vec3;
use core::fmt;

/// A robot as the algorithms see it: records in storage that someone else owns.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a, T> {
    pub(crate) bodies: &'a [Body<T>],
    pub(crate) knots: &'a [Knot<T>],
    pub(crate) gravity: Vec3<T>,
    pub(crate) nq: usize,
    pub(crate) nv: usize,
    pub(crate) floating: bool,
    /// Whether all joints but a floating root are revolute.
    pub(crate) revolute: bool,
    /// Whether, besides, no gear is rigid.
    pub(crate) plain: bool,
    remote_rigid_rotor: bool,
}

impl<'a, T: Scalar> Model<'a, T> {
    /// A view of records that [`RobotSpec::lower`](super::RobotSpec::lower) wrote, possibly cast to another scalar since.
    /// `gravity` is in world axes [m/s²].
    pub const fn new(bodies: &'a [Body<T>], knots: &'a [Knot<T>], gravity: Vec3<T>) -> Self {
        let floating = match bodies {
            [root, ..] => matches!(root.joint, JointKind::Floating),
            [] => false,
        };
        let (nq, nv) = if floating { (bodies.len() + 6, bodies.len() + 5) } else { (bodies.len(), bodies.len()) };
        let (mut revolute, mut plain, mut remote_rigid_rotor, mut rest) = (true, true, false, bodies);
        while let [body, tail @ ..] = rest {
            let elastic = matches!(&body.drive, None | Some(Drive { elastic: Some(_), .. }));
            revolute &= !matches!(body.joint, JointKind::Prismatic);
            plain &= elastic && revolute;
            remote_rigid_rotor |= carries_remotely(body);
            rest = tail;
        }
        Self { bodies, knots, gravity, nq, nv, floating, revolute, plain, remote_rigid_rotor }
    }

    /// The records, parents before children.
    pub fn bodies(&self) -> &'a [Body<T>] {
        self.bodies
    }

    /// Pieces of all spring tables.
    pub fn knots(&self) -> &'a [Knot<T>] {
        self.knots
    }

    /// Acceleration of gravity in world axes [m/s²].
    pub fn gravity(&self) -> Vec3<T> {
        self.gravity
    }

    /// The same robot under another gravity.
    pub fn with_gravity(self, gravity: Vec3<T>) -> Self {
        Self { gravity, ..self }
    }

    /// Length of `q`.
    pub fn nq(&self) -> usize {
        self.nq
    }

    /// Length of `qd`, and of every other vector over the joints: `theta`, `tau`, …
    pub fn nv(&self) -> usize {
        self.nv
    }

    /// Whether the first body moves freely.
    pub fn is_floating(&self) -> bool {
        self.floating
    }

    /// Whether a rigidly geared rotor sits on a body other than its joint's parent. Such a rotor couples its joint to bodies
    /// that are not neighbours, and forward dynamics takes the joint-space route (PHYSICS §3).
    pub fn has_remote_rigid_rotor(&self) -> bool {
        self.remote_rigid_rotor
    }
}

/// Whether a joint's rotor is rigidly geared and sits on a body other than the joint's parent.
const fn carries_remotely<T: Scalar>(body: &Body<T>) -> bool {
    match &body.drive {
        Some(Drive { rotor: Rotor { mount: Some(mount), .. }, elastic: None }) => match body.parent {
            Some(parent) => parent != *mount,
            None => true,
        },
        _ => false,
    }
}

/// A slice of the wrong length was passed to an algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SizeError {
    /// The argument.
    pub argument: &'static str,
    /// The length the model asks for.
    pub expected: usize,
    /// The length given.
    pub given: usize,
}

impl fmt::Display for SizeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` has {} entries, but the model needs {}", self.argument, self.given, self.expected)
    }
}

impl core::error::Error for SizeError {}

impl SizeError {
    /// An error unless the lengths are the same.
    ///
    /// # Errors
    /// Names the argument.
    #[inline]
    pub fn check(argument: &'static str, given: usize, expected: usize) -> Result<(), Self> {
        if given == expected { Ok(()) } else { Err(Self { argument, expected, given }) }
    }
}
