//! Dynamics of robots with flexible joints, including the gyroscopics of their motor rotors.
//!
//! `no_std`, no allocation, no `unsafe`, generic over the [`Scalar`]. A robot is described once in the user's own
//! frames by a [`RobotSpec`](model::RobotSpec), checked and lowered to records ([`Body`](model::Body)) in storage the
//! caller owns, and from then on every algorithm is a function of a [`Model`](model::Model) view, input slices, scratch
//! records and output slices.
//!
//! Conventions, everywhere: SI units and radians; six-vectors are *angular part first*; motor quantities are reflected
//! to the link side unless a name says `motor`.
//!
//! # Example
//!
//! One link on a flexible joint, its motor on the ground, released at rest with the transmission unloaded.
//!
//! ```
//! use gyroflex::dynamics::{AbaScratch, External, Forward, State, aba};
//! use gyroflex::model::*;
//! use gyroflex::spatial::{SpatialInertia, SymMat3, Transform, Vec3};
//!
//! let axis = Vec3::new(0.0, 1.0, 0.0);
//! let link = BodySpec {
//!     parent: None,
//!     joint: JointKind::Revolute,
//!     axis,
//!     placement: Transform::identity(),
//!     inertia: SpatialInertia::from_com(2.0, Vec3::new(0.25, 0.0, 0.0), SymMat3::diagonal(1e-3, 0.04, 0.04)),
//!     friction: Friction::none(),
//!     drive: Some(DriveSpec {
//!         rotor: RotorSpec {
//!             inertia: 2e-5,
//!             body: None,
//!             mount: MountSpec { body: None, placement: Transform::identity(), axis },
//!         },
//!         gear_ratio: 100.0,
//!         transmission: TransmissionSpec::Elastic {
//!             spring: SpringSpec::Polynomial { stiffness: 4000.0, cubic: 0.0 },
//!             damping: 5.0,
//!             error: TransmissionError::none(),
//!         },
//!         friction: Friction::none(),
//!     }),
//! };
//! let robot = RobotSpec { bodies: &[link], spring_tables: &[], gravity: Vec3::new(0.0, 0.0, -9.81) };
//!
//! let mut bodies = [Body::empty(); 1];
//! let model = robot.lower(Fidelity::Complete, &mut bodies, &mut [])?;
//!
//! let (mut qdd, mut thetadd, mut tau_j) = ([0.0_f64], [0.0], [0.0]);
//! aba(
//!     &model,
//!     State { q: &[0.0], qd: &[0.0], theta: &[0.0], thetad: &[0.0] },
//!     &[0.0],
//!     External::none(),
//!     &mut [AbaScratch::new()],
//!     Forward { qdd: &mut qdd, thetadd: &mut thetadd, tau_j: &mut tau_j },
//! )?;
//! // The link falls freely about its joint: m g c / (I_c + m c²).
//! let expected = 2.0 * 9.81 * 0.25 / (0.04 + 2.0 * 0.25 * 0.25);
//! assert!((qdd[0] - expected).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![no_std]
#![cfg_attr(feature = "nightly", feature(core_float_math))]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

#[cfg(feature = "std")]
extern crate std;

pub mod control;
pub mod dispatch;
pub mod dynamics;
pub mod integrate;
mod jet;
mod lanes;
pub mod model;
mod newton;
pub mod scalar;
pub mod spatial;
mod trig;

pub use jet::Jet;
pub use lanes::Lanes;
pub use scalar::Scalar;
