//! `gyroflex eval`: lines in, lines out.

use super::load;
use crate::args::Eval;
use crate::failure::{Failure, print, say};
use gyroflex_sim::error::{Error, ErrorKind};
use gyroflex_sim::eval::{Evaluator, Options};
use std::fs::File;
use std::io::{self, BufRead, BufReader, IsTerminal, Read};

/// Longer lines are refused before they fill the memory.
const MAX_LINE: u64 = 64 << 20;

pub fn run(args: &Eval, quiet: bool) -> Result<(), Failure> {
    let robot = load(&args.robot, args.floating, &args.set, quiet)?;
    let options = Options {
        fidelity: args.model.map(Into::into),
        matrices: args.matrices,
        energy: args.energy,
        significance: args.significance,
        motor_side: args.motor_side,
    };
    let evaluator = Evaluator::new(robot, options)?;
    if args.state.as_os_str() != "-" {
        let name = args.state.display().to_string();
        let file = File::open(&args.state).map_err(|e| Error {
            remedy: "check the path and its permissions; `-` is standard input".to_owned(),
            ..unreadable(name.clone(), &e)
        })?;
        return answer(evaluator, BufReader::new(file), &name);
    }
    let stdin = io::stdin();
    if stdin.is_terminal() && !quiet {
        say("reading JSON lines from standard input; end with Ctrl-D");
    }
    answer(evaluator, stdin.lock(), "standard input")
}

/// One answer a line, printed as soon as it is found.
fn answer(mut evaluator: Evaluator, mut input: impl BufRead, name: &str) -> Result<(), Failure> {
    let mut bytes = Vec::new();
    for number in 1_u64.. {
        let here = || format!("{name}:{number}");
        bytes.clear();
        input.by_ref().take(MAX_LINE).read_until(b'\n', &mut bytes).map_err(|e| unreadable(here(), &e))?;
        if bytes.len() as u64 == MAX_LINE {
            return Err(unreadable(here(), &format!("the line is longer than {MAX_LINE} bytes")).into());
        }
        if bytes.is_empty() {
            break;
        }
        let line = std::str::from_utf8(&bytes).map_err(|e| unreadable(here(), &e))?;
        if line.trim().is_empty() {
            continue;
        }
        let answer = evaluator.evaluate_line(line).map_err(|e| Error { file: here(), ..e })?;
        print(&answer)?;
    }
    Ok(())
}

fn unreadable(file: String, why: &dyn std::fmt::Display) -> Error {
    Error {
        kind: ErrorKind::Io,
        file,
        element: String::new(),
        problem: format!("cannot be read: {why}"),
        remedy: "give a UTF-8 text file with one JSON object a line, or `-` for standard input".to_owned(),
    }
}
