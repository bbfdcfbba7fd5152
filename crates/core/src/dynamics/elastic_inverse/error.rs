//! Why an elastic inverse can fail.

use crate::model::SizeError;
use core::fmt;

/// Why [`elastic_inverse`](super::elastic_inverse) has no result. Bodies are given by their index, which is that of their joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InverseError {
    /// A slice does not fit the model.
    Size(SizeError),
    /// The motion of a joint is given with fewer derivatives than the torques depend on.
    NotSmooth {
        /// The joint's body.
        body: usize,
        /// Derivatives of its position that are needed.
        needed: usize,
        /// Derivatives that are given.
        given: usize,
    },
    /// The robot needs more Taylor coefficients than the function was compiled for.
    TooManyDerivatives {
        /// Coefficients that are needed.
        needed: usize,
        /// Coefficients there is code for.
        compiled: usize,
    },
    /// No deflection was found at which the spring carries the joint's torque, or no motor position at which the transmission
    /// is at that deflection.
    Transmission {
        /// The joint's body.
        body: usize,
    },
    /// Torques left the finite numbers.
    Overflow {
        /// The first joint's body whose results are not finite.
        body: usize,
    },
}

impl From<SizeError> for InverseError {
    fn from(error: SizeError) -> Self {
        Self::Size(error)
    }
}

impl fmt::Display for InverseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size(error) => error.fmt(f),
            Self::NotSmooth { body, needed, given } => write!(
                f,
                "the torques depend on derivative {needed} of the position of joint {body}, but only {given} are given"
            ),
            Self::TooManyDerivatives { needed, compiled } => {
                write!(f, "the robot needs {needed} Taylor coefficients, but there is code for {compiled}")
            }
            Self::Transmission { body } => {
                write!(f, "the transmission of joint {body} cannot be inverted at the torque that it must carry")
            }
            Self::Overflow { body } => write!(f, "the torques of joint {body} are not finite"),
        }
    }
}

impl core::error::Error for InverseError {}
