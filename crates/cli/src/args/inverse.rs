//! What `gyroflex inverse` may be told.

use super::{ModelName, Set, seconds};
use clap::{Args, ValueEnum};
use gyroflex_sim::zeros::InverseOutput;
use std::path::PathBuf;

/// Find the motor motions and torques that move the links along a scenario's reference.
///
/// The inverse of the elastic robot, rotor gyroscopics included: torques of motors and transmissions, motor positions, deflections, as a log
/// like that of a simulation. The reference must have as many derivatives as `gyroflex info` names, or two where the motors are to follow it;
/// the scenario's controller, integrator and
/// plant have no part in it.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex inverse robots/lwr/step.yaml                         # step.inverse.mcap in the current folder
  gyroflex inverse robots/lwr/step.yaml --model reduced --csv reduced.csv
  gyroflex inverse move.yaml --damping 15                       # an inverse of the robot with damped transmissions
  gyroflex inverse move.yaml --prescribe motor                  # the motors follow, the links swing behind them

Exit codes: 0 done, 1 error or diverged, 2 wrong command line, 130 interrupted.")]
pub struct Inverse {
    /// The scenario YAML
    pub scenario: PathBuf,
    /// The MCAP log [default: named like the scenario, ending in .inverse.mcap, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Also write a CSV file
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// The model that is inverted [default: as the scenario or the robot says]
    #[arg(long)]
    pub model: Option<ModelName>,
    /// Least damping of the transmissions in the inverse, N m s/rad or N s/m: fewer derivatives are needed, and the torques are those of
    /// a robot with that damping
    #[arg(long, value_name = "DAMPING", default_value_t = 0.0, value_parser = damping)]
    pub damping: f64,
    /// What follows the reference
    #[arg(long, value_enum, value_name = "OUTPUT", default_value_t = Prescribed::Link)]
    pub prescribe: Prescribed,
    /// Time in seconds [default: as the scenario says]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub duration: Option<f64>,
    /// Print the summary as JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub set: Set,
}

/// The outputs an inverse can be given.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Prescribed {
    /// The links
    Link,
    /// The motors, about where they hold the links at rest on the reference
    Motor,
}

impl From<Prescribed> for InverseOutput {
    fn from(prescribed: Prescribed) -> Self {
        match prescribed {
            Prescribed::Link => Self::Link,
            Prescribed::Motor => Self::Motor,
        }
    }
}

fn damping(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x >= 0.0 => Ok(x),
        _ => Err("give zero or a number above it".to_owned()),
    }
}
