//! From files to motion: URDF and YAML in, simulation, records out.

pub mod dynamics;
pub mod error;
pub mod load;
pub mod record;
pub mod robot;

pub use dynamics::Dynamics;
pub use error::{Error, ErrorKind};
pub use robot::Robot;
