//! `glint compare` from outside: what it prints, its heat map, its limits, and what it refuses.

#![cfg(feature = "embree")]

use crate::support::program::Bench;
use crate::support::schema::{faults, not_promised, schema};
use glint::image::{ColorSpace, read};
use serde_json::Value;
use std::path::Path;

/// Runs `glint compare` with these words, in which `@` is the folder of pictures; the exit code, stdout and stderr.
fn glint_compare(bench: &Bench, words: &str) -> (i32, String, String) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/pictures");
    let folder = format!("{}/", folder.display());
    let words: Vec<String> = words.split(' ').map(|word| word.replace('@', &folder)).collect();
    let words: Vec<&str> =
        std::iter::once("compare").chain(words.iter().map(String::as_str)).collect();
    let output = bench.glint(&words);
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("a code"), text(output.stdout), text(output.stderr))
}

const PAIR: &str = "@cornell-4.exr @cornell-256.exr";

#[test]
fn a_table_and_json_say_the_same() {
    let bench = Bench::new();
    let (code, table, said) = glint_compare(&bench, PAIR);
    assert_eq!((code, said.as_str()), (0, ""));
    assert!(table.contains("relative RMSE  50.996 %") && table.contains("FLIP           0.3194"));
    let (code, json, said) = glint_compare(&bench, &format!("{PAIR} --json"));
    assert_eq!((code, said.as_str()), (0, ""));
    let json: Value = serde_json::from_str(&json).expect("JSON alone");
    assert_eq!(faults(&schema("compare"), &json, ""), Vec::<String>::new());
    assert!((json["relative_rmse"].as_f64().expect("a number") - 0.50996).abs() < 1e-5);
    let promised = "rmse relative_rmse mae psnr ssim flip mean_a mean_b";
    assert_eq!(not_promised(&schema("compare"), promised), Vec::<String>::new());
    assert_eq!(glint_compare(&bench, &format!("{PAIR} -q")), (0, String::new(), String::new()));
}

#[test]
fn a_heat_map_is_as_large_as_the_pictures() {
    let bench = Bench::new();
    let (code, _, said) = glint_compare(&bench, &format!("{PAIR} -o heat.png"));
    assert_eq!((code, said.as_str()), (0, "wrote heat.png\n"));
    let heat = read(&bench.path("heat.png"), ColorSpace::Srgb).expect("a picture");
    assert_eq!([heat.width(), heat.height()], [48, 40]);
    // Where nothing differs it is the first colour of the scale, nearly black.
    assert_eq!(glint_compare(&bench, "@cornell-4.png @cornell-4.png -o same.png").0, 0);
    let same = read(&bench.path("same.png"), ColorSpace::Srgb).expect("a picture");
    assert!(same.texel(7, 7).0.luminance() < 0.01 && heat.texel(7, 7).0.luminance() > 0.01);
}

/// Each limit is kept by a little more than what is found, and missed by a little less.
#[test]
fn limits_end_with_3_where_they_are_missed() {
    let bench = Bench::new();
    for (option, kept, missed) in [
        ("--max-rmse", "0.286", "0.285"),
        ("--max-relative-rmse", "51.1%", "0.50"),
        ("--max-mae", "0.04", "3.9%"),
        ("--max-flip", "0.32", "0.31"),
        ("--min-psnr", "18.7", "18.8"),
        ("--min-ssim", "0.59", "60%"),
    ] {
        let (code, _, said) = glint_compare(&bench, &format!("{PAIR} {option} {kept}"));
        assert_eq!((code, said.as_str()), (0, ""), "{option}");
        let (code, json, said) = glint_compare(&bench, &format!("{PAIR} --json {option} {missed}"));
        assert_eq!(code, 3, "{option}");
        assert!(said.contains(option) && said.contains("is not kept"), "{said}");
        let json: Value = serde_json::from_str(&json).expect("JSON alone");
        assert_eq!(json["missed"], serde_json::json!([option]));
    }
}

#[test]
fn mistakes_leave_nothing_behind() {
    let bench = Bench::new();
    bench.file("notes.txt", "no picture");
    let names = bench.names();
    for (words, code, says) in [
        ("@cornell-4.exr @glass-4.exr -o a.png", 2, "48x40 and 48x27"),
        ("@cornell-4.exr @cornell-4.png -o a.png", 2, "two of a kind"),
        ("@cornell-4.exr missing.exr -o a.png", 1, "missing.exr"),
        ("notes.txt @cornell-4.png", 1, "not an image"),
        ("@cornell-4.png @cornell-256.png -o heat.exr", 2, "must be .png"),
        ("@cornell-4.png @cornell-256.png -o @cornell-4.png", 2, "it is read"),
        ("@cornell-4.png @cornell-256.png -o nowhere/heat.png", 1, "nowhere"),
        ("@cornell-4.png @cornell-256.png --max-flip much", 2, "2%"),
        ("@cornell-4.png @cornell-256.png --max-flip -1", 2, "-1"),
        ("@cornell-4.png", 2, "<REFERENCE>"),
    ] {
        let (found, _, said) = glint_compare(&bench, words);
        assert_eq!(found, code, "{words}: {said}");
        assert!(said.contains(says), "{words}: no `{says}` in {said}");
        assert_eq!(bench.names(), names, "{words}");
    }
}
