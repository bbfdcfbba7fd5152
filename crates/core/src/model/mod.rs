//! What a robot is: the description in the user's frames, and the records the algorithms walk.

mod body;
mod drive;
mod error;
mod flexible;
mod flexible_lower;
mod friction;
mod lower;
#[allow(clippy::module_inception)]
mod model;
mod piece;
mod spec;
mod spring;
mod validate;

pub use body::{Body, JointKind, Placement};
pub use drive::{Drive, Elastic, Rotor, TransmissionError};
pub use error::{Defect, ModelError};
pub use flexible::{AssumedMode, FlexibleLink, FlexibleModel, FlexibleRecords, ModePair, Seat, Station, StationShape};
pub use friction::Friction;
pub use model::{Model, SizeError};
pub(crate) use piece::Piece;
pub use spec::{
    BodySpec, DriveSpec, Fidelity, MountSpec, RobotSpec, RotorBody, RotorSpec, SpringSpec, TransmissionSpec,
};
pub use spring::{Knot, Spring};
