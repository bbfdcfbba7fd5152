//! What the command line may say.

mod analyze;
mod bench;
mod codegen;
mod compare;
mod inverse;
mod linear;
mod set;
mod sweep;

pub use analyze::Analyze;
pub use bench::Bench;
pub use codegen::{Codegen, LanguageName};
pub use compare::Compare;
pub use inverse::Inverse;
pub use linear::{Frf, Linearize, Modes, Pose};
pub use set::Set;
pub use sweep::Sweep;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use gyroflex_sim::Fidelity;
use std::path::PathBuf;

const EXIT_CODES: &str = "\
Exit codes:
  0    done
  1    the input is wrong, a file cannot be read or written, or the simulation diverged
  2    the command line is wrong
  130  interrupted with Ctrl-C; a log is complete up to that moment

Results go to standard output, everything else to standard error.";

/// Dynamics of robots with flexible joints, including the gyroscopics of their motors' rotors.
#[derive(Debug, Parser)]
#[command(name = "gyroflex", version, after_help = EXIT_CODES, arg_required_else_help = true)]
pub struct Cli {
    /// Print neither progress nor warnings, only results and errors
    #[arg(short, long, global = true)]
    pub quiet: bool,
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    Simulate(Simulate),
    Info(Info),
    Eval(Eval),
    Inverse(Inverse),
    Linearize(Linearize),
    Modes(Modes),
    Frf(Frf),
    Analyze(Analyze),
    Compare(Compare),
    Sweep(Sweep),
    Bench(Bench),
    Export(Export),
    Codegen(Codegen),
    Schema(Schema),
    Completions(Completions),
}

/// Simulate a scenario and write a log.
///
/// Without a scenario, a PUMA 560 with elastic joints tracks a trajectory: everything it needs is in the program.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex simulate                                    # the PUMA 560, into puma560.mcap
  gyroflex simulate robots/iiwa14/track.yaml
  gyroflex simulate track.yaml -o run.mcap --csv run.csv --model reduced --duration 2
  gyroflex simulate track.yaml --set drives.joint2.transmission.stiffness=1e4 --set controller.kp=400

Open the log in Foxglove, Rerun or PlotJuggler. On Ctrl-C or when the motion diverges, the log is completed up to that moment.
Exit codes: 0 done, 1 error or diverged, 2 wrong command line, 130 interrupted.")]
pub struct Simulate {
    /// The scenario YAML; without one, the built-in PUMA 560
    pub scenario: Option<PathBuf>,
    /// The MCAP log [default: named like the scenario, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Also write a CSV file
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Which physics of the motors to keep [default: as the scenario or the robot says]
    #[arg(long)]
    pub model: Option<ModelName>,
    /// Simulated time in seconds [default: as the scenario says]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub duration: Option<f64>,
    /// Print the summary as JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub set: Set,
}

/// Show what a robot ended up with: joints, drives, frames, masses, modes, and where each number came from.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex info robots/puma560/robot.yaml
  gyroflex info robot.urdf --json --floating")]
pub struct Info {
    /// A robot YAML or a URDF
    pub robot: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Put the root on a floating joint
    #[arg(long)]
    pub floating: bool,
    #[command(flatten)]
    pub set: Set,
}

/// Calculate dynamics: reads JSON lines, prints a JSON line for each.
///
/// Forward dynamics takes `q, qd, theta, thetad, tau` and gives `qdd, thetadd, tau_j`. Inverse dynamics takes
/// `q, qd, qdd, theta, thetad, thetadd` and gives `tau_j, tau`: what the transmissions and what the motors must deliver.
/// Arrays run over all joints in coordinate order, as `gyroflex info` lists them. `theta`, `thetad`, `thetadd` count at joints
/// with an elastic transmission only, and are not needed in the rigid models. `q` alone is enough for --matrices.
#[derive(Debug, Args)]
#[command(after_help = "\
Optional keys of every line:
  tau_ext    generalised forces on the joints, link side
  eta, etad  modal coordinates of links that bend, and their rates; 0 if left out. Answers have `etadd`
  etadd      their accelerations, for inverse dynamics, which then gives `tau_eta`; left out, the modes are free
  tau_eta    generalised forces on the modes, for forward dynamics
  wrenches   [{\"link\": \"tool\", \"force\": [0, 0, -10], \"torque\": [0, 0, 0], \"frame\": \"world\", \"point\": [0, 0, 0]}]
             in world axes (or \"frame\": \"link\") at the link's origin (or at \"point\", in the link's frame)
  gravity    [x, y, z] in world axes
  held       names of the robot's constraints, couplings and contacts that are in force; contacts stick where they are.
             Default: all constraints and couplings of the robot's YAML; [] is the tree of joints alone
  distribution   of inverse dynamics where something is held: {\"torques\": [weights], \"multipliers\": [weights of forces],
             \"wanted\": [forces], \"passive\": [\"joints that nothing drives\"]}, each of which may be left out

Where something is held, answers have its forces in world axes under `held`, and how many of its directions are `dependent`.

With --floating, q starts with x y z qx qy qz qw and qd with the twist in the root's own frame, angular part first; the six
root entries of theta, thetad, thetadd, tau and tau_ext may be left out.
Answers are printed as they are found; the first wrong line ends the work with exit code 1. Blank lines are skipped.

Example:
  echo '{\"q\": [0, 0], \"qd\": [0, 0], \"tau\": [0, 0]}' | gyroflex eval robot.urdf --state - --model rigid")]
pub struct Eval {
    /// A robot YAML or a URDF
    pub robot: PathBuf,
    /// A file with one JSON object a line; `-` is standard input
    #[arg(long, value_name = "FILE", default_value = "-")]
    pub state: PathBuf,
    /// Which physics of the motors to keep [default: as the robot says]
    #[arg(long)]
    pub model: Option<ModelName>,
    /// Add the inertia matrix M, the coupling S of links and motors, the rotor inertias B and the gravity torques g; with qd
    /// (and thetad) also the Coriolis blocks C, C1, C2 and the rates M_dot, S_dot
    #[arg(long)]
    pub matrices: bool,
    /// Add the kinetic, gravity, elastic and total energy
    #[arg(long)]
    pub energy: bool,
    /// Add the significance ratio r_s of the gyroscopic coupling, its bounds and extremes, those of the complete model
    #[arg(long)]
    pub significance: bool,
    /// Take and print rotor angles and motor torques instead of reflected ones (theta, thetad, thetadd, tau, S, B, C1, C2, S_dot)
    #[arg(long)]
    pub motor_side: bool,
    /// Put the root on a floating joint
    #[arg(long)]
    pub floating: bool,
    #[command(flatten)]
    pub set: Set,
}

/// Write a robot as source code, for controllers that can read no files.
///
/// The Rust module holds one model of the robot as a `static`: it goes to read-only memory (flash), costs no time at start,
/// and gives the same results as the loaded robot, to the last bit where the elementary functions are the same.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex export --rust robots/iiwa14/robot.yaml -o src/iiwa14.rs
  gyroflex export --rust robot.yaml --model rigid --scalar f32 > src/robot.rs

In the program, with `gyroflex` among its dependencies:
  mod iiwa14;
  gyroflex::dynamics::rnea(&iiwa14::MODEL, ...)")]
pub struct Export {
    /// A robot YAML or a URDF
    pub robot: PathBuf,
    /// Write Rust
    #[arg(long, required = true)]
    pub rust: bool,
    /// Which physics of the motors to keep [default: as the robot says]
    #[arg(long)]
    pub model: Option<ModelName>,
    /// The number type of the records
    #[arg(long, value_enum, default_value_t = Scalar::F64)]
    pub scalar: Scalar,
    /// The file to write [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Put the root on a floating joint
    #[arg(long)]
    pub floating: bool,
    #[command(flatten)]
    pub set: Set,
}

/// Print the JSON Schema of a YAML file, for editors that complete and check.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  gyroflex schema scenario > scenario.schema.json")]
pub struct Schema {
    /// Which file
    pub file: SchemaName,
}

/// Print a completion script for a shell.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  gyroflex completions bash > ~/.local/share/bash-completion/completions/gyroflex")]
pub struct Completions {
    /// Which shell
    pub shell: Shell,
}

/// Names of the models on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum ModelName {
    /// Elastic transmissions, every rotor a body of its own
    Complete,
    /// Elastic transmissions, a rotor's energy that of its own spin alone
    Reduced,
    /// Rigid gears with the full gyroscopics of the rotors
    Rigid,
    /// Rigid gears, reflected rotor inertia on the diagonal only
    RigidReflected,
}

impl From<ModelName> for Fidelity {
    fn from(name: ModelName) -> Self {
        match name {
            ModelName::Complete => Self::Complete,
            ModelName::Reduced => Self::Reduced,
            ModelName::Rigid => Self::Rigid,
            ModelName::RigidReflected => Self::RigidReflected,
        }
    }
}

/// Number types of the core.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Scalar {
    /// Single precision
    F32,
    /// Double precision
    F64,
}

/// Files with a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaName {
    /// The drives of a robot
    Robot,
    /// A scenario
    Scenario,
}

/// A duration: finite and above zero.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("give a number of seconds above zero".to_owned()),
    }
}

/// A file for a picture.
fn picture(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|e| e.to_str()) {
        Some("svg" | "png") => Ok(path),
        _ => Err("give a file that ends in .svg or .png".to_owned()),
    }
}
