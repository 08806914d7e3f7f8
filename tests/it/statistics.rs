//! The JSON of `--stats` and `--json`, against its schema in `tests/schemas/`.
//!
//! The schema is generated from the types (`src/cli/statistics.rs` compares). Here it is held against the
//! names that scripts may rely on, and a real run against it.

#![cfg(feature = "embree")]

use crate::support::program::{Bench, TRIANGLE};
use crate::support::schema::{faults, not_promised, schema};
use serde_json::Value;
use std::fs;

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
    assert_eq!(not_promised(&schema("render"), promised), Vec::<String>::new());
    assert_eq!(not_promised(&schema("render"), "version rays/camel"), ["rays/camel"]);
}

#[test]
fn a_run_says_what_the_schema_says() {
    let (schema, statistics) = (schema("render"), statistics());
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
    let (schema, good) = (schema("render"), statistics());
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
