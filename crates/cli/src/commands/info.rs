//! `gyroflex info`.

use super::load;
use crate::args::Info;
use crate::failure::{Failure, print};
use gyroflex_sim::info;

pub fn run(args: &Info, quiet: bool) -> Result<(), Failure> {
    // The report has the warnings itself.
    let mut robot = load(&args.robot, args.floating, &args.set, true)?;
    if quiet {
        robot.warnings.clear();
    }
    let report = info::Info::of(&robot)?;
    if args.json { print(&report.to_json()?) } else { print(report.to_string().trim_end()) }
}
