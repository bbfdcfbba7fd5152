//! Control of robots with elastic joints: laws that a controller calls once a tick, with storage of the caller.

mod computed_torque;
mod feedback_linearization;
mod pd;
mod state_feedback;
mod two_dof;

pub use computed_torque::{ComputedTorque, Joints};
pub use feedback_linearization::{FeedbackLinearization, LinearizationScratch};
pub use pd::{Motors, Pd};
pub use state_feedback::StateFeedback;
pub use two_dof::{TwoDof, TwoDofScratch};
