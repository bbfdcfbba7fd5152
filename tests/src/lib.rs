//! Laws that cross crates; see the files in `tests/`. Here is what they share: the core run on random robots in any
//! scalar, and the loop over robots.

mod constraint_run;
mod core_run;
mod derivative_run;
mod elastic_motion;
mod elastic_run;
mod laws;
mod velocity_run;

pub use constraint_run::{Held, HeldMotion};
pub use core_run::Core;
pub use elastic_motion::{random_motion, settling};
pub use elastic_run::{LinkMotion, MotorMotion, orders_of, smoothness};
pub use laws::{Trial, for_trials, small};
pub use velocity_run::Coriolis;
