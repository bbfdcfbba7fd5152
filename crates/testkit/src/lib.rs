//! What the tests of gyroflex measure against: random robots, a dense oracle that shares no algorithm with the core,
//! reference cases from outside, and tolerances.
//!
//! Nothing here is published, and nothing here is fast on purpose.

pub mod dense;
pub mod dual;
pub mod lowered;
pub mod random;
pub mod reference;
pub mod state;
pub mod tolerance;

pub use dual::Dual;
pub use lowered::Lowered;
pub use state::State;
