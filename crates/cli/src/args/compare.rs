//! What `gyroflex compare` may be told.

use super::Set;
use clap::Args;
use std::path::PathBuf;

/// Compare controllers: simulate scenarios, with errors of stiffness and payload if asked, and print one table.
///
/// Errors are distances of the tip from where the reference of the scenario has it; residual vibration is the largest distance of the tip
/// from its mean place after the references have come to rest. With factors, every scenario is run with all of their combinations, which its
/// controller does not know, and the worst numbers are printed beside those of the plant as it is.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gyroflex compare robots/lwr/compare/*.yaml --stiffness 0.8,1.2 --payload 0.8,1.2
  gyroflex compare pd.yaml shaped.yaml --tip tool --json")]
pub struct Compare {
    /// The scenario YAMLs
    #[arg(required = true)]
    pub scenarios: Vec<PathBuf>,
    /// The link whose place is compared [default: the robot's last]
    #[arg(long, value_name = "LINK")]
    pub tip: Option<String>,
    /// Factors on the stiffness of the transmissions
    #[arg(long, value_name = "FACTORS", value_delimiter = ',', value_parser = factor)]
    pub stiffness: Vec<f64>,
    /// Factors on the payload
    #[arg(long, value_name = "FACTORS", value_delimiter = ',', value_parser = factor)]
    pub payload: Vec<f64>,
    /// Print JSON, with every run
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub set: Set,
}

fn factor(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("give factors above zero".to_owned()),
    }
}
