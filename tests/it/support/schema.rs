//! JSON against the schemas in `tests/schemas/`.

#![cfg(feature = "embree")]

use serde_json::Value;
use std::fs;

/// The schema of a command's output.
pub(crate) fn schema(command: &str) -> Value {
    let path = format!("{}/tests/schemas/{command}.json", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&fs::read_to_string(&path).expect(&path)).expect("JSON")
}

/// What `value` has against `schema`, each with its place. Knows the keywords that our schemas have, which a
/// validator of the whole language would take 78 crates to do.
pub(crate) fn faults(schema: &Value, value: &Value, place: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (keyword, rule) in schema.as_object().expect("a schema is an object") {
        match keyword.as_str() {
            "$schema" | "title" | "description" | "format" => {}
            "type" => {
                let types = rule.as_array().map_or(std::slice::from_ref(rule), Vec::as_slice);
                if !types.iter().any(|name| is_a(value, name.as_str().expect("a type's name"))) {
                    found.push(format!("{place}: {value} is no {rule}"));
                }
            }
            "anyOf" => {
                let schemas = rule.as_array().expect("a list of schemas").iter();
                let all: Vec<_> = schemas.map(|schema| faults(schema, value, place)).collect();
                if all.iter().all(|faults| !faults.is_empty()) {
                    found.extend(all.concat());
                }
            }
            "minimum" => {
                if value.as_f64().is_some_and(|number| Some(number) < rule.as_f64()) {
                    found.push(format!("{place}: {value} is less than {rule}"));
                }
            }
            "minItems" | "maxItems" => {
                let length = value.as_array().map(|entries| entries.len() as u64);
                let (length, limit) = (length.unwrap_or_default(), rule.as_u64().unwrap_or(0));
                let holds = if keyword == "minItems" { length >= limit } else { length <= limit };
                if value.is_array() && !holds {
                    found.push(format!("{place}: {length} entries, {keyword} {limit}"));
                }
            }
            "required" => {
                let names = rule.as_array().expect("a list").iter().filter_map(Value::as_str);
                let missing = names.filter(|name| value.is_object() && value.get(name).is_none());
                found.extend(missing.map(|name| format!("{place}: no {name}")));
            }
            "properties" => {
                for (name, schema) in rule.as_object().expect("properties") {
                    if let Some(value) = value.get(name) {
                        found.extend(faults(schema, value, &format!("{place}/{name}")));
                    }
                }
            }
            "items" => {
                for (i, value) in value.as_array().into_iter().flatten().enumerate() {
                    found.extend(faults(rule, value, &format!("{place}/{i}")));
                }
            }
            other => panic!("{place}: keyword {other} is not known here"),
        }
    }
    found
}

fn is_a(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("type {other} is not known here"),
    }
}

/// The names in `promised` (with slashes between levels, `[]` for the entries of a list) that `schema` does not
/// require.
pub(crate) fn not_promised(schema: &Value, promised: &str) -> Vec<String> {
    let is_required = |name: &&str| {
        let mut at = schema;
        for part in name.split('/') {
            let required = at["required"].as_array().into_iter().flatten();
            if part != "[]" && !required.into_iter().any(|r| r == part) {
                return false;
            }
            at = if part == "[]" { &at["items"] } else { &at["properties"][part] };
            // What may also be null has its own schema first.
            at = at.get("anyOf").map_or(at, |any| &any[0]);
        }
        !at["type"].is_null()
    };
    promised.split_whitespace().filter(|name| !is_required(name)).map(str::to_owned).collect()
}
