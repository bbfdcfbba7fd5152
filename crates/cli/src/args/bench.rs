//! What `gyroflex bench` may be told.

use super::{ModelName, Set};
use clap::Args;
use std::path::PathBuf;

/// Measure what each algorithm takes of a 1 kHz period on this machine: median, 99.9th percentile, maximum.
///
/// Every call is timed on its own, at random states inside the joint limits. A controller that shares its core with other work
/// has to live with the maximum: pin it to a core of its own, give it real-time priority, and measure it the same way.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex bench robots/iiwa14/robot.yaml
  taskset -c 1 gyroflex bench robot.yaml --model complete --calls 100000

On Ctrl-C, what has been finished is printed.")]
pub struct Bench {
    /// A robot YAML or a URDF
    pub robot: PathBuf,
    /// Which physics of the motors to keep [default: all four; for a robot without drives its own]
    #[arg(long)]
    pub model: Option<ModelName>,
    /// Calls of each algorithm
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    pub calls: u32,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Put the root on a floating joint
    #[arg(long)]
    pub floating: bool,
    #[command(flatten)]
    pub set: Set,
}
