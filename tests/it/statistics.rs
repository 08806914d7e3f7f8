//! The JSON of `--stats` and `--json`, against its schema in `tests/schemas/`.
//!
//! The schema is generated from the types (`src/cli/statistics.rs` compares). Here it is held against the
//! names that scripts may rely on, and a real run against it.

#![cfg(feature = "embree")]

use crate::support::program::{Bench, TRIANGLE};
use serde_json::Value;
use std::fs;

fn schema() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/schemas/render.json");
    serde_json::from_str(&fs::read_to_string(path).expect(path)).expect("JSON")
}

/// What `value` has against `schema`, each with its place. Knows the keywords that our schemas have, which a
/// validator of the whole language would take 78 crates to do.
fn faults(schema: &Value, value: &Value, place: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (keyword, rule) in schema.as_object().expect("a schema is an object") {
        match keyword.as_str() {
            "$schema" | "title" | "description" | "format" => {}
            "type" => {
                let fits = match rule.as_str().expect("one type") {
                    "object" => value.is_object(),
                    "array" => value.is_array(),
                    "string" => value.is_string(),
                    "number" => value.is_number(),
                    "integer" => value.is_u64() || value.is_i64(),
                    other => panic!("type {other} is not known here"),
                };
                if !fits {
                    found.push(format!("{place}: {value} is no {rule}"));
                }
            }
            "minimum" => {
                if value.as_f64().is_some_and(|number| Some(number) < rule.as_f64()) {
                    found.push(format!("{place}: {value} is less than {rule}"));
                }
            }
            "required" => {
                let names = rule.as_array().expect("a list").iter().filter_map(Value::as_str);
                let missing = names.filter(|name| value.get(name).is_none());
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

/// A real run's statistics.
fn statistics() -> Value {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let (code, said) = bench.render(&["model.obj", "--stats", "s.json"]);
    assert_eq!(code, 0, "{said}");
    serde_json::from_slice(&fs::read(bench.path("s.json")).expect("statistics")).expect("JSON")
}

#[test]
fn the_schema_names_what_scripts_rely_on() {
    let promised = "version command host backend/name backend/version triangles threads seconds/load \
        seconds/build seconds/render seconds/write seconds/total memory_bytes/geometry \
        memory_bytes/acceleration memory_bytes/textures memory_bytes/peak_rss samples_per_pixel paths \
        rays/camera rays/bounce rays/shadow rays/total rays_per_second ledger/stages/[]/stage \
        ledger/stages/[]/seconds ledger/stages/[]/calls ledger/stages/[]/rays \
        ledger/stages/[]/mean_batch non_finite";
    let schema = schema();
    for name in promised.split_whitespace() {
        let mut at = &schema;
        for part in name.split('/') {
            let required = at["required"].as_array().into_iter().flatten();
            assert!(part == "[]" || required.into_iter().any(|r| r == part), "{name}: {part}");
            at = if part == "[]" { &at["items"] } else { &at["properties"][part] };
        }
        assert!(at["type"].is_string(), "{name}: {at}");
    }
}

#[test]
fn a_run_says_what_the_schema_says() {
    let (schema, statistics) = (schema(), statistics());
    assert_eq!(faults(&schema, &statistics, ""), Vec::<String>::new());
    // Nothing is said that the schema does not know, either.
    for (name, value) in statistics.as_object().expect("an object") {
        let known = &schema["properties"][name];
        assert!(known.is_object(), "{name}");
        for inner in value.as_object().into_iter().flatten() {
            assert!(known["properties"][inner.0].is_object(), "{name}/{}", inner.0);
        }
    }
    let rays = &statistics["rays"];
    let total: u64 = ["camera", "bounce", "shadow"].iter().filter_map(|k| rays[k].as_u64()).sum();
    assert_eq!(rays["total"], total);
}

#[test]
fn the_check_itself_can_fail() {
    let (schema, good) = (schema(), statistics());
    let broken = |change: &dyn Fn(&mut Value)| {
        let mut broken = good.clone();
        change(&mut broken);
        faults(&schema, &broken, "")
    };
    let without = |name: &str| broken(&|v| drop(v.as_object_mut().and_then(|v| v.remove(name))));
    for name in good.as_object().expect("an object").keys() {
        assert_eq!(without(name), [format!(": no {name}")]);
    }
    assert_eq!(broken(&|v| v["paths"] = "many".into()), ["/paths: \"many\" is no \"integer\""]);
    let null = broken(&|v| v["ledger"]["stages"][0]["seconds"] = Value::Null);
    assert_eq!(null, ["/ledger/stages/0/seconds: null is no \"number\""]);
}
