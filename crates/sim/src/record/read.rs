//! Reads our own logs back, finished or cut short.

use super::columns::Table;
use super::proto::{self, State};
use super::{Impact, RunInfo, file};
use crate::error::Error;
use ::mcap::io::MessageReader;
use ::mcap::read::LinearReader;
use ::mcap::records::Record;
use ::mcap::sans_io::LinearReaderOptions;
use ::mcap::{McapError, Message};
use prost::Message as _;
use std::io::Cursor;
use std::path::Path;

/// The states of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StateLog {
    /// All of `/gyroflex/state`: the columns of a record up to and without the poses of the links.
    pub table: Table,
    /// All of `/gyroflex/impacts`, by the contacts in the order of the table.
    pub impacts: Vec<Impact>,
    /// Parameters and versions of the run.
    pub metadata: Vec<(String, String)>,
    /// Whether the log was finished; else its run was killed and the table holds what reached the file.
    pub complete: bool,
}

/// Reads `/gyroflex/state` and `/gyroflex/impacts` of a log.
///
/// # Errors
/// When the file cannot be read, is no MCAP log, or holds no states of ours. A log cut short is no error.
pub fn read_states(path: &Path) -> Result<StateLog, Error> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| file::read_error(&name, &e))?;
    // The end magic is not skipped: reaching it is how a finished log is known.
    let options = LinearReaderOptions::default().with_validate_chunk_crcs(true);
    let mut log = StateLog { complete: true, metadata: metadata(&bytes), ..StateLog::default() };
    let mut run = None;
    for message in MessageReader::new_with_options(Cursor::new(&bytes), options) {
        match message {
            Ok(message) if message.channel.topic == "/gyroflex/state" => {
                let state = decode(&name, &message)?;
                let info = run.get_or_insert_with(|| {
                    let info = run_info(&state);
                    log.table = Table::new(&info);
                    info
                });
                if *info != run_info(&state) {
                    let problem = format!("the joints change at t = {} s", state.time);
                    return Err(not_ours(&name, problem));
                }
                log.table.push(&state.sample());
            }
            Ok(message) if message.channel.topic == "/gyroflex/impacts" => {
                let at = || format!("/gyroflex/impacts at {} ns", message.log_time);
                let impact = proto::Impact::decode(message.data.as_ref())
                    .map_err(|e| not_ours(&name, format!("{} is no gyroflex.Impact: {e}", at())))?;
                let impact = run.as_ref().and_then(|info| impact.impact(info));
                log.impacts.push(impact.ok_or_else(|| not_ours(&name, format!("{} is of no known contact", at())))?);
            }
            Ok(_) => {}
            Err(McapError::UnexpectedEof) => log.complete = false,
            Err(McapError::Io(source)) => return Err(file::read_error(&name, &source)),
            Err(e) => return Err(not_ours(&name, e.to_string())),
        }
    }
    if run.is_none() && log.complete {
        return Err(not_ours(&name, "holds no message on /gyroflex/state".to_owned()));
    }
    Ok(log)
}

/// What the recorder wrote ahead of the first sample, so that a log cut short has it too.
fn metadata(log: &[u8]) -> Vec<(String, String)> {
    let records = LinearReader::new(log).into_iter().flatten();
    let found = records.map_while(Result::ok).find_map(|record| match record {
        Record::Metadata(m) if m.name == "gyroflex" => Some(m.metadata),
        _ => None,
    });
    found.into_iter().flatten().collect()
}

fn decode(name: &str, message: &Message<'_>) -> Result<State, Error> {
    State::decode(message.data.as_ref())
        .map_err(|e| not_ours(name, format!("/gyroflex/state at {} ns is no gyroflex.State: {e}", message.log_time)))
}

/// As much of the run as its states tell.
fn run_info(state: &State) -> RunInfo {
    RunInfo {
        joints: state.joints.iter().map(|j| j.name.clone()).collect(),
        prismatic: state.joints.iter().map(|j| j.prismatic).collect(),
        floating: state.base.is_some(),
        held: state.footing.is_some(),
        modes: state.modes.iter().map(|m| m.name.clone()).collect(),
        turning: state.modes.iter().map(|m| m.turning).collect(),
        tips: state.tips.iter().map(|t| t.link.clone()).collect(),
        contacts: state.footing.as_ref().map_or_else(Vec::new, |footing| footing.names()),
        ..RunInfo::default()
    }
}

fn not_ours(name: &str, problem: String) -> Error {
    file::io_error(name, problem, "give an MCAP log that `gyroflex simulate` has written")
}
