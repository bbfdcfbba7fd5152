//! Python values as overrides of keys.

use crate::errors;
use gyroflex_sim::load::Overrides;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyList, PyMapping, PyTuple};
use serde_json::{Map, Value};

/// The argument `set`: keys of files, and what they are instead.
pub(crate) fn overrides(set: Option<&Bound<'_, PyMapping>>) -> PyResult<Overrides> {
    let Some(set) = set else { return Ok(Overrides::new()) };
    set.items()?
        .iter()
        .map(|item| {
            let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
            let Ok(key) = key.extract::<String>() else {
                let remedy = "give keys such as `drives.joint2.transmission.stiffness`";
                return Err(errors::argument("set", format!("{key:?} is not a key"), remedy));
            };
            let value = json(&key, &value, DEEPEST)?;
            Ok((key, value))
        })
        .collect()
}

/// No file is nested deeper, and a list that contains itself has an end.
const DEEPEST: usize = 32;

/// A value as it could be written in YAML: numbers, words, `None`, and lists, arrays and mappings of them.
fn json(key: &str, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    let refuse = |problem: String| {
        let remedy = "give finite numbers, text, None, or lists and mappings of them";
        Err(errors::argument("set", format!("`{key}`: {problem}"), remedy))
    };
    if depth == 0 {
        return refuse("it is nested too deeply".to_owned());
    }
    // NumPy's arrays and scalars.
    if value.hasattr("tolist")? {
        return json(key, &value.call_method0("tolist")?, depth - 1);
    }
    if value.is_none() {
        return Ok(Value::Null);
    }
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(truth.is_true().into());
    }
    if let Ok(text) = value.extract::<String>() {
        return Ok(text.into());
    }
    if let Ok(number) = value.extract::<i64>() {
        return Ok(number.into());
    }
    if let Ok(number) = value.extract::<f64>() {
        if number.is_finite() {
            return Ok(number.into());
        }
        return refuse(format!("{number} is not a finite number"));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        return value.try_iter()?.map(|item| json(key, &item?, depth - 1)).collect();
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        let items = mapping.items()?;
        let entries = items.iter().map(|item| {
            let (name, value): (String, Bound<'_, PyAny>) = item.extract()?;
            Ok((name, json(key, &value, depth - 1)?))
        });
        return Ok(Value::Object(entries.collect::<PyResult<Map<_, _>>>()?));
    }
    refuse(format!("{} is not a value of a file", value.get_type().name()?))
}
