//! What the commands about linear models may be told.

use super::{ModelName, Set, picture, seconds};
use clap::{Args, ValueEnum};
use gyroflex_sim::linearize::KeptFriction;
use std::path::PathBuf;

/// Which robot, and where it stands.
#[derive(Debug, Args)]
pub struct Pose {
    /// A robot YAML or a URDF
    pub robot: PathBuf,
    /// Joint positions in rad or m, `0,0.5,-1` in coordinate order or `joint2=0.5,joint3=-1`; others are zero [default: all zero]
    #[arg(long, value_name = "POSITIONS", allow_hyphen_values = true)]
    pub q: Option<String>,
    /// Which physics of the motors to keep [default: as the robot says]
    #[arg(long)]
    pub model: Option<ModelName>,
    /// Which friction acts. Dry friction is steep at standstill and all but locks the joints
    #[arg(long, value_enum, default_value_t = FrictionName::All)]
    pub friction: FrictionName,
    /// Put the root on a floating joint, at the origin unless --q leads with x,y,z,qx,qy,qz,qw
    #[arg(long)]
    pub floating: bool,
    #[command(flatten)]
    pub set: Set,
}

/// Linearize a robot: the matrices A, B, C, D of a state-space model about an equilibrium or along a motion.
///
/// States are the positions of links and elastic motors, then their velocities; inputs are the motor torques of the joints, seen
/// from the link side; all relative to the operating point. A floating root's position is a small turn and shift in its own axes.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex linearize robots/puma560/robot.yaml --q 0,0.5,-1,0,0,0
  gyroflex linearize robot.yaml --q joint2=0.5 --output motor-velocity,joint-torque,pose:tool --mat robot.mat
  gyroflex linearize robot.yaml --tau 0,12.5 --zoh 0.001 --csv matrices
  gyroflex linearize robots/puma560/robot.yaml --scenario robots/puma560/track.yaml --at 0,0.5,1 --json

Outputs: motor-position, motor-velocity, link-position, link-velocity, joint-torque (all joints each), pose:LINK (position and
rotation vector of a link's frame, world axes).")]
pub struct Linearize {
    #[command(flatten)]
    pub pose: Pose,
    /// Motor torques on the link side that hold the robot, written as --q; the pose is found, starting at --q
    #[arg(long, value_name = "TORQUES", allow_hyphen_values = true, conflicts_with = "scenario")]
    pub tau: Option<String>,
    /// Linearize along the reference of this scenario, at the times of --at
    #[arg(long, value_name = "FILE", requires = "at", conflicts_with = "q")]
    pub scenario: Option<PathBuf>,
    /// Times in seconds, separated by commas
    #[arg(long, value_name = "TIMES", value_delimiter = ',', requires = "scenario")]
    pub at: Vec<f64>,
    /// The outputs y, separated by commas
    #[arg(long, value_name = "OUTPUTS", value_delimiter = ',', default_value = "motor-position,link-position")]
    pub output: Vec<String>,
    /// Sample A and B exactly, with torques held for this long
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub zoh: Option<f64>,
    /// Print JSON; the default unless --csv or --mat is given
    #[arg(long)]
    pub json: bool,
    /// Write A.csv, B.csv, C.csv and D.csv into this folder
    #[arg(long, value_name = "DIR")]
    pub csv: Option<PathBuf>,
    /// Write a MATLAB file (level 5)
    #[arg(long, value_name = "FILE")]
    pub mat: Option<PathBuf>,
}

/// Show how a robot swings by itself about a pose: frequencies, damping ratios, shapes.
///
/// Gravity, damping, friction and the coupling of the rotors are in. A shape is relative to its largest entry.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex modes robots/iiwa14/robot.yaml --friction viscous
  gyroflex modes robot.yaml --q joint2=0.5,joint3=-1 --plot modes.png")]
pub struct Modes {
    #[command(flatten)]
    pub pose: Pose,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Draw the shapes of the oscillations: .svg or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub plot: Option<PathBuf>,
}

/// Show the frequency response of a joint: from its motor's torque to the positions of its motor and of its link.
///
/// Magnitudes are in rad per N m (m per N for a sliding joint), motor quantities seen from the link side. Resonances and
/// antiresonances are those of the motor's position, what an encoder on the motor sees.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex frf robots/single_link/robot.yaml --joint joint1
  gyroflex frf robots/puma560/robot.yaml --joint joint2 --friction viscous --plot joint2.svg
  gyroflex frf robot.yaml --joint joint3 --from 1 --to 200 --points 1000 --csv joint3.csv")]
pub struct Frf {
    #[command(flatten)]
    pub pose: Pose,
    /// The joint
    #[arg(long, value_name = "NAME")]
    pub joint: String,
    /// The first frequency [default: a fifth of the slowest mode's]
    #[arg(long, value_name = "HZ", value_parser = hertz)]
    pub from: Option<f64>,
    /// The last frequency [default: five times the fastest mode's]
    #[arg(long, value_name = "HZ", value_parser = hertz)]
    pub to: Option<f64>,
    /// How many frequencies, in equal ratios
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub points: u32,
    /// Print JSON, with the whole response
    #[arg(long)]
    pub json: bool,
    /// Write the response as a CSV file
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Draw magnitude and phase: .svg or .png
    #[arg(long, value_name = "FILE", value_parser = picture)]
    pub plot: Option<PathBuf>,
}

/// Names of what friction is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FrictionName {
    /// All of it, dry friction with its slope at standstill
    All,
    /// Viscous friction alone, as when the robot moves
    Viscous,
    /// None
    None,
}

impl From<FrictionName> for KeptFriction {
    fn from(name: FrictionName) -> Self {
        match name {
            FrictionName::All => Self::All,
            FrictionName::Viscous => Self::Viscous,
            FrictionName::None => Self::None,
        }
    }
}

fn hertz(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("give a frequency in Hz above zero".to_owned()),
    }
}
