//! What a controller of elastic joints is fed with: motions with as many derivatives as its inverse dynamics asks for, and
//! ways to make set points so smooth, and to leave no vibration behind.

mod low_pass;
mod online_shaper;
mod real;
pub mod reference;
mod shaper;

pub use low_pass::LowPass;
pub use online_shaper::{OnlineShaper, memory_len};
pub use real::Real;
pub use shaper::{Impulse, Mode, Shaped, Shaper, ShaperKind};
