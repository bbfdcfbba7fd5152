//! From files to a [`Robot`].
//!
//! A robot is a URDF, or a YAML that names a URDF and adds drives ([`file::RobotFile`]). Joints come depth first from the
//! root, those on one link in the order of the file; links on fixed joints are fused with the link that carries them and
//! keep their frames in [`Robot::links`]. Each number comes from the YAML, else from the URDF's tags, else is a default;
//! [`Robot::table`] says which.

mod build;
pub(crate) mod defect;
mod dialects;
mod drives;
pub mod file;
mod flexible;
mod fuse;
mod held;
mod ignored;
mod inertial;
mod merge;
mod meshes;
mod mount;
pub mod nearest;
pub mod overrides;
mod payload;
mod pose;
pub mod source;
mod standard;
mod text;
mod tree;
mod xml;
pub mod yaml;

pub use file::{Mimic, robot_schema};
pub use flexible::{
    AtFile, AtName, BodyFile, BoundaryName, DampingFile, FlexibleLinkFile, InertiaFile, LumpFile, ModesFile,
    OriginFile, ProfileFile, ShapeFile, TipFile,
};
pub use held::{AnchorFile, ConstraintFile, ContactFile, CouplingFile, Direction, DirectionsFile, DirectionsName};
pub use overrides::Overrides;
pub use payload::PayloadFile;
pub use source::{Disk, Embedded, FileSource};

use crate::error::{Error, ErrorKind};
use crate::robot::{Robot, SourceFile};
use file::RobotFile;
use gyroflex::model::Fidelity;
use std::path::Path;
use yaml::Yaml;

/// What a caller may ask for beyond what the files say.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Put the root link on a floating joint, as the YAML's `floating` does.
    pub floating: bool,
    /// The model that commands use, instead of the YAML's `model`.
    pub model: Option<Fidelity>,
    /// Acceleration of gravity in world axes [m/s²], instead of the YAML's `gravity`.
    pub gravity: Option<[f64; 3]>,
    /// What to do with joints that mimic another one, instead of the YAML's `mimic`.
    pub mimic: Option<Mimic>,
    /// Keys of the robot's YAML with other values. A URDF by itself is taken for a YAML that only names it.
    pub overrides: Overrides,
}

/// Loads a URDF or a robot YAML from disk.
///
/// # Errors
/// Names the file with its line, the element, what is wrong with it, and what to do.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Robot, Error> {
    load_from(&Disk, path, options)
}

/// Loads a URDF or a robot YAML from any source of files.
///
/// # Errors
/// Like [`load`].
pub fn load_from(files: &dyn FileSource, path: &Path, options: &LoadOptions) -> Result<Robot, Error> {
    let text = source::read(files, path)?;
    let file = file_name(path);
    if is_urdf(path, &text) {
        let urdf = Urdf { text: &text, path, files: Some(files) };
        if options.overrides.is_empty() {
            return assemble(&urdf, None, options);
        }
        let text = names_only(&file);
        let yaml = yaml::parse_with(&text, &file, &options.overrides)?;
        return assemble(&urdf, Some(&Drives { yaml: &yaml, text: &text, file: "robot.yaml".to_owned() }), options);
    }
    let yaml: Yaml<RobotFile> = yaml::parse_with(&text, &file, &options.overrides)?;
    let urdf = source::beside(path, &yaml.value.urdf);
    let urdf_text = source::read(files, &urdf).map_err(|e| Error {
        file: yaml.keys.locate("urdf"),
        element: "urdf".to_owned(),
        problem: format!("`{}`: {}", urdf.display(), e.problem),
        remedy: "give the path of the URDF relative to this file".to_owned(),
        ..e
    })?;
    let drives = Drives { yaml: &yaml, text: &text, file };
    assemble(&Urdf { text: &urdf_text, path: &urdf, files: Some(files) }, Some(&drives), options)
}

/// Loads a URDF in memory, with the text of a robot YAML, whose `urdf` is not followed. Mesh files are not looked for.
///
/// # Errors
/// Like [`load`]; `file_name` and `robot.yaml` stand for the files.
pub fn load_urdf_text(
    text: &str,
    file_name: &str,
    drives: Option<&str>,
    options: &LoadOptions,
) -> Result<Robot, Error> {
    load_named_texts((file_name, text), ("robot.yaml", drives), options)
}

/// Like [`load_urdf_text`], of a URDF and a robot YAML with the names that messages call them, such as [`URDF_TEXT`].
///
/// # Errors
/// Like [`load`].
pub fn load_named_texts(
    (name, text): (&str, &str),
    (drives_name, drives): (&str, Option<&str>),
    options: &LoadOptions,
) -> Result<Robot, Error> {
    let urdf = Urdf { text, path: Path::new(name), files: None };
    let stand_in;
    let drives = match drives {
        Some(drives) => drives,
        None if options.overrides.is_empty() => return assemble(&urdf, None, options),
        None => {
            stand_in = names_only(name);
            &stand_in
        }
    };
    let file = drives_name.to_owned();
    let yaml = yaml::parse_with(drives, &file, &options.overrides)?;
    assemble(&urdf, Some(&Drives { yaml: &yaml, text: drives, file }), options)
}

/// What messages call a URDF that is in no file.
pub const URDF_TEXT: &str = "the URDF text";
/// What messages call a YAML that is in no file.
pub const YAML_TEXT: &str = "the YAML text";

/// The file that a robot is loaded from; `None` if it is from texts.
pub(crate) fn file_of(robot: &Robot) -> Option<&str> {
    let urdf = robot.sources.first()?;
    let own = |s: &&SourceFile| s.text != names_only(&urdf.name);
    let name = robot.sources.iter().rfind(own).map(|s| s.name.as_str());
    name.filter(|name| ![URDF_TEXT, YAML_TEXT].contains(name))
}

/// A robot YAML that says nothing but its URDF.
fn names_only(urdf: &str) -> String {
    serde_json::json!({ "urdf": urdf }).to_string()
}

struct Urdf<'a> {
    text: &'a str,
    path: &'a Path,
    files: Option<&'a dyn FileSource>,
}

struct Drives<'a> {
    yaml: &'a Yaml<RobotFile>,
    text: &'a str,
    file: String,
}

fn assemble(urdf: &Urdf<'_>, drives: Option<&Drives<'_>>, options: &LoadOptions) -> Result<Robot, Error> {
    let options = merged(options, drives.map(|d| &d.yaml.value));
    if options.gravity.is_some_and(|g| g.iter().any(|x| !x.is_finite())) {
        return Err(Error {
            kind: ErrorKind::Shape,
            file: String::new(),
            element: "gravity".to_owned(),
            problem: "it is not finite".to_owned(),
            remedy: "give three finite numbers".to_owned(),
        });
    }
    let file = file_name(urdf.path);
    let text = text::XmlText::new(urdf.text, &file);
    let xml = text.parse()?;
    let tree = tree::read(&xml)?;
    let mut warnings = ignored::report(&xml);
    if let Some(files) = urdf.files {
        warnings.extend(meshes::check(&xml, files, urdf.path));
    }
    let tags = dialects::read(&xml, &tree, &mut warnings)?;
    let stem = urdf.path.file_stem().filter(|_| file != URDF_TEXT);
    let stem = stem.map_or_else(|| "robot".to_owned(), |s| s.to_string_lossy().into_owned());
    let mut robot = build::build(&tree, &tags, drives.map(|d| d.yaml), &options, &stem, warnings)?;
    robot.sources.push(SourceFile { name: file, text: urdf.text.to_owned() });
    if let Some(drives) = drives {
        robot.sources.push(SourceFile { name: drives.file.clone(), text: drives.text.to_owned() });
    }
    Ok(robot)
}

/// The caller's wishes over those of the file.
fn merged(options: &LoadOptions, file: Option<&RobotFile>) -> LoadOptions {
    let mut all = options.clone();
    if let Some(file) = file {
        all.floating |= file.floating;
        all.model = all.model.or(Some(file.model.into()));
        all.gravity = all.gravity.or(file.gravity);
        all.mimic = all.mimic.or(file.mimic);
    }
    all
}

/// By its ending; what has another one is taken for a URDF if it looks like XML.
fn is_urdf(path: &Path, text: &str) -> bool {
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("urdf" | "xml") => true,
        Some("yaml" | "yml") => false,
        _ => text.trim_start_matches('\u{feff}').trim_start().starts_with('<'),
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
