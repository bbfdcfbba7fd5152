//! A scenario and the files it came from.

use super::Scenario;
use crate::error::Error;
use crate::load::source::{self, FileSource};
use crate::load::yaml::{self, Keys};
use crate::load::{LoadOptions, Overrides, load_from};
use crate::robot::{Robot, SourceFile};
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
    /// Keys with other values than the files', those of the robot among them.
    pub overrides: Overrides,
}

impl ScenarioFile {
    /// Reads a scenario and the CSV file it names, and checks its numbers.
    ///
    /// # Errors
    /// A file that cannot be read, and everything that is wrong in it, with line, key and remedy.
    pub fn load(files: &dyn FileSource, path: &Path) -> Result<Self, Error> {
        Self::load_with(files, path, &Overrides::new())
    }

    /// [`ScenarioFile::load`] with other values of some keys of the scenario or its robot.
    ///
    /// # Errors
    /// As for [`ScenarioFile::load`], and a key that is not known.
    pub fn load_with(files: &dyn FileSource, path: &Path, overrides: &Overrides) -> Result<Self, Error> {
        let mut file = Self::parse_with(&source::read(files, path)?, path, overrides)?;
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
        Self::parse_with(text, path, &Overrides::new())
    }

    fn parse_with(text: &str, path: &Path, overrides: &Overrides) -> Result<Self, Error> {
        let (own, _) = overrides.split()?;
        let yaml = yaml::parse_with::<Scenario>(text, &path.display().to_string(), &own)?;
        yaml.value.validate(&yaml.keys)?;
        let source = SourceFile { name: name_of(path), text: text.to_owned() };
        let overrides = overrides.clone();
        Ok(Self { scenario: yaml.value, keys: yaml.keys, path: path.to_owned(), source, csv: None, overrides })
    }

    /// The path of the robot.
    pub fn robot_path(&self) -> PathBuf {
        source::beside(&self.path, &self.scenario.robot)
    }

    /// The robot, with the overrides that are about it beside those of `options`.
    ///
    /// # Errors
    /// As [`load_from`].
    pub fn load_robot(&self, files: &dyn FileSource, options: &LoadOptions) -> Result<Robot, Error> {
        let path = self.robot_path();
        if !files.exists(&path) {
            let remedy = "give the path of a robot YAML or a URDF, relative to the scenario";
            return Err(self.keys.error("robot", format!("there is no file `{}`", path.display()), remedy));
        }
        let mut options = options.clone();
        options.overrides.extend(&self.overrides.split()?.1);
        load_from(files, &path, &options)
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |n| n.to_string_lossy().into_owned())
}
