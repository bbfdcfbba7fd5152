//! Where files come from: a disk, or texts compiled into the program.

use crate::error::{Error, ErrorKind};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

/// Larger files are refused: no robot or scenario needs them, and an endless device would fill the memory.
const MAX_BYTES: u64 = 64 << 20;

/// Something that has files.
pub trait FileSource {
    /// The text of a file.
    ///
    /// # Errors
    /// As the operating system reports them.
    fn read(&self, path: &Path) -> io::Result<String>;

    /// Whether there is such a file or folder.
    fn exists(&self, path: &Path) -> bool;
}

/// The file system.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl FileSource for Disk {
    fn read(&self, path: &Path) -> io::Result<String> {
        let mut bytes = Vec::new();
        std::fs::File::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("it is larger than {MAX_BYTES} bytes")));
        }
        String::from_utf8(bytes).map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "it is not UTF-8 text"))
    }

    fn exists(&self, path: &Path) -> bool {
        path.exists()
    }
}

/// Texts in memory by their path, such as `("robots/puma560/robot.yaml", include_str!(…))`.
#[derive(Clone, Copy, Debug)]
pub struct Embedded(pub &'static [(&'static str, &'static str)]);

impl FileSource for Embedded {
    fn read(&self, path: &Path) -> io::Result<String> {
        let wanted = tidy(path);
        let found = self.0.iter().find(|(name, _)| tidy(Path::new(name)) == wanted);
        found.map(|(_, text)| (*text).to_owned()).ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn exists(&self, path: &Path) -> bool {
        let wanted = tidy(path);
        self.0.iter().any(|(name, _)| tidy(Path::new(name)).starts_with(&wanted))
    }
}

/// Reads a file, or says which one could not be read and what to do.
///
/// # Errors
/// [`ErrorKind::Io`] names the file.
pub fn read(files: &dyn FileSource, path: &Path) -> Result<String, Error> {
    files.read(path).map_err(|e| {
        let (problem, remedy) = match e.kind() {
            io::ErrorKind::NotFound => ("there is no such file".to_owned(), "check the path"),
            io::ErrorKind::PermissionDenied => ("the file may not be read".to_owned(), "check its permissions"),
            _ => (format!("the file cannot be read: {e}"), "give a UTF-8 text file"),
        };
        Error {
            kind: ErrorKind::Io,
            file: path.display().to_string(),
            element: String::new(),
            problem,
            remedy: remedy.to_owned(),
        }
    })
}

/// The path of a file that the file `from` names: relative paths start at the folder of `from`.
pub fn beside(from: &Path, named: &str) -> PathBuf {
    from.parent().unwrap_or(Path::new("")).join(named)
}

/// The path without `.` and, where a folder precedes it, without `..`.
fn tidy(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(out.components().next_back(), Some(Component::Normal(_))) => {
                out.pop();
            }
            other => out.push(other),
        }
    }
    out
}
