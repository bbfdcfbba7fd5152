//! One value for every quantity of a joint, from YAML, URDF or default, and a row of the table that says which.

use super::dialects::Tagged;
use super::yaml::Keys;
use crate::error::{Error, ErrorKind};
use crate::robot::Entry;

/// Two gear ratios closer than this, relative, are the same number rounded.
const SAME: f64 = 1e-9;

/// Collects the table of one joint.
pub(crate) struct Merge<'a> {
    pub(crate) table: &'a mut Vec<Entry>,
    /// The YAML's keys; `None` where there is no YAML.
    pub(crate) keys: Option<&'a Keys>,
    /// Name of the joint.
    pub(crate) joint: &'a str,
    /// Path of the joint's entry in the YAML.
    pub(crate) path: String,
}

impl Merge<'_> {
    /// Where a key of this joint stands in the YAML.
    pub(crate) fn at(&self, key: &str) -> String {
        self.keys.map_or_else(String::new, |k| k.locate(&format!("{}.{key}", self.path)))
    }

    /// An error about a key of this joint.
    pub(crate) fn fault(&self, key: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        let element = format!("{}.{key}", self.path);
        let (problem, remedy) = (problem.into(), remedy.into());
        Error { kind: ErrorKind::Yaml, file: self.at(key), element, problem, remedy }
    }

    /// A row.
    pub(crate) fn row(&mut self, key: &str, value: impl ToString, unit: &'static str, source: impl Into<String>) {
        let (joint, value) = (self.joint.to_owned(), value.to_string());
        self.table.push(Entry { joint, key: key.to_owned(), value, unit, source: source.into() });
    }

    /// A row from the YAML, and its value.
    pub(crate) fn given(&mut self, key: &str, value: f64, unit: &'static str) -> f64 {
        let source = self.at(key);
        self.row(key, value, unit, source);
        value
    }

    /// The YAML's value, else a tag's, else `None`. What the YAML overrules is told in the row.
    pub(crate) fn choose(
        &mut self,
        key: &str,
        unit: &'static str,
        yaml: Option<f64>,
        tag: Option<&Tagged>,
    ) -> Option<f64> {
        match (yaml, tag) {
            (Some(value), Some(tag)) if value != tag.value => {
                let source = format!("{}, instead of {} at {}", self.at(key), tag.value, tag.source);
                self.row(key, value, unit, source);
                Some(value)
            }
            (Some(value), _) => Some(self.given(key, value, unit)),
            (None, Some(tag)) => {
                self.row(key, tag.value, unit, tag.source.clone());
                Some(tag.value)
            }
            (None, None) => None,
        }
    }

    /// The YAML's value or a default, in a row only if the YAML gives it or `always`.
    pub(crate) fn or_default(&mut self, key: &str, unit: &'static str, yaml: Option<f64>, default: f64) -> f64 {
        match yaml {
            Some(value) => self.given(key, value, unit),
            None => {
                self.row(key, default, unit, "default");
                default
            }
        }
    }
}

/// The file and line of a source, without what is said about it: file names may have blanks.
pub(crate) fn place_of(source: &str) -> &str {
    let end = [" <", ", instead of "].iter().filter_map(|mark| source.find(mark)).min();
    &source[..end.unwrap_or(source.len())]
}

/// The one value that tags agree on.
///
/// # Errors
/// Names both places where two tags differ, unless the YAML overrules them.
pub(crate) fn agreed<'t>(
    what: &str,
    joint: &str,
    tags: &'t [Tagged],
    overruled: bool,
) -> Result<Option<&'t Tagged>, Error> {
    let Some(first) = tags.first() else { return Ok(None) };
    match tags.iter().find(|t| !same(t.value, first.value)) {
        Some(other) if !overruled => Err(Error {
            kind: ErrorKind::Urdf,
            file: place_of(&other.source).to_owned(),
            element: format!("joint `{joint}`"),
            problem: format!(
                "the {what} is {} at {}, but {} at {}",
                first.value, first.source, other.value, other.source
            ),
            remedy: format!(
                "take the wrong one out, or give the {what} in the robot's YAML with `override_urdf: true`"
            ),
        }),
        _ => Ok(Some(first)),
    }
}

/// Whether two numbers are one number rounded.
pub(crate) fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}
