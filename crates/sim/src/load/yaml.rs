//! Strict YAML: typed, within fixed budgets, every error with its line and the path of its key.

use super::nearest::nearest;
use super::overrides::{self, Overrides};
use crate::error::{Error, ErrorKind};
use serde::de::{self, DeserializeOwned, DeserializeSeed, MapAccess, SeqAccess, Visitor};
use serde_saphyr::{NonFiniteFloatPolicy, Options, Spanned};
use std::cell::RefCell;
use std::fmt;

/// A YAML file as a value, and where its keys are.
#[derive(Clone, Debug)]
pub struct Yaml<T> {
    /// The value.
    pub value: T,
    /// The lines of its keys.
    pub keys: Keys,
}

/// The keys of a YAML file by their paths, such as `drives.joint2.rotor` or `wrenches[0].link`.
#[derive(Clone, Debug, Default)]
pub struct Keys {
    file: String,
    /// Path, line and column of every key, in the order of the file.
    entries: Vec<(String, u64, u64)>,
    /// Keys with another value than the file's.
    overridden: Vec<String>,
}

impl Keys {
    /// The file with the line of a key, or of the nearest key around it that is written down; or that the key is overridden.
    pub fn locate(&self, path: &str) -> String {
        if self.overridden.iter().any(|key| within(path, key)) {
            return overrides::SOURCE.to_owned();
        }
        let mut path = path;
        loop {
            if let Some((_, line, _)) = self.entries.iter().find(|(p, ..)| p == path) {
                return format!("{}:{line}", self.file);
            }
            if self.overridden.iter().any(|key| within(key, path)) {
                return overrides::SOURCE.to_owned();
            }
            match path.rfind(['.', '[']) {
                Some(end) => path = &path[..end],
                None => return self.file.clone(),
            }
        }
    }

    /// Whether the file has this key, or an override sets it or something in it.
    pub fn has(&self, path: &str) -> bool {
        self.entries.iter().any(|(p, ..)| p == path) || self.overridden.iter().any(|key| within(key, path))
    }

    /// An error about the value of a key.
    pub fn error(&self, path: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error {
            kind: ErrorKind::Yaml,
            file: self.locate(path),
            element: path.to_owned(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// The path of the last key that starts at or before a position.
    fn at(&self, line: u64, column: u64) -> String {
        let before = self.entries.iter().filter(|(_, l, c)| (*l, *c) <= (line, column));
        before.max_by_key(|(_, l, c)| (*l, *c)).map_or_else(String::new, |(path, ..)| path.clone())
    }
}

/// Whether a key is another one or lies in it.
fn within(key: &str, outer: &str) -> bool {
    key.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Reads one YAML document that must be a mapping. Numbers that are not finite, doubled and unknown keys (where the type
/// denies them, as all of ours do), deep nesting and swelling aliases are errors.
///
/// # Errors
/// [`ErrorKind::Yaml`] with the line, the path of the key, and for an unknown key the nearest known one.
pub fn parse<T: DeserializeOwned>(text: &str, file: &str) -> Result<Yaml<T>, Error> {
    let keys = RefCell::new(Keys { file: file.to_owned(), ..Keys::default() });
    // First without types: syntax, budgets, finite numbers, and the places of all keys.
    let walk = Walk { keys: &keys, path: String::new() };
    let walked = serde_saphyr::with_deserializer_from_str_with_options(text, options(), |d| walk.deserialize(d));
    let keys_so_far = || keys.borrow().clone();
    walked.map_err(|e| explain(&e, &keys_so_far()))?;
    let value = serde_saphyr::from_str_with_options(text, options()).map_err(|e| explain(&e, &keys_so_far()))?;
    Ok(Yaml { value, keys: keys.into_inner() })
}

/// [`parse`] of a file of which some keys have other values.
///
/// # Errors
/// Like [`parse`]; what is wrong with an overridden key is said to be in an `override`.
pub fn parse_with<T: DeserializeOwned>(text: &str, file: &str, overrides: &Overrides) -> Result<Yaml<T>, Error> {
    if overrides.is_empty() {
        return parse(text, file);
    }
    let Yaml { value: mut contents, mut keys } = parse::<serde_json::Value>(text, file)?;
    overrides.apply(&mut contents)?;
    keys.overridden = overrides.iter().map(|(key, _)| key.to_owned()).collect();
    // JSON is YAML, with lines of its own, which mean nothing to the user.
    let changed = serde_json::to_string_pretty(&contents)?;
    let yaml = parse(&changed, file).map_err(|e| Error { file: keys.locate(&e.element), ..e })?;
    Ok(Yaml { value: yaml.value, keys })
}

/// A value by itself, such as `1.0e4`, `reduced` or `[0, 0, 0]`.
pub(super) fn value(text: &str) -> Result<serde_json::Value, Error> {
    parse::<serde_json::Value>(&format!("value: {text}"), overrides::SOURCE).map(|yaml| yaml.value["value"].clone())
}

/// Budgets far above any file a human writes, far below what hurts.
fn options() -> Options {
    serde_saphyr::options! {
        budget: serde_saphyr::budget! {
            max_events: 1_000_000,
            max_nodes: 500_000,
            max_depth: 32,
            flow_nesting_limit: 32,
            max_aliases: 1_000,
            max_anchors: 1_000,
            max_documents: 1,
        },
        alias_limits: serde_saphyr::alias_limits! { max_total_replayed_events: 100_000, max_replay_stack_depth: 16 },
        non_finite_float_policy: NonFiniteFloatPolicy::Reject,
        // As YAML 1.2 has it: `y` is a direction, and not `true`.
        strict_booleans: true,
        with_snippet: false,
    }
}

/// Our error for one of the YAML library's.
fn explain(error: &serde_saphyr::Error, keys: &Keys) -> Error {
    use serde_saphyr::Error as E;
    let error = error.without_snippet();
    let (file, element) = match error.location().filter(|l| l.line() > 0) {
        Some(at) => (format!("{}:{}", keys.file, at.line()), keys.at(at.line(), at.column())),
        None => (keys.file.clone(), String::new()),
    };
    let (problem, remedy) = match error {
        E::SerdeUnknownField { field, expected, .. } => {
            (format!("`{field}` is not a known key"), choices(field, expected))
        }
        E::SerdeUnknownVariant { variant, expected, .. } => {
            (format!("`{variant}` is not one of the choices"), choices(variant, expected))
        }
        E::SerdeMissingField { field, .. } => (format!("the key `{field}` is missing"), format!("add `{field}`")),
        E::DuplicateMappingKey { key, .. } => {
            let key = key.as_deref().unwrap_or("this key");
            (format!("`{key}` is given twice"), "keep one of the two".to_owned())
        }
        E::NonFiniteFloat { value, .. } => {
            (format!("{value} is not a finite number"), "give a finite number, or leave the key out".to_owned())
        }
        E::SerdeInvalidType { unexpected, expected, .. } | E::SerdeInvalidValue { unexpected, expected, .. } => {
            (format!("{unexpected} stands where {expected} is expected"), format!("give {expected}"))
        }
        E::Eof { .. } if keys.entries.is_empty() => (
            "the file is empty, but must be a mapping of keys to values".to_owned(),
            "`gyroflex schema` prints what the file may contain".to_owned(),
        ),
        E::Budget { breach, .. } => (
            format!("the file is nested too deeply or too large ({breach:?})"),
            "write the file out plainly, with little nesting and few aliases".to_owned(),
        ),
        other => {
            let text = other.to_string();
            // The library appends its own words for the position, which the file already carries.
            let text = text.split(" at line ").next().unwrap_or(&text).trim().to_owned();
            (text, "`gyroflex schema` prints what the file may contain".to_owned())
        }
    };
    Error { kind: ErrorKind::Yaml, file, element, problem, remedy }
}

fn choices(given: &str, known: &[&'static str]) -> String {
    match nearest(given, known.iter().copied()) {
        Some(near) => format!("the nearest known one is `{near}`; known here: {}", known.join(", ")),
        None => "nothing is expected here".to_owned(),
    }
}

/// Walks any document and notes the places of its keys.
struct Walk<'a> {
    keys: &'a RefCell<Keys>,
    path: String,
}

impl Walk<'_> {
    fn scalar<E: de::Error>(self, what: &str) -> Result<(), E> {
        if self.path.is_empty() {
            return Err(E::custom(format!("the file is {what}, but must be a mapping of keys to values")));
        }
        Ok(())
    }
}

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = ();
    fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a mapping of keys to values")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<Spanned<String>>()? {
            let path = if self.path.is_empty() { key.value } else { format!("{}.{}", self.path, key.value) };
            let at = key.referenced;
            self.keys.borrow_mut().entries.push((path.clone(), at.line(), at.column()));
            map.next_value_seed(Walk { keys: self.keys, path })?;
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        if self.path.is_empty() {
            return self.scalar("a list");
        }
        let mut i = 0;
        while seq.next_element_seed(Walk { keys: self.keys, path: format!("{}[{i}]", self.path) })?.is_some() {
            i += 1;
        }
        Ok(())
    }

    fn visit_unit<E: de::Error>(self) -> Result<(), E> {
        self.scalar("empty")
    }

    fn visit_none<E: de::Error>(self) -> Result<(), E> {
        self.scalar("empty")
    }

    fn visit_some<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }

    fn visit_bool<E: de::Error>(self, _: bool) -> Result<(), E> {
        self.scalar("a truth value")
    }

    fn visit_i64<E: de::Error>(self, _: i64) -> Result<(), E> {
        self.scalar("a number")
    }

    fn visit_u64<E: de::Error>(self, _: u64) -> Result<(), E> {
        self.scalar("a number")
    }

    fn visit_i128<E: de::Error>(self, _: i128) -> Result<(), E> {
        self.scalar("a number")
    }

    fn visit_u128<E: de::Error>(self, _: u128) -> Result<(), E> {
        self.scalar("a number")
    }

    fn visit_f64<E: de::Error>(self, _: f64) -> Result<(), E> {
        self.scalar("a number")
    }

    fn visit_str<E: de::Error>(self, _: &str) -> Result<(), E> {
        self.scalar("a text")
    }
}
