//! What does not fit into explicit equations.

use core::fmt;

/// Why a robot has no explicit equations here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotExplicit {
    /// Its root floats: velocities are no derivatives of positions there.
    Floating,
    /// The spring of this joint is a table.
    SpringTable(String),
    /// The gear of this joint has an error.
    TransmissionError(String),
    /// An angle stands outside a sine or cosine.
    BareAngle,
    /// Something else than whole multiples of angles and a number stands in a sine or cosine.
    Angle,
    /// A quotient by something else than one term and small modal coordinates.
    Quotient,
    /// A function that no sum of terms is.
    Call(&'static str),
    /// A choice between two expressions.
    Choice,
}

impl fmt::Display for NotExplicit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("no explicit equations: ")?;
        match self {
            Self::Floating => f.write_str("the root floats, and its velocity is no derivative of its position"),
            Self::SpringTable(joint) => write!(f, "the spring of `{joint}` is a table; give it a stiffness"),
            Self::TransmissionError(joint) => write!(f, "the gear of `{joint}` has a transmission error; leave it out"),
            Self::BareAngle => f.write_str("an angle stands outside a sine or cosine"),
            Self::Angle => f.write_str("a sine of something else than whole multiples of angles"),
            Self::Quotient => f.write_str("a quotient by something else than one term"),
            Self::Call(name) => write!(f, "`{name}` is no sum of terms"),
            Self::Choice => f.write_str("a choice between two expressions is no sum of terms"),
        }
    }
}

impl core::error::Error for NotExplicit {}
