//! A scenario and the files it came from.

use super::Scenario;
use crate::error::Error;
use crate::load::source::{self, FileSource};
use crate::load::yaml::{self, Keys};
use crate::robot::SourceFile;
use std::path::{Path, PathBuf};

/// A scenario as read from a file.
#[derive(Clone, Debug)]
pub struct ScenarioFile {
    /// The scenario.
    pub scenario: Scenario,
    /// The places of its keys, for messages.
    pub keys: Keys,
    /// Its path; the robot and the CSV file are relative to its folder.
    pub path: PathBuf,
    /// Its text.
    pub source: SourceFile,
    /// The CSV file of its reference.
    pub csv: Option<SourceFile>,
}

impl ScenarioFile {
    /// Reads a scenario and the CSV file it names, and checks its numbers.
    ///
    /// # Errors
    /// A file that cannot be read, and everything that is wrong in it, with line, key and remedy.
    pub fn load(files: &dyn FileSource, path: &Path) -> Result<Self, Error> {
        let mut file = Self::parse(&source::read(files, path)?, path)?;
        if let Some(csv) = &file.scenario.reference.csv {
            let csv = source::beside(path, csv);
            let text = source::read(files, &csv).map_err(|e| Error {
                remedy: "give the path of the CSV file, relative to the scenario".to_owned(),
                ..file.keys.error("reference.csv", format!("`{}`: {}", csv.display(), e.problem), "")
            })?;
            file.csv = Some(SourceFile { text, name: name_of(&csv) });
        }
        Ok(file)
    }

    /// A scenario from its text, without the CSV file it may name.
    ///
    /// # Errors
    /// Everything that is wrong in it, with line, key and remedy.
    pub fn parse(text: &str, path: &Path) -> Result<Self, Error> {
        let yaml = yaml::parse::<Scenario>(text, &path.display().to_string())?;
        yaml.value.validate(&yaml.keys)?;
        let source = SourceFile { name: name_of(path), text: text.to_owned() };
        Ok(Self { scenario: yaml.value, keys: yaml.keys, path: path.to_owned(), source, csv: None })
    }

    /// The path of the robot.
    pub fn robot_path(&self) -> PathBuf {
        source::beside(&self.path, &self.scenario.robot)
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned())
}
