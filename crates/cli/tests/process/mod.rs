//! Runs the binary in a folder of its own.
#![allow(dead_code)] // every test file uses its own part

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// How a run of the binary ended.
#[derive(Debug)]
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// A new empty folder for one test.
pub(crate) fn folder(test: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).expect("the folder for temporary files can be written");
    path
}

/// A file of the project.
pub(crate) fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// Writes a file into a folder and gives its path.
pub(crate) fn write(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("the folder can be written");
    path
}

/// The binary, standard streams piped.
pub(crate) fn start(folder: &Path, args: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_gyroflex"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts")
}

/// Waits for the end; a panic of the binary fails the test.
pub(crate) fn end(child: Child) -> Ended {
    let output = child.wait_with_output().expect("the binary ends");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the binary prints UTF-8");
    let ended = Ended { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) };
    assert!(!ended.err.contains("panicked"), "{}", ended.err);
    ended
}

/// Runs the binary to its end.
pub(crate) fn gyroflex(folder: &Path, args: &[&str]) -> Ended {
    with_input(folder, args, "")
}

/// Runs the binary with text on standard input.
pub(crate) fn with_input(folder: &Path, args: &[&str], input: &str) -> Ended {
    let mut child = start(folder, args);
    let mut stdin = child.stdin.take().expect("standard input is piped");
    // A binary that has already failed does not read; that is its right.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    end(child)
}

/// Whether a log is complete: the end of an MCAP file is written last.
pub(crate) fn is_complete(log: &Path) -> bool {
    const MAGIC: &[u8] = b"\x89MCAP0\r\n";
    let bytes = std::fs::read(log).expect("the log was written");
    bytes.len() > 2 * MAGIC.len() && bytes.starts_with(MAGIC) && bytes.ends_with(MAGIC)
}

/// A pendulum, as a URDF.
pub(crate) const PENDULUM: &str = r#"<robot name="pendulum">
  <link name="base"/>
  <link name="bob">
    <inertial><origin xyz="0 0 -0.5"/><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
  </link>
  <joint name="hinge" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint>
</robot>
"#;

/// The pendulum with a drive.
pub(crate) const ROBOT: &str = "\
urdf: pendulum.urdf
drives:
  hinge:
    rotor: {inertia: 1.0e-4}
    gear_ratio: 50
    transmission: {stiffness: 500, damping: 1}
";

/// A scenario for it.
pub(crate) const SCENARIO: &str = "\
robot: robot.yaml
duration: 0.2
reference: {hinge: {type: sine, amplitude: 0.3, frequency: 1}}
controller: {type: pd, rate: 1000, kp: 100, kd: 10, gravity_compensation: true}
integrator: {method: rk4, step: 1.0e-4}
";

/// A folder with the three of them as `pendulum.urdf`, `robot.yaml` and `scenario.yaml`.
pub(crate) fn pendulum(test: &str) -> PathBuf {
    let folder = folder(test);
    write(&folder, "pendulum.urdf", PENDULUM);
    write(&folder, "robot.yaml", ROBOT);
    write(&folder, "scenario.yaml", SCENARIO);
    folder
}
