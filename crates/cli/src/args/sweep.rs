//! What `gyroflex sweep` may be told.

use clap::Args;
use gyroflex_sim::sweep::Axis;
use std::path::PathBuf;

/// Run a scenario over many values of its keys, on all cores, and write one table.
///
/// A row of the table is a run: the values of the keys; of each joint the root mean square and the largest error of tracking, the largest
/// torque and the share of ticks at its limit; the fastest mode, the drifts, the steps; and the error of a run that diverged or was refused.
/// Rows are in the order of the values, the last --set changing fastest, whatever the number of cores. The file grows run by run;
/// the same command goes on where an interrupted one stopped.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex sweep track.yaml --set drives.joint2.transmission.stiffness=1e3:1e5:50:log
  gyroflex sweep track.yaml --set controller.kp=100:1000:10 --set model=complete,reduced -o gains.csv

Values: FROM:TO:COUNT in equal steps, FROM:TO:COUNT:log in equal ratios, or VALUE,VALUE,... as in a YAML file.
Exit codes: 0 done, 1 error, 2 wrong command line, 130 interrupted.")]
pub struct Sweep {
    /// The scenario YAML
    pub scenario: PathBuf,
    /// A key of the scenario or of its robot's YAML, and its values; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUES", required = true, allow_hyphen_values = true)]
    pub set: Vec<Axis>,
    /// The table, a CSV file [default: named like the scenario, ending in .sweep.csv, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// How many runs at once [default: as many as there are cores]
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub jobs: Option<u32>,
    /// Print what was done as JSON
    #[arg(long)]
    pub json: bool,
}
