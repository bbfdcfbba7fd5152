//! What the tests of gyroflex measure against: random robots, a dense oracle and one of energies that share no algorithm with the core,
//! reference cases from outside, and tolerances.
//!
//! Nothing here is published, and nothing here is fast on purpose.

pub mod biped;
pub mod dense;
pub mod dual;
pub mod energy_oracle;
pub mod flexible;
pub mod lowered;
pub mod random;
pub mod reference;
pub mod state;
pub mod tolerance;

pub use biped::Biped;
pub use dual::Dual;
pub use energy_oracle::EnergyOracle;
pub use flexible::FlexibleOracle;
pub use lowered::Lowered;
pub use state::State;
