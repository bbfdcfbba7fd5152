//! Compilers, interpreters, and programs that read points and write results.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// An empty folder for one test, which is left where it is when the test fails.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gyroflex-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("temporary folders can be made");
        Self(path)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), text).expect("files can be written");
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

/// The compiler beside the cargo that built this test, unless `RUSTC` names one.
pub fn rustc() -> Command {
    let beside = Path::new(env!("CARGO")).with_file_name("rustc");
    Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| beside.into_os_string()))
}

/// A C compiler, `cc` unless `CC` names one.
pub fn cc() -> Command {
    Command::new(std::env::var_os("CC").unwrap_or_else(|| "cc".into()))
}

/// An interpreter with NumPy, if one is named.
pub fn numpy() -> Option<Command> {
    std::env::var_os("GYROFLEX_PYTHON_NUMPY").map(Command::new)
}

/// Runs a command in a folder and asserts that it said nothing, which compilers do when all is well.
pub fn succeed(command: &mut Command, folder: &Folder) {
    let output = command.current_dir(&folder.0).output().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{command:?} in {}: {said}", folder.0.display());
}

/// Runs a program on points, a line each, and returns what it gives for each.
pub fn run(command: &mut Command, folder: &Folder, points: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut text = String::new();
    for point in points {
        point.iter().for_each(|x| write!(text, "{x:?} ").expect("strings take all"));
        text.push('\n');
    }
    let piped = command.current_dir(&folder.0).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = piped.spawn().unwrap_or_else(|e| panic!("{command:?}: {e}"));
    let mut stdin = child.stdin.take().expect("it is piped");
    // Both pipes fill up if nobody reads.
    let writer = std::thread::spawn(move || stdin.write_all(text.as_bytes()));
    let output = child.wait_with_output().expect("it runs");
    assert!(output.status.success(), "{command:?} in {}", folder.0.display());
    // Who gives constants need not read.
    let _ = writer.join().expect("no panic");
    let number = |word: &str| word.parse().unwrap_or_else(|e| panic!("{command:?}: {word}: {e}"));
    let text = String::from_utf8(output.stdout).expect("numbers are text");
    text.lines().map(|line| line.split_whitespace().map(number).collect()).collect()
}
