//! The values that a sweep goes through.

use crate::error::{Error, ErrorKind};
use crate::load::{Overrides, overrides};
use serde_json::Value;

/// A key and its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The key, as in [`Overrides`].
    pub key: String,
    /// Its values, at least one.
    pub values: Vec<Value>,
}

/// `KEY=a:b:n` for `n` numbers from `a` to `b` in equal steps, `KEY=a:b:n:log` in equal ratios, or `KEY=x,y,z`, each as YAML.
impl std::str::FromStr for Axis {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let (key, values) = text.split_once('=').unwrap_or((text, ""));
        let values = match numbers(values) {
            Some(numbers) => numbers,
            None => match overrides::value(&format!("[{values}]")) {
                Ok(Value::Array(values)) => Some(values),
                _ => None,
            },
        };
        let key = key.trim().to_owned();
        match values {
            Some(values) if !values.is_empty() => Ok(Self { key, values }),
            _ => Err(Error {
                kind: ErrorKind::Yaml,
                file: String::new(),
                element: key,
                problem: format!("`{text}` has no values"),
                remedy: "write KEY=FROM:TO:COUNT, KEY=FROM:TO:COUNT:log (both ends above zero), or KEY=VALUE,VALUE,…"
                    .to_owned(),
            }),
        }
    }
}

/// The numbers of `a:b:n` or `a:b:n:log`; `None` if it is neither, `Some(None)` if it is one that makes no sense.
#[allow(clippy::option_option)]
fn numbers(text: &str) -> Option<Option<Vec<Value>>> {
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let [from, to] = [parts.first()?, parts.get(1)?].map(|part| part.parse::<f64>().ok());
    let (from, to) = (from?, to?);
    let count = match parts.get(2).and_then(|part| part.parse::<usize>().ok()) {
        Some(count) if from.is_finite() && to.is_finite() && (1..=MOST).contains(&count) => count,
        _ => return Some(None),
    };
    let at = |i: usize| i as f64 / (count - 1).max(1) as f64;
    let between: Vec<f64> = match parts.get(3..).unwrap_or_default() {
        [] => (0..count).map(|i| from + (to - from) * at(i)).collect(),
        ["log"] if from > 0.0 && to > 0.0 => (0..count).map(|i| from * (to / from).powf(at(i))).collect(),
        _ => return Some(None),
    };
    // The ends as they were written.
    let exact = |(i, x): (usize, f64)| if i > 0 && i + 1 == count { to } else { x };
    Some(Some(between.into_iter().enumerate().map(exact).map(Value::from).collect()))
}

/// More runs than anyone waits for.
const MOST: usize = 100_000_000;

/// The product of the values of several keys; those of the last key change fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    /// The keys.
    pub axes: Vec<Axis>,
}

impl Grid {
    /// Number of runs; 1 without axes.
    pub fn len(&self) -> usize {
        self.axes.iter().fold(1, |runs: usize, axis| runs.saturating_mul(axis.values.len()))
    }

    /// Whether there is nothing to run.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The values of a run, in the order of the axes.
    pub fn values(&self, run: usize) -> Vec<&Value> {
        let mut rest = run;
        let mut values: Vec<&Value> = self
            .axes
            .iter()
            .rev()
            .map(|axis| {
                let value = &axis.values[rest % axis.values.len()];
                rest /= axis.values.len();
                value
            })
            .collect();
        values.reverse();
        values
    }

    /// What a run overrides.
    pub fn overrides(&self, run: usize) -> Overrides {
        let keys = self.axes.iter().map(|axis| axis.key.as_str());
        keys.zip(self.values(run).into_iter().cloned()).collect()
    }
}
