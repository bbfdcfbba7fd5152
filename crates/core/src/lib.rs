//! Dynamics of robots with flexible joints, including the gyroscopics of their motor rotors.
//!
//! `no_std`, no allocation, no `unsafe`, generic over the [`Scalar`]. A robot is described once in the user's own
//! frames by a [`RobotSpec`](model::RobotSpec), checked and lowered to records ([`Body`](model::Body)) in storage the
//! caller owns, and from then on every algorithm is a function of a [`Model`](model::Model) view, input slices, scratch
//! records and output slices.
//!
//! Conventions, everywhere: SI units and radians; six-vectors are *angular part first*; motor quantities are reflected
//! to the link side unless a name says `motor`.

#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(feature = "std")]
extern crate std;

pub mod dynamics;
pub mod integrate;
pub mod model;
pub mod scalar;
pub mod spatial;

pub use scalar::Scalar;
