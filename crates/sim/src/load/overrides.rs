//! Keys of robot and scenario files with other values than the files give them.

use super::nearest::nearest;
use crate::error::{Error, ErrorKind};
use crate::{load::robot_schema, scenario::scenario_schema};
use serde_json::{Map, Value};
use std::sync::LazyLock;

/// Where an overridden key is, in messages and in the table of a robot's numbers.
pub(crate) const SOURCE: &str = "override";

/// Values of keys such as `drives.joint2.transmission.stiffness` or `wrenches[0].force`, in place of what a file says. They are set in
/// the file's YAML before it is checked, later ones over earlier ones, so that they may be anything that could be written there.
///
/// For a scenario, keys of the scenario come first, then those of its robot, which may also begin with `robot.`: `gravity` is the
/// scenario's, `robot.gravity` and `drives` are the robot's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides(Vec<(String, Value)>);

impl Overrides {
    /// None: files are as they are.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// With one key more.
    #[must_use]
    pub fn with(mut self, key: impl Into<String>, value: impl Into<Value>) -> Self {
        self.set(key, value);
        self
    }

    /// Adds a key.
    pub fn set(&mut self, key: impl Into<String>, value: impl Into<Value>) {
        self.0.push((key.into(), value.into()));
    }

    /// Adds all of the other's keys.
    pub fn extend(&mut self, other: &Self) {
        self.0.extend_from_slice(&other.0);
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Keys and values in the order in which they are set.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.0.iter().map(|(key, value)| (key.as_str(), value))
    }

    /// The keys of the scenario, and those of its robot.
    ///
    /// # Errors
    /// A key of neither, with the nearest known one.
    pub fn split(&self) -> Result<(Self, Self), Error> {
        let (mut scenario, mut robot) = (Self::new(), Self::new());
        for (key, value) in self.iter() {
            let first = first(key);
            if let Some(key) = key.strip_prefix("robot.") {
                robot.set(key, value.clone());
            } else if SCENARIO_KEYS.iter().any(|k| k == first) {
                scenario.set(key, value.clone());
            } else if ROBOT_KEYS.iter().any(|k| k == first) {
                robot.set(key, value.clone());
            } else {
                let known = || SCENARIO_KEYS.iter().chain(ROBOT_KEYS.iter()).map(String::as_str);
                let near = nearest(first, known()).unwrap_or_default();
                let remedy = format!(
                    "the nearest known one is `{near}`; known to scenarios: {}; to robots: {}",
                    SCENARIO_KEYS.join(", "),
                    ROBOT_KEYS.join(", ")
                );
                return Err(fault(key, format!("`{first}` is not a key of a scenario or a robot"), remedy));
            }
        }
        Ok((scenario, robot))
    }

    /// Sets the keys in a file's contents.
    pub(super) fn apply(&self, contents: &mut Value) -> Result<(), Error> {
        for (key, value) in self.iter() {
            *place(contents, key)? = value.clone();
        }
        Ok(())
    }
}

impl<K: Into<String>, V: Into<Value>> FromIterator<(K, V)> for Overrides {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(items: I) -> Self {
        Self(items.into_iter().map(|(key, value)| (key.into(), value.into())).collect())
    }
}

/// `KEY=VALUE`, the value as YAML: `controller.kp=400`, `model=reduced`, `gravity=[0, 0, 0]`.
impl std::str::FromStr for Overrides {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let Some((key, value)) = text.split_once('=') else {
            return Err(fault(text, "it has no value", "write KEY=VALUE, such as `controller.kp=400`"));
        };
        let value =
            self::value(value).map_err(|e| fault(key, e.problem, "write KEY=VALUE, the value as in a YAML file"))?;
        Ok(Self::new().with(key.trim(), value))
    }
}

/// A value by itself, as in YAML.
pub(crate) fn value(text: &str) -> Result<Value, Error> {
    super::yaml::value(text)
}

/// The value that a key stands for; keys on the way that are not there are added.
fn place<'v>(contents: &'v mut Value, key: &str) -> Result<&'v mut Value, Error> {
    let (mut at, mut rest) = (contents, key);
    loop {
        let done = &key[..key.len() - rest.len()];
        if at.is_null() {
            *at = Value::Object(Map::new());
        }
        at = match at {
            Value::Object(map) => {
                let name = name(map, rest);
                if name.is_empty() {
                    return Err(fault(
                        key,
                        "a part of the key is empty",
                        "write `outer.inner`, or `list[0]` for an item",
                    ));
                }
                rest = &rest[name.len()..];
                map.entry(name).or_insert(Value::Null)
            }
            Value::Array(list) => {
                let (length, (index, after)) = (list.len(), item(rest));
                rest = after;
                let problem = || format!("`{}` is a list of {length} items", done.trim_end_matches('.'));
                let item = index.and_then(|i| list.get_mut(i));
                item.ok_or_else(|| {
                    fault(key, problem(), format!("give an index below {length}, `[0]` being the first"))
                })?
            }
            scalar => {
                let problem = format!("`{}` is {scalar}, which has no keys", done.trim_end_matches('.'));
                return Err(fault(key, problem, "give its value as a whole, such as `{stiffness: 1.0e4}`"));
            }
        };
        match rest.strip_prefix('.') {
            _ if rest.is_empty() => return Ok(at),
            Some(after) => rest = after,
            None => {}
        }
    }
}

/// The longest name of the map that the key begins with, as names may have dots; of a new name, all up to the next dot or bracket.
fn name<'k>(map: &Map<String, Value>, key: &'k str) -> &'k str {
    let begins = |name: &&String| {
        key.strip_prefix(name.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    match map.keys().filter(begins).max_by_key(|name| name.len()) {
        Some(name) => &key[..name.len()],
        None => first(key),
    }
}

/// The index in `[2]…`, and what follows.
fn item(key: &str) -> (Option<usize>, &str) {
    let inside = key.strip_prefix('[').and_then(|key| key.split_once(']'));
    inside.map_or((None, ""), |(index, after)| (index.parse().ok(), after))
}

fn first(key: &str) -> &str {
    &key[..key.find(['.', '[']).unwrap_or(key.len())]
}

fn fault(key: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
    let (problem, remedy) = (problem.into(), remedy.into());
    Error { kind: ErrorKind::Yaml, file: SOURCE.to_owned(), element: key.to_owned(), problem, remedy }
}

static SCENARIO_KEYS: LazyLock<Vec<String>> = LazyLock::new(|| properties(&scenario_schema()));
static ROBOT_KEYS: LazyLock<Vec<String>> = LazyLock::new(|| properties(&robot_schema()));

fn properties(schema: &Value) -> Vec<String> {
    schema["properties"].as_object().map_or_else(Vec::new, |keys| keys.keys().cloned().collect())
}
