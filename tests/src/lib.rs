//! Laws that cross crates; see the files in `tests/`. Here is what they share: the core run on random robots in any
//! scalar, and the loop over robots.

mod constraint_run;
mod core_run;
mod derivative_run;
mod elastic_motion;
mod elastic_run;
mod flexible_laws;
mod flexible_run;
mod laws;
mod velocity_run;

pub use constraint_run::{Held, HeldMotion};
pub use core_run::Core;
pub use elastic_motion::{random_motion, settling};
pub use elastic_run::{LinkMotion, MotorMotion, orders_of, smoothness};
pub use flexible_laws::{FlexibleTrial, for_flexible, small_flexible};
pub use flexible_run::{FlexibleCore, FlexibleStorage};
pub use laws::{Trial, for_trials, small};
pub use velocity_run::Coriolis;
