//! Control of robots with elastic joints: laws that a controller calls once a tick, motions with as many derivatives as inverse
//! dynamics asks for, filters that make set points so smooth, and shapers that leave no vibration behind; with storage of the caller.

mod computed_torque;
mod feedback_linearization;
mod low_pass;
mod online_shaper;
mod pd;
mod real;
pub mod reference;
mod shaper;
mod sliding_mode;
mod state_feedback;
mod two_dof;

pub use computed_torque::{ComputedTorque, HeldScratch, Joints};
pub use feedback_linearization::{FeedbackLinearization, LinearizationScratch};
pub use low_pass::LowPass;
pub use online_shaper::{OnlineShaper, memory_len};
pub use pd::{Motors, Pd};
pub use real::Real;
pub use shaper::{Impulse, Mode, Shaped, Shaper, ShaperKind};
pub use sliding_mode::{InputOutput, Outputs, SlidingMode, SlidingModeError, SlidingScratch};
pub use state_feedback::StateFeedback;
pub use two_dof::{TwoDof, TwoDofScratch};
