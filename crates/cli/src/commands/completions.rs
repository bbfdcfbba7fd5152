//! `gyroflex completions`.

use crate::args::{Cli, Completions};
use crate::failure::{Failure, print};
use clap::CommandFactory;

pub fn run(args: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "gyroflex", &mut script);
    print(String::from_utf8_lossy(&script).trim_end())
}
