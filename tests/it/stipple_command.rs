//! `glint samples stipple`: what it writes, says and refuses.

#![cfg(feature = "embree")]

use crate::support::program::Bench;
use glint::image::{ColorSpace, read, write_png};
use std::fs;
use std::process::Output;

/// A ramp from black to white, 64 x 48.
fn with_ramp() -> Bench {
    let bench = Bench::new();
    let texel = |i: usize| [((i % 64) * 4) as u8; 3];
    let texels: Vec<_> = (0..64 * 48).map(texel).collect();
    write_png(&bench.path("ramp.png"), &texels, 64, 48).unwrap();
    bench
}

fn stipple(bench: &Bench, arguments: &[&str]) -> Output {
    let output = bench.glint(&[&["samples", "stipple"], arguments].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!said.contains("panicked"), "{said}");
    output
}

/// The code must be `code` and stderr must say `words`; nothing is left behind but `names`.
fn refuses(bench: &Bench, arguments: &[&str], code: i32, words: &str) {
    let names = bench.names();
    let output = stipple(bench, arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
    assert!(said.contains(words), "{arguments:?}: no `{words}` in {said}");
    assert_eq!(bench.names(), names, "{arguments:?}");
}

/// The values of an attribute, in order. Fails on what is no number.
fn numbers(svg: &str, attribute: &str) -> Vec<f64> {
    let opening = format!(" {attribute}=\"");
    let parts = svg.split(&opening).skip(1);
    parts.map(|part| part.split('"').next().unwrap().parse().unwrap()).collect()
}

#[test]
fn svg_and_png_are_written_and_summarised() {
    let bench = with_ramp();
    let output = stipple(
        &bench,
        &["ramp.png", "-n", "500", "-o", "a.svg", "-o", "a.PNG", "--json", "--iterations", "30"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("wrote a.svg, a.PNG: 500 dots of radius"), "{said}");
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&summary["points"], &summary["size"]), (&500.into(), &serde_json::json!([64, 48])));
    let energy: Vec<_> =
        summary["energy"].as_array().unwrap().iter().map(|e| e.as_f64().unwrap()).collect();
    assert_eq!(energy.len() as u64, summary["iterations"].as_u64().unwrap() + 1);
    assert!(energy.is_sorted_by(|a, b| a >= b), "{energy:?}");

    // The vector drawing: well-formed, 500 circles inside of the view box, more of them where it is dark.
    let svg = fs::read_to_string(bench.path("a.svg")).unwrap();
    assert!(svg.contains("viewBox=\"0 0 64 48\""));
    assert_eq!(svg.matches("<circle ").count(), 500);
    assert_eq!(svg.matches('<').count(), svg.matches('>').count());
    assert_eq!(svg.matches('<').count(), svg.matches("/>").count() + 2 * 2);
    let (x, y, r) = (numbers(&svg, "cx"), numbers(&svg, "cy"), numbers(&svg, "r"));
    assert_eq!([x.len(), y.len(), r.len()], [500; 3]);
    assert!(
        x.iter().all(|x| (0.0..=64.0).contains(x)) && y.iter().all(|y| (0.0..=48.0).contains(y))
    );
    assert!(r[0] > 0.0 && r.iter().all(|radius| *radius == r[0]));
    let left = x.iter().filter(|x| **x < 32.0).count();
    assert!((300..420).contains(&left), "{left}");

    // The pixels: twice as many along each side, about as light as the ramp.
    let png = read(&bench.path("a.PNG"), ColorSpace::Srgb).unwrap();
    assert_eq!([png.width(), png.height()], [128, 96]);
    let light = |image: &glint::image::Image| {
        let [w, h] = [image.width(), image.height()];
        let all = (0..h).flat_map(|y| (0..w).map(move |x| (x, y)));
        all.map(|(x, y)| f64::from(image.texel(x, y).0.g)).sum::<f64>() / f64::from(w * h)
    };
    let ramp = read(&bench.path("ramp.png"), ColorSpace::Srgb).unwrap();
    assert!((light(&png) - light(&ramp)).abs() < 0.1, "{} {}", light(&png), light(&ramp));
}

#[test]
fn bytes_follow_from_the_picture_and_the_seed() {
    let bench = with_ramp();
    let drawn = |seed: &str, threads: &str| {
        let options = ["-n", "300", "-o", "a.svg", "-o", "a.png", "--sized", "--quiet"];
        let output = stipple(
            &bench,
            &[&["ramp.png", "--seed", seed, "--threads", threads], &options[..]].concat(),
        );
        assert_eq!(output.status.code(), Some(0));
        assert!(output.stdout.is_empty() && output.stderr.is_empty());
        ["a.svg", "a.png"].map(|name| fs::read(bench.path(name)).unwrap())
    };
    let first = drawn("0", "1");
    assert!(first == drawn("0", "2") && first == drawn("0", "3"));
    assert!(first != drawn("1", "1"));
}

#[test]
fn light_can_be_drawn_on_black() {
    let bench = with_ramp();
    let arguments = ["ramp.png", "-n", "200", "-o", "a.svg", "--invert", "--gamma", "2.2"];
    assert_eq!(stipple(&bench, &arguments).status.code(), Some(0));
    let svg = fs::read_to_string(bench.path("a.svg")).unwrap();
    assert!(svg.contains("<rect width=\"64\" height=\"48\" fill=\"#000\"/>\n<g fill=\"#fff\">"));
    let left = numbers(&svg, "cx").iter().filter(|x| **x < 32.0).count();
    assert!((30..70).contains(&left), "{left}");
}

#[test]
fn small_pictures_take_more_dots_than_pixels() {
    let bench = Bench::new();
    write_png(&bench.path("dot.png"), &[[0_u8]], 1, 1).unwrap();
    for points in ["1", "3000"] {
        let output = stipple(&bench, &["dot.png", "-n", points, "-o", "a.svg", "-o", "a.png"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        let svg = fs::read_to_string(bench.path("a.svg")).unwrap();
        assert_eq!(svg.matches("<circle ").count().to_string(), points);
    }
}

#[test]
fn what_makes_no_sense_is_refused_and_leaves_nothing() {
    let bench = with_ramp();
    bench.file("no.png", "this is text");
    write_png(&bench.path("white.png"), &[[255_u8]; 12], 4, 3).unwrap();
    write_png(&bench.path("black.png"), &[[0_u8]; 12], 4, 3).unwrap();
    std::os::unix::fs::symlink("ramp.png", bench.path("link.png")).unwrap();
    let svg = ["-o", "a.svg"];
    for (arguments, code, words) in [
        (&["ramp.png"][..], 2, "--output"),
        (&["ramp.png", "-n", "0", "-o", "a.svg"], 2, "above 0"),
        (&["ramp.png", "-n", "5M", "-o", "a.svg"], 2, "at most 4194304"),
        (&["ramp.png", "-o", "a.jpg"], 2, "the ending must be .svg or .png"),
        (&["ramp.png", "-o", "a"], 2, "the ending must be .svg or .png"),
        (&["ramp.png", "-o", "a.svg", "-o", "./a.svg"], 2, "would be written twice"),
        (&["ramp.png", "-o", "ramp.png"], 2, "is the picture to draw"),
        (&["link.png", "-o", "./ramp.png"], 2, "is the picture to draw"),
        (&["ramp.png", "-o", "link.png"], 2, "is the picture to draw"),
        (&["ramp.png", "-o", "none/a.svg"], 1, "none/a.svg: cannot write"),
        (&["ramp.png", "--radius", "0", "-o", "a.svg"], 2, "0.001"),
        (&["ramp.png", "--radius", "nan", "-o", "a.svg"], 2, "0.001"),
        (&["ramp.png", "--radius", "900", "-o", "a.svg"], 2, "64 times over"),
        (&["ramp.png", "--radius", "2", "--sized", "-o", "a.svg"], 2, "cannot be used with"),
        (&["ramp.png", "--scale", "0", "-o", "a.png"], 2, "--scale"),
        (&["ramp.png", "--gamma", "0", "-o", "a.png"], 2, "--gamma"),
        (&["missing.png", svg[0], svg[1]], 1, "missing.png: cannot read"),
        (&["no.png", svg[0], svg[1]], 1, "no.png: "),
        (&["white.png", svg[0], svg[1]], 1, "white all over"),
        (&["black.png", svg[0], svg[1], "--invert"], 1, "black all over"),
    ] {
        refuses(&bench, arguments, code, words);
    }
}

#[test]
fn the_command_has_help_with_examples() {
    let bench = Bench::new();
    for (arguments, words) in [
        (&["samples", "--help"][..], "stipple"),
        (&["samples", "stipple", "--help"], "glint samples stipple portrait.png -n 20000"),
    ] {
        let output = bench.glint(arguments);
        assert_eq!(output.status.code(), Some(0));
        assert!(String::from_utf8(output.stdout).unwrap().contains(words));
    }
}
