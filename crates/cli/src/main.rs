//! The `gyroflex` command: arguments, progress, exit codes. The physics is in `gyroflex-sim`.

mod args;
mod builtin;
mod commands;
mod failure;
mod json;
mod plot;
mod progress;
mod report;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let done = match &cli.command {
        Command::Simulate(args) => commands::simulate::run(args, cli.quiet),
        Command::Info(args) => commands::info::run(args, cli.quiet),
        Command::Eval(args) => commands::eval::run(args, cli.quiet),
        Command::Inverse(args) => commands::inverse::run(args, cli.quiet),
        Command::Linearize(args) => commands::linearize::run(args, cli.quiet),
        Command::Modes(args) => commands::modes::run(args, cli.quiet),
        Command::Frf(args) => commands::frf::run(args, cli.quiet),
        Command::Analyze(args) => commands::analyze::run(args, cli.quiet),
        Command::Compare(args) => commands::compare::run(args, cli.quiet),
        Command::Sweep(args) => commands::sweep::run(args, cli.quiet),
        Command::Bench(args) => commands::bench::run(args, cli.quiet),
        Command::Export(args) => commands::export::run(args, cli.quiet),
        Command::Codegen(args) => commands::codegen::run(args, cli.quiet),
        Command::Schema(args) => commands::schema::run(args),
        Command::Completions(args) => commands::completions::run(args),
    };
    ExitCode::from(done.map_or_else(|failure| failure.report(), |()| 0))
}
