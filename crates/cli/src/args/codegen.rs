use super::{ModelName, Scalar, Set};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write a robot's equations as straight-line code, or as formulas.
///
/// The library's own algorithms run on symbols, and what they leave is simplified for this one robot: zeros and ones of its geometry
/// vanish, inertias are regrouped, common subexpressions and common factors are computed once. The code needs no library at all.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex codegen robots/iiwa14/robot.yaml --what forward,inverse -o src
  gyroflex codegen robots/iiwa14/robot.yaml --what all --lang c --scalar f32 -o generated
  gyroflex codegen robots/puma560/robot.yaml --keep-symbol payload.mass --lang python
  gyroflex codegen robots/puma560/robot.yaml --simplify-to 1e-3 --along robots/puma560/track.yaml
  gyroflex codegen robots/book_two_link/robot.yaml --lang latex

Files are written when all of them are complete. What was generated, with operation counts, is printed; --json prints it as JSON.")]
pub struct Codegen {
    /// A robot YAML or a URDF
    pub robot: PathBuf,
    /// What to generate, separated by commas; `all` is all that this robot has
    #[arg(long, value_name = "QUANTITIES", value_delimiter = ',', default_value = "forward,inverse")]
    pub what: Vec<String>,
    /// The language
    #[arg(long, value_enum, default_value_t = LanguageName::Rust)]
    pub lang: LanguageName,
    /// A parameter that stays an argument of the code, such as link6.mass, payload.mass, joint2.stiffness; may be repeated
    #[arg(long, value_name = "PARAMETER")]
    pub keep_symbol: Vec<String>,
    /// The link whose Jacobian is generated [default: the last that moves]
    #[arg(long, value_name = "LINK")]
    pub link: Option<String>,
    /// Which physics of the motors to keep [default: as the robot says]
    #[arg(long)]
    pub model: Option<ModelName>,
    /// The number type of the code
    #[arg(long, value_enum, default_value_t = Scalar::F64)]
    pub scalar: Scalar,
    /// Rust that takes so many states side by side, in the lanes of vector registers
    #[arg(long, value_name = "N")]
    pub lanes: Option<usize>,
    /// Drop terms whose torque stays below this part of the largest torque of their equation, and report what that costs
    #[arg(long, value_name = "PART")]
    pub simplify_to: Option<f64>,
    /// The scenario whose motion decides which terms matter [default: motions all over the workspace]
    #[arg(long, value_name = "SCENARIO", requires = "simplify_to")]
    pub along: Option<PathBuf>,
    /// Cut every function into so many parts for as many processors (Rust, with the crate rayon)
    #[arg(long, value_name = "N")]
    pub split: Option<usize>,
    /// The folder to write to, made if it does not exist
    #[arg(short, long, value_name = "FOLDER", default_value = ".")]
    pub output: PathBuf,
    /// Name of the files without their extensions [default: the robot's]
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// Print what was generated as JSON
    #[arg(long)]
    pub json: bool,
    /// Put the root on a floating joint
    #[arg(long)]
    pub floating: bool,
    #[command(flatten)]
    pub set: Set,
}

/// Languages to generate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LanguageName {
    /// Rust without `std` and without dependencies
    Rust,
    /// C99 without a library, with a header and a test program
    C,
    /// Python with NumPy
    Python,
    /// The explicit equations as a document
    Latex,
    /// The expression graph
    Json,
}
