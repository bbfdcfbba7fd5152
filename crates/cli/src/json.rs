//! JSON with a row of a matrix on a line.

use serde_json::Value;

/// JSON as programs and people read it: lists of numbers and of names on one line, all else indented.
pub fn text(value: &Value) -> String {
    let mut out = String::new();
    append(value, "\n", &mut out);
    out
}

/// `line` begins a line of the indentation so far.
fn append(value: &Value, line: &str, out: &mut String) {
    let flat = |v: &Value| !(v.is_array() || v.is_object());
    let deeper = format!("{line}  ");
    match value {
        Value::Array(items) if items.iter().all(flat) => {
            let items: Vec<String> = items.iter().map(Value::to_string).collect();
            *out += &format!("[{}]", items.join(", "));
        }
        Value::Array(items) => {
            for (i, item) in items.iter().enumerate() {
                *out += if i == 0 { "[" } else { "," };
                *out += &deeper;
                append(item, &deeper, out);
            }
            *out += &format!("{line}]");
        }
        Value::Object(entries) if !entries.is_empty() => {
            for (i, (key, item)) in entries.iter().enumerate() {
                *out += if i == 0 { "{" } else { "," };
                *out += &format!("{deeper}{}: ", Value::from(key.as_str()));
                append(item, &deeper, out);
            }
            *out += &format!("{line}}}");
        }
        other => *out += &other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::text;
    use serde_json::{Value, json};

    #[test]
    fn it_reads_back_as_what_it_was() {
        let value = json!({
            "name\n\"θ": "x", "empty": {}, "none": [], "matrix": [[1.0, -2.5e-300], [0.1, null]],
            "list": [{"a": [true]}, 3], "rows": [[], [[]]],
        });
        let written = text(&value);
        assert_eq!(serde_json::from_str::<Value>(&written).expect("it is JSON"), value);
        assert!(written.contains("\n    [1.0, -2.5e-300],\n    [0.1, null]\n  ]"), "{written}");
    }
}
