//! Other values of keys than the files give them.

use clap::Args;
use gyroflex_sim::load::Overrides;

/// Keys with other values, for every command that loads a robot.
#[derive(Clone, Debug, Args)]
pub struct Set {
    /// Another value of a key of the robot's YAML, or of the scenario's: `drives.joint2.transmission.stiffness=1e4`; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", allow_hyphen_values = true)]
    set: Vec<Overrides>,
}

impl Set {
    /// All of them, in their order.
    pub fn overrides(&self) -> Overrides {
        let mut all = Overrides::new();
        self.set.iter().for_each(|one| all.extend(one));
        all
    }
}
