//! Errors of the files a record is written to and read from.

use crate::error::{Error, ErrorKind};
use std::fs::File;
use std::io;
use std::path::Path;

/// Opens a file to be written, empty.
pub(super) fn create(path: &Path) -> Result<File, Error> {
    File::create(path).map_err(|e| write_error(&path.display().to_string(), &e))
}

/// The error of a file that cannot be written.
pub(super) fn write_error(file: &str, source: &io::Error) -> Error {
    let remedy = match source.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => "create its folder first, or choose another one",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => "choose a folder you may write to",
        io::ErrorKind::IsADirectory => "give a file, not a folder",
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "free some space or lower the log rate; what was written before can still be read"
        }
        _ => "check the disk or choose another one; what was written before can still be read",
    };
    io_error(file, format!("cannot be written: {source}"), remedy)
}

/// The error of a file that cannot be read.
pub(super) fn read_error(file: &str, source: &io::Error) -> Error {
    let remedy = match source.kind() {
        io::ErrorKind::NotFound => "check the name",
        io::ErrorKind::PermissionDenied => "ask for permission to read it",
        io::ErrorKind::IsADirectory => "give a file, not a folder",
        _ => "check the disk",
    };
    io_error(file, format!("cannot be read: {source}"), remedy)
}

/// An error of a file as a whole.
pub(super) fn io_error(file: &str, problem: String, remedy: &str) -> Error {
    Error { kind: ErrorKind::Io, file: file.to_owned(), element: String::new(), problem, remedy: remedy.to_owned() }
}

/// The error of a recorder used after [`finish`](super::Recorder::finish).
pub(super) fn finished(file: &str) -> Error {
    io_error(file, "is finished and takes no more samples".to_owned(), "start a new record for a new run")
}
