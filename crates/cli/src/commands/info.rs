//! `gyroflex info`.

use super::load;
use crate::args::Info;
use crate::failure::{Failure, print};
use gyroflex_sim::info;

pub fn run(args: &Info, quiet: bool) -> Result<(), Failure> {
    // The report has the warnings itself.
    let robot = load(&args.robot, args.floating, true)?;
    let report = info::Info::of(&robot)?;
    if args.json { print(&report.to_json()?) } else { print(report.to_string().trim_end()) }
}
