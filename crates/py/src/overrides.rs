//! Python values as overrides of keys.

use crate::errors;
use gyroflex_sim::load::Overrides;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyList, PyMapping, PyTuple};
use serde_json::{Map, Value};

/// The argument `set`: keys of files, and what they are instead.
pub(crate) fn overrides(set: Option<&Bound<'_, PyMapping>>) -> PyResult<Overrides> {
    let Some(set) = set else { return Ok(Overrides::new()) };
    let entries = entries("set", "keys such as `drives.joint2.transmission.stiffness`", set)?;
    entries.iter().map(|(key, value)| Ok((key.as_str(), json("set", key, value, DEEPEST)?))).collect()
}

/// An argument that is by joint: a key of each joint's drive.
pub(crate) fn by_joint(argument: &str, key: &str, values: &Bound<'_, PyMapping>) -> PyResult<Overrides> {
    let entries = entries(argument, "names of joints as keys", values)?;
    let drive = |joint: &str| format!("drives.{joint}.{key}");
    entries.iter().map(|(joint, value)| Ok((drive(joint), json(argument, joint, value, DEEPEST)?))).collect()
}

/// An argument that is one key of a file, a mapping.
pub(crate) fn one(argument: &str, value: &Bound<'_, PyMapping>) -> PyResult<Overrides> {
    Ok(Overrides::new().with(argument, json(argument, argument, value.as_any(), DEEPEST)?))
}

/// The keys of a mapping, which must be texts, and their values.
fn entries<'py>(
    argument: &str,
    keys: &str,
    mapping: &Bound<'py, PyMapping>,
) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let entry = |item: Bound<'py, PyAny>| {
        let (key, value): (Bound<'py, PyAny>, Bound<'py, PyAny>) = item.extract()?;
        let refuse = |_| errors::argument(argument, format!("{key:?} is not a text"), format!("give {keys}"));
        Ok((key.extract::<String>().map_err(refuse)?, value))
    };
    mapping.items()?.iter().map(entry).collect()
}

/// No file is nested deeper, and a list that contains itself has an end.
const DEEPEST: usize = 32;

/// A value as it could be written in YAML: numbers, words, `None`, and lists, arrays and mappings of them.
fn json(argument: &str, key: &str, value: &Bound<'_, PyAny>, depth: usize) -> PyResult<Value> {
    let refuse = |problem: String| {
        let remedy = "give finite numbers, text, None, or lists and mappings of them";
        Err(errors::argument(argument, format!("`{key}`: {problem}"), remedy))
    };
    if depth == 0 {
        return refuse("it is nested too deeply".to_owned());
    }
    // NumPy's arrays and scalars.
    if value.hasattr("tolist")? {
        return json(argument, key, &value.call_method0("tolist")?, depth - 1);
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
        let items = value.try_iter()?.enumerate();
        return items.map(|(i, item)| json(argument, &format!("{key}[{i}]"), &item?, depth - 1)).collect();
    }
    if let Ok(mapping) = value.cast::<PyMapping>() {
        let entries = entries(argument, "texts as keys, also within", mapping)?;
        let within = entries.into_iter().map(|(name, value)| {
            let value = json(argument, &format!("{key}.{name}"), &value, depth - 1)?;
            Ok((name, value))
        });
        return Ok(Value::Object(within.collect::<PyResult<Map<_, _>>>()?));
    }
    refuse(format!("{} is not a value of a file", value.get_type().name()?))
}
