//! What `gyroflex analyze` may be told.

use super::{Set, picture};
use clap::Args;
use std::path::PathBuf;

/// When do the rotors matter? Compare the complete model with the reduced one, joint by joint.
///
/// The error is the torque that the reduced model (no gyroscopics of the rotors) leaves out for the same motion of links and
/// motors: in the transmissions (`tau_J`) and at the motors (`tau`, link side), as its maximum and root mean square, in % of the
/// joint's peak torque. It grows with the square of the speed, so one analysis says up to which speed the reduced model is enough.
/// Without a scenario or a log, quasi-random motions over the joint limits are analysed.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex analyze robots/puma560/robot.yaml
  gyroflex analyze robot.yaml --speed 90 --threshold 0.5 --bounds
  gyroflex analyze robots/puma560/robot.yaml --scenario robots/puma560/track.yaml --plot errors.svg
  gyroflex analyze robot.yaml --log run.mcap --json

On Ctrl-C, a scenario is analysed up to that moment.")]
pub struct Analyze {
    /// A robot YAML or a URDF
    pub robot: PathBuf,
    /// Simulate this scenario with the complete model and analyse its motion
    #[arg(long, value_name = "FILE", conflicts_with_all = ["log", "samples", "speed", "rise"])]
    pub scenario: Option<PathBuf>,
    /// Analyse the motion in a log that `gyroflex simulate` wrote
    #[arg(long, value_name = "FILE.mcap", conflicts_with_all = ["samples", "speed", "rise"])]
    pub log: Option<PathBuf>,
    /// Motions drawn from the workspace, and poses that the search for bounds starts with [default: 2000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub samples: Option<u32>,
    /// Choose other motions
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
    /// Top speed of all turning joints [default: each joint's own limit]
    #[arg(long, value_name = "DEG_PER_S", allow_negative_numbers = true, value_parser = positive)]
    pub speed: Option<f64>,
    /// Time in which a joint comes from rest to its top speed: the largest acceleration is the speed over this [default: 0.25]
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = positive)]
    pub rise: Option<f64>,
    /// How large an error may be in % of the joint's peak torque
    #[arg(long, value_name = "PERCENT", default_value_t = 1.0, allow_negative_numbers = true, value_parser = positive)]
    pub threshold: f64,
    /// Add bounds of the inertia matrix, of Coriolis and of gravity torques over the joint limits
    #[arg(long)]
    pub bounds: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Draw each joint's error over speed: .svg or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub plot: Option<PathBuf>,
    /// Put the root on a floating joint
    #[arg(long)]
    pub floating: bool,
    #[command(flatten)]
    pub set: Set,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("give a number above zero".to_owned()),
    }
}
