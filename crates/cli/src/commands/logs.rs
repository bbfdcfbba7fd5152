//! Where the logs of a command go.

use gyroflex_sim::error::{Error, ErrorKind};
use std::path::{Path, PathBuf};

/// The log beside the user, not beside the scenario: that folder may not be his.
pub fn path(output: Option<&Path>, scenario: &Path, ending: &str) -> PathBuf {
    let stem = || PathBuf::from(scenario.file_stem().unwrap_or(scenario.as_os_str()));
    output.map_or_else(|| stem().with_extension(ending), Path::to_path_buf)
}

/// Refuses to write over the scenario, or log and CSV over each other.
pub fn spare_the_input(
    log: &Path,
    output: Option<&Path>,
    csv: Option<&Path>,
    scenario: Option<&Path>,
) -> Result<(), Error> {
    for written in std::iter::once(log).chain(csv) {
        let same = |other: &Path| match (written.canonicalize(), other.canonicalize()) {
            (Ok(a), Ok(b)) => a == b,
            _ => written == other,
        };
        let problem = if scenario.is_some_and(same) {
            "it is the scenario, and would be overwritten"
        } else if csv.is_some() && csv == output {
            "it cannot be the MCAP log and the CSV file at once"
        } else {
            continue;
        };
        return Err(Error {
            kind: ErrorKind::Io,
            file: written.display().to_string(),
            element: "output".to_owned(),
            problem: problem.to_owned(),
            remedy: "name another file".to_owned(),
        });
    }
    Ok(())
}
