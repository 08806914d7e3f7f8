//! The plan and the bill as users meet them: `glint plan`, `--effects`, `--report`, the statistics and the header.

#![cfg(feature = "embree")]

use crate::support::program::{Bench, TRIANGLE, channels};
use crate::support::schema::{faults, schema};
use glint::image::Attribute;
use serde_json::Value;
use std::fs;

/// A pane of glass before a lamp.
const SCENE: &str = "[camera.front]\nfrom = [0.2, 0.2, 3]\nto = [0.2, 0.2, 0]\nperspective = { vertical_fov = 35 }\n\
    [[object]]\nfile = 'model.obj'\nmaterial = 'pane'\n[[object]]\nfile = 'model.obj'\nmaterial = 'lamp'\n\
    translate = [0, 0, -1]\n[[object]]\nfile = 'model.obj'\nmaterial = 'wall'\ntranslate = [0, 0, -2]\n\
    [material.pane.dielectric]\neta = 1.5\nthin = true\n[material.lamp]\nemission = 1\n\
    [material.wall.lambert]\nalbedo = 0.5\n[material.unused.mirror]\nreflectance = 1\n";

fn bench() -> Bench {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE).file("scene.toml", SCENE);
    bench
}

#[test]
fn plan_says_what_and_why_and_renders_nothing() {
    let bench = bench();
    let output = bench.glint(&["plan", "scene.toml"]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for words in
        ["refraction", "material \"pane\"", "scene.toml:16", "no glossy surface", "predicted"]
    {
        assert!(said.contains(words), "no `{words}` in: {said}");
    }
    assert_eq!(bench.names(), ["model.obj", "scene.toml"]);
}

#[test]
fn the_json_of_plan_follows_its_schema() {
    let bench = bench();
    for effects in ["auto", "all", "no-refraction", "ambient-occlusion"] {
        let output =
            bench.glint(&["plan", "scene.toml", "--json", "--quiet", "--effects", effects]);
        assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
        let json: Value = serde_json::from_slice(&output.stdout).expect("JSON alone");
        assert_eq!(faults(&schema("plan"), &json, "plan"), [""; 0], "{effects}");
        assert_eq!(
            json["effects"],
            if effects.starts_with("no") { "auto,no-refraction" } else { effects }
        );
        let drops = json["dropped_energy"].as_f64();
        assert_eq!(drops.is_some(), effects == "no-refraction", "{effects}: {drops:?}");
        if let Some(drops) = drops {
            // What is seen is seen through the pane.
            assert!(drops > 0.3 && drops <= 1.0, "{drops}");
        }
    }
}

#[test]
fn nothing_is_written_over_the_scene_or_twice() {
    let bench = bench();
    let before = std::fs::read(bench.path("scene.toml")).expect("the scene");
    for (options, complaint) in [
        (&["--stats", "scene.toml"][..], "scene.toml is a file of the scene"),
        (&["--stats", "./scene.toml"], "scene.toml is a file of the scene"),
        (&["-o", "a.png", "--stats", "./a.png"], "would be written twice"),
        (&["--stats", "a.html", "--report", "a.html"], "would be written twice"),
        (&["--report", "page.txt"], "the ending must be .html"),
    ] {
        let (code, said) = bench.render(&[&["scene.toml"], options].concat());
        assert_eq!(code, 2, "{options:?}: {said}");
        assert!(said.contains(complaint), "{options:?}: {said}");
    }
    assert!(std::fs::read(bench.path("scene.toml")).expect("the scene") == before);
}

#[test]
fn an_image_says_what_it_simulates_and_what_it_lacks() {
    let bench = bench();
    let header_of = |options: &[&str]| {
        let (code, said) = bench.render(&[&["scene.toml", "-o", "a.exr"], options].concat());
        assert_eq!(code, 0, "{said}");
        let metadata = channels(&bench.path("a.exr")).metadata;
        move |key: &str| match &metadata[key] {
            Attribute::Text(text) => text.clone(),
            other => panic!("{key} is {other:?}"),
        }
    };
    let header = |effects: &str| header_of(&["--effects", effects]);
    let auto = header("auto");
    assert_eq!(auto("glint.lacks"), "nothing");
    assert!(auto("glint.simulated").contains("refraction"), "{}", auto("glint.simulated"));
    assert!(auto("glint.shares").contains("refraction: "), "{}", auto("glint.shares"));
    let less = header("all,no-refraction,no-caustics");
    assert_eq!(less("glint.lacks"), "refraction, caustics");
    assert!(!less("glint.shares").contains("refraction"), "{}", less("glint.shares"));
    let short = header_of(&["--max-depth", "2", "--background", "0,0,0"]);
    assert_eq!(short("glint.lacks"), "environment behind the scene, light after 2 segments");
    assert!(!short("glint.simulated").contains("diffuse"), "{}", short("glint.simulated"));
}

#[test]
fn the_bill_is_in_the_statistics_and_on_the_page() {
    let bench = bench();
    let files = ["--stats", "s.json", "--report", "page.html", "-o", "a.exr"];
    let (code, said) = bench.render(&[&["scene.toml", "--size", "32x24"], &files[..]].concat());
    assert_eq!(code, 0, "{said}");
    let read = |name: &str| fs::read_to_string(bench.path(name)).expect("it was written");
    let stats: Value = serde_json::from_str(&read("s.json")).expect("JSON");
    assert_eq!(faults(&schema("render"), &stats, "render"), [""; 0]);
    let classes = stats["ledger"]["classes"].as_array().expect("classes");
    for share in ["energy_share", "variance_share"] {
        let sum: f64 = classes.iter().filter_map(|class| class[share].as_f64()).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{share}s add up to {sum}");
    }
    let rays: u64 = classes.iter().filter_map(|class| class["rays"].as_u64()).sum();
    assert_eq!(stats["rays"]["total"].as_u64(), Some(rays), "every ray has a class");
    let unused = stats["plan"].as_array().expect("rows").iter();
    let reasons: Vec<&str> = unused.filter_map(|row| row["reason"].as_str()).collect();
    assert!(reasons.iter().all(|reason| !reason.contains("unused")), "{reasons:?}");
    let page = read("page.html");
    for words in ["refraction", "scene.toml:16", "<svg", "emission seen", "</html>"] {
        assert!(page.contains(words), "no `{words}` on the page");
    }
    for words in ["effect", "refraction", "light", "noise"] {
        assert!(said.contains(words), "no `{words}` in: {said}");
    }
}
