//! From files to a [`Robot`](crate::Robot).

pub mod nearest;
pub mod source;
pub mod yaml;

pub use source::{Disk, Embedded, FileSource};
