//! `glint samples plot`, `measure` and `zoneplate`: what they write, say and refuse.

#![cfg(feature = "embree")]

use crate::support::program::{Bench, TRIANGLE};
use crate::support::schema::{faults, schema};
use glint::image::{ColorSpace, read};
use glint::sampling::Strategy;
use serde_json::Value;
use std::fs;

/// Runs `glint samples` with these words; the exit code, stdout and stderr.
fn samples(bench: &Bench, words: &str) -> (i32, String, String) {
    let words: Vec<&str> = std::iter::once("samples").chain(words.split_whitespace()).collect();
    let output = bench.glint(&words);
    let [out, err] =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(!err.contains("panicked"), "{err}");
    (output.status.code().unwrap_or(-1), out, err)
}

/// What a command prints as JSON, after it has been held against its schema.
fn json(bench: &Bench, words: &str, command: &str) -> Value {
    let (code, out, err) = samples(bench, words);
    assert_eq!(code, 0, "{words}: {err}");
    let value: Value = serde_json::from_str(&out).unwrap();
    assert_eq!(faults(&schema(command), &value, command), Vec::<String>::new());
    value
}

fn sets() -> impl Iterator<Item = Strategy> {
    Strategy::ALL.iter().copied().filter(|strategy| strategy.has_sets())
}

#[test]
fn a_page_has_every_strategy() {
    let bench = Bench::new();
    let (code, _, err) = samples(&bench, "plot -n 16 -o page.html");
    assert_eq!(code, 0, "{err}");
    let page = fs::read_to_string(bench.path("page.html")).unwrap();
    for strategy in sets() {
        assert!(page.contains(&format!("<h3>{}</h3>", strategy.name())), "{}", strategy.name());
    }
    // Nothing is fetched, and every point is drawn.
    assert!(!page.contains("http://") && !page.contains("https://"));
    assert_eq!(page.matches("<circle ").count(), 16 * sets().count());
}

#[test]
fn drawings_have_the_names_of_their_sets() {
    let bench = Bench::new();
    let (code, _, err) = samples(&bench, "plot --sampler sobol,halton -n 9 -o a.svg -o b.png");
    assert_eq!(code, 0, "{err}");
    assert_eq!(bench.names(), ["a-halton.svg", "a-sobol.svg", "b-halton.png", "b-sobol.png"]);
    let svg = fs::read_to_string(bench.path("a-sobol.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.matches("<circle ").count() == 9);
    assert_eq!(svg.matches('<').count(), svg.matches('>').count());
    let png = read(&bench.path("b-halton.png"), ColorSpace::Srgb).unwrap();
    assert_eq!((png.width(), png.height()), (1072, 544));
}

#[test]
fn files_of_points_are_measured_and_drawn() {
    let bench = Bench::new();
    bench.file("mine.txt", "# four\n0.125 0.125\n0.625 0.125\n0.125 0.625\n\n0.625 0.625\n");
    let value = json(&bench, "measure mine.txt --json", "samples-measure");
    let set = &value["sets"][0];
    assert_eq!((&set["name"], &set["count"]), (&"mine.txt".into(), &4.into()));
    // The closed box to (5/8, 5/8) holds all four.
    let star = set["star_discrepancy"]["low"].as_f64().unwrap();
    assert!((star - (1.0 - 0.625 * 0.625)).abs() < 1e-12, "{star}");
    assert_eq!(set["min_distance"].as_f64(), Some(0.5));
    let (code, _, err) = samples(&bench, "plot mine.txt -o mine.svg");
    assert_eq!((code, err.as_str()), (0, "wrote mine.svg\n"));
}

#[test]
fn measures_and_slopes_are_those_of_the_strategies() {
    let bench = Bench::new();
    let words = "measure --sampler sobol,random -n 256 --slopes --json";
    let value = json(&bench, words, "samples-measure");
    assert_eq!(value["sets"][0]["t_value"], 0);
    let exponent = |i: usize| value["slopes"][i]["fits"][1]["exponent"].as_f64().unwrap();
    assert!(exponent(0) < -1.0 && (-0.7..-0.3).contains(&exponent(1)), "{value}");
    let (code, out, _) = samples(&bench, "measure -n 60");
    assert!(code == 0 && out.lines().count() == 1 + sets().count(), "{out}");
    // A prime number of points leaves out what needs cells; asked for by name, it is refused.
    let (code, out, _) = samples(&bench, "measure -n 61");
    assert!(code == 0 && out.lines().count() == sets().count() - 1, "{out}");
    let (code, _, err) = samples(&bench, "measure -n 61 --sampler multi-jittered");
    assert!(code == 2 && err.contains("60 or 63"), "{err}");
}

#[test]
fn zone_plates_are_drawn_and_tabulated() {
    let bench = Bench::new();
    let words = "zoneplate --sampler grid --spp 1 --filter box --size 64 -o a.png --json";
    let value = json(&bench, words, "samples-zoneplate");
    assert_eq!(value["runs"][0]["sampler"], "grid");
    let (code, _, err) = samples(&bench, "zoneplate --exact --size 64 -o b.png");
    assert_eq!(code, 0, "{err}");
    assert!(bench.names() == ["a.png", "b.png"]);
    let value = json(&bench, "zoneplate --table --spp 1,4 --size 16 --json", "samples-zoneplate");
    let runs = value["runs"].as_array().unwrap();
    let samplers = Strategy::ALL.iter().filter(|strategy| strategy.can_render()).count();
    assert_eq!(runs.len(), samplers * 6 * 2);
}

#[test]
fn mistakes_are_refused_and_leave_nothing_behind() {
    let bench = Bench::new();
    bench.file("bad.txt", "0.1 0.2\n0.3 1.5\n").file("empty.txt", "# none\n");
    bench.file("model.obj", TRIANGLE).file("points.svg", "0.1 0.2\n0.3 0.4\n");
    let names = bench.names();
    for (words, code, said) in [
        ("plot -o a.pdf", 2, "the ending must be .html, .svg or .png"),
        ("plot -n 0 -o a.svg", 2, "0"),
        ("plot --sampler sobel -o a.svg", 2, "did you mean `sobol`"),
        ("plot --sampler dart-throwing -n 100000 -o a.svg", 2, "1 to 32768"),
        ("plot points.svg -o points.svg", 2, "points.svg"),
        ("plot -n 4 -o a.svg -o a.svg", 2, "twice"),
        ("plot -n 4 -o nowhere/a.svg", 1, "nowhere/a-grid.svg"),
        ("measure missing.txt", 1, "missing.txt"),
        ("measure bad.txt", 1, "bad.txt:2"),
        ("measure empty.txt", 1, "empty.txt"),
        ("zoneplate -o a.jpg", 2, "the ending must be .png"),
        ("zoneplate --spp 1,4 -o a.png", 2, "one number of samples"),
        ("zoneplate --sampler bounded-voronoi -o a.png", 2, "take centroidal-voronoi"),
        ("zoneplate --size 100000 -o a.png", 2, "8192"),
    ] {
        let (found, _, err) = samples(&bench, words);
        assert_eq!(found, code, "{words}: {err}");
        assert!(err.contains(said), "{words}: no `{said}` in {err}");
        assert_eq!(bench.names(), names, "{words}");
    }
}

/// The grid is said to be biased, sets say their size, and the header keeps both.
#[test]
fn renders_say_how_they_sample() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    for (sampler, words) in
        [("grid", "biased"), ("jittered", "jittered (sets of 1)"), ("sobol", "sampler sobol,")]
    {
        let (code, err) = bench.render(&["model.obj", "--sampler", sampler, "-o", "a.exr"]);
        assert_eq!(code, 0, "{err}");
        assert!(err.contains(words), "{sampler}: {err}");
        // The replicates of a grid are one and the same: their spread is not its error.
        assert_eq!(err.contains("error: not known"), sampler == "grid", "{sampler}: {err}");
    }
}
