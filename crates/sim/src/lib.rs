//! From files to motion: URDF and YAML in, simulation, records out.

pub mod analyze;
pub mod batch;
pub mod bench;
pub mod compare;
pub mod contact;
pub mod controller;
pub mod coordinates;
pub mod dynamics;
pub mod equilibrium;
pub mod error;
pub mod eval;
pub mod export;
pub mod gait;
pub mod info;
pub mod inverse;
pub mod linearize;
pub mod load;
pub mod loads;
pub mod lqr;
pub mod modes;
mod ode;
mod random;
pub mod record;
pub mod reference;
pub mod robot;
pub mod scenario;
pub mod simulate;
pub mod walk;
pub mod zeros;

pub use dynamics::Dynamics;
pub use error::{Error, ErrorKind};
pub use gyroflex::model::Fidelity;
pub use robot::Robot;
pub use scenario::{Scenario, ScenarioFile, scenario_schema};
pub use simulate::{Simulation, Summary};
