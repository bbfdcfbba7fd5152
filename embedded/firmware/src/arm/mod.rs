//! The arm: the KUKA LBR iiwa 14 of `robots/`, exported by `embedded/run` before the build.

#[rustfmt::skip]
pub mod complete;
#[rustfmt::skip]
pub mod rigid;

/// Number of joints.
pub const N: usize = complete::NV;
