//! Laws that cross crates; see the files beside `src`. Here is what they share: the core run on random robots in any
//! scalar, with scratch as dirty as it gets.

mod core_run;
mod laws;

pub use core_run::Core;
pub use laws::{Context, for_robots};
