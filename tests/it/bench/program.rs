//! `glint bench` as a command: what it prints, and what it says of wrong usage.

use crate::support::program::Bench;
use crate::support::schema::{faults, not_promised, schema};
use serde_json::{Value, json};
use std::fs;

/// Quick: few rays, taken twice.
const QUICK: [&str; 6] = ["--rays", "2k", "--repetitions", "2", "--threads", "1,2"];

fn bench(bench: &Bench, arguments: &[&str]) -> (i32, String, String) {
    let output = bench.glint(&[&["bench"], arguments].concat());
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, said) = (text(&output.stdout), text(&output.stderr));
    assert!(!said.contains("panicked"), "{said}");
    (output.status.code().unwrap_or(-1), out, said)
}

/// A folder with a model that has an awkward name, and a scene that places it twice.
fn folder() -> Bench {
    let bench = Bench::new();
    let made = bench.glint(&["generate", "city", "-o", "c.obj", "--triangles", "4k"]);
    assert!(made.status.success());
    fs::rename(bench.path("c.obj"), bench.path("a<b>&'c'.obj")).unwrap();
    let twice = "[[object]]\nfile = \"a<b>&'c'.obj\"\n\n\
        [[object]]\nfile = \"a<b>&'c'.obj\"\ntranslate = [100, 0, 20]\n";
    bench.file("twice.toml", twice);
    bench
}

#[test]
fn the_schema_names_what_scripts_rely_on() {
    let promised = "runs/[]/backend runs/[]/variant runs/[]/isa runs/[]/threads runs/[]/ray_kind \
        runs/[]/rays_per_second/median runs/[]/rays_per_second/min runs/[]/rays_per_second/max \
        runs/[]/hits runs/[]/agreement/compared runs/[]/agreement/missed runs/[]/agreement/false_hits \
        runs/[]/agreement/ties runs/[]/agreement/unexplained runs/[]/agreement/reference_wrong \
        scenes/[]/rays/[]/agreed/judged scenes/[]/rays/[]/agreed/wrong scenes/[]/oracle/judged \
        scenes/[]/oracle/build_seconds scenes/[]/oracle/judge_seconds builds/[]/backend builds/[]/variant \
        builds/[]/seconds builds/[]/bytes machine/cpu machine/threads machine/date \
         frames/[]/scene frames/[]/backend frames/[]/variant frames/[]/isa frames/[]/threads frames/[]/size \
         frames/[]/samples_per_pixel frames/[]/seconds/median frames/[]/seconds/min frames/[]/seconds/max \
         frames/[]/rays_per_second frame_ratios/[]/ratio/median frame_ratios/[]/ratio/tie \
         differing_pixels/[]/count differing_pixels/[]/all differing_pixels/[]/pixels";
    assert_eq!(not_promised(&schema("bench"), promised), Vec::<String>::new());
}

#[test]
fn a_bench_of_two_scenes_says_all_of_it_in_json_and_on_a_page() {
    let folder = folder();
    let scenes = ["a<b>&'c'.obj", "twice.toml"];
    let (code, out, said) =
        bench(&folder, &[&scenes[..], &QUICK, &["--json", "-o", "r.html"]].concat());
    assert_eq!(code, 0, "{said}");
    let report: Value = serde_json::from_str(&out).expect("JSON alone on stdout");
    assert_eq!(faults(&schema("bench"), &report, ""), Vec::<String>::new());

    // Both scenes have every kind, both sides, both numbers of threads; all right and timed.
    let runs = report["runs"].as_array().unwrap();
    for scene in scenes {
        for (kind, _) in glint::study::bench::RayKind::ALL {
            for threads in [1, 2] {
                let mut backends: Vec<_> = runs
                    .iter()
                    .filter(|r| r["scene"] == scene && r["ray_kind"] == kind)
                    .filter(|r| r["threads"] == threads)
                    .filter_map(|r| r["backend"].as_str())
                    .collect();
                backends.dedup();
                let expected: &[&str] =
                    if cfg!(feature = "bvh") { &["embree", "bvh"] } else { &["embree"] };
                assert_eq!(backends, expected, "{scene} {kind} {threads}");
            }
        }
    }
    for run in runs {
        assert!(run["rays_per_second"]["median"].as_f64() > Some(0.0), "{run}");
        assert!(run["agreement"]["compared"].as_u64() > Some(100), "{run}");
    }
    for build in report["builds"].as_array().unwrap() {
        assert!(build["repetitions"].as_u64() >= Some(3), "{build}");
        assert!(build["bytes"].as_u64() > Some(10_000), "{build}");
    }
    for scene in report["scenes"].as_array().unwrap() {
        assert!(scene["oracle"]["judged"].as_u64() > Some(5000), "{scene}");
        assert!(scene["rays"].as_array().unwrap().iter().all(|r| r["agreed"]["wrong"] == 0));
    }
    assert_eq!(report["scenes"][1]["triangles"], 8000);
    assert_eq!(report["scenes"][1]["stored_triangles"], 4000);

    // The tables went to stderr.
    for words in [
        "against Embree",
        "exact oracle: ",
        "M rays/s",
        "bytes/triangle",
        "deep-bounce",
        "twice.toml",
    ] {
        assert!(said.contains(words), "no `{words}` in {said}");
    }
    assert!(said.lines().all(|line| line.chars().count() < 120), "{said}");

    // One file, which escapes names and needs nothing from elsewhere.
    let page = fs::read_to_string(folder.path("r.html")).unwrap();
    assert!(page.contains("<h2>a&lt;b&gt;&amp;&#39;c&#39;.obj</h2>"));
    assert!(!page.contains("a<b>"));
    assert_eq!(page.matches("exact oracle: ").count(), scenes.len());
    assert_eq!(page.matches("<svg").count(), 2 * 6 * 2);
    for elsewhere in ["http", "src=", "href=", "@import", "url("] {
        assert!(!page.contains(elsewhere), "{elsewhere}");
    }
}

#[test]
fn tables_go_to_stdout_unless_asked_not_to() {
    let folder = folder();
    let quick = [&["twice.toml", "--kinds", "random", "--isa", "portable"], &QUICK[..]].concat();
    let (code, out, said) = bench(&folder, &quick);
    assert_eq!(code, 0, "{said}");
    assert!(out.contains("random: 2000 rays") && !out.contains("primary"), "{out}");
    assert!(!out.contains("avx"), "{out}");
    let (code, out, said) = bench(&folder, &[&quick[..], &["--quiet"]].concat());
    assert_eq!((code, out.as_str(), said.as_str()), (0, "", ""));
}

/// Quick: a small frame, rendered twice.
const QUICK_FRAME: [&str; 9] =
    ["--frame", "--size", "32x18", "--spp", "2", "--repetitions", "2", "--threads", "1,2"];

#[test]
fn frames_of_two_scenes_are_told_in_json_and_on_a_page() {
    let folder = folder();
    let scenes = ["a<b>&'c'.obj", "twice.toml"];
    let (code, out, said) =
        bench(&folder, &[&scenes[..], &QUICK_FRAME, &["--json", "-o", "r.html"]].concat());
    assert_eq!(code, 0, "{said}");
    let report: Value = serde_json::from_str(&out).expect("JSON alone on stdout");
    assert_eq!(faults(&schema("bench"), &report, ""), Vec::<String>::new());

    let frames = report["frames"].as_array().unwrap();
    let names: Vec<_> = frames
        .iter()
        .map(|f| (f["scene"].as_str(), f["threads"].as_u64(), f["backend"].as_str()))
        .collect();
    let backends: &[&str] = if cfg!(feature = "bvh") { &["embree", "bvh"] } else { &["embree"] };
    let expected: Vec<_> = scenes
        .into_iter()
        .flat_map(|scene| [1, 2].map(|threads| (scene, threads)))
        .flat_map(|(scene, n)| backends.iter().map(move |b| (Some(scene), Some(n), Some(*b))))
        .collect();
    assert_eq!(names, expected);
    for frame in frames {
        assert!(frame["seconds"]["median"].as_f64() > Some(0.0), "{frame}");
        // Two paths in each pixel, and most of them meet something.
        assert!(frame["rays"].as_u64() > Some(32 * 18 * 2), "{frame}");
        assert_eq!((&frame["size"][0], &frame["size"][1]), (&32.into(), &18.into()));
        assert_eq!(frame["samples_per_pixel"], 2);
    }
    // No race of rays beside.
    assert!(["runs", "builds", "heats", "ratios"].iter().all(|list| report[list] == json!([])));
    let pairs = if cfg!(feature = "bvh") { 2 } else { 0 };
    assert_eq!(report["frame_ratios"].as_array().unwrap().len(), 2 * pairs);
    assert_eq!(report["differing_pixels"].as_array().unwrap().len(), pairs);
    for differing in report["differing_pixels"].as_array().unwrap() {
        let listed = differing["pixels"].as_array().unwrap().len();
        assert_eq!((&differing["count"], &differing["all"]), (&listed.into(), &(32 * 18).into()));
    }

    for words in ["32x18, 2 spp", "seconds (min-max)", "M rays/s", "embree", "twice.toml"] {
        assert!(said.contains(words), "no `{words}` in {said}");
    }
    assert_eq!(said.contains("pixels that differ between embree and bvh:"), pairs > 0, "{said}");
    assert!(said.lines().all(|line| line.chars().count() < 120), "{said}");
    let page = fs::read_to_string(folder.path("r.html")).unwrap();
    assert!(page.contains("Frame of 32x18, 2 samples a pixel") && !page.contains("a<b>"));
    // A chart for each scene and number of threads.
    assert_eq!(page.matches("<svg").count(), 2 * 2);
}

/// A red square and a green one an ulp behind it: each backend sees another one.
#[cfg(feature = "bvh")]
#[test]
fn frames_with_too_many_pixels_that_differ_exit_with_3() {
    let folder = folder();
    let square = |z: f32| {
        let corners = [(-1, -1, z), (1, -1, z + 0.3), (1, 1, z + 0.7), (-1, 1, z + 0.4)];
        corners.map(|(x, y, z)| format!("v {x} {y} {z}\n")).concat()
    };
    let (front, back) = (square(0.0), square(f32::EPSILON));
    folder.file("tie.mtl", "newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n");
    let red = format!("mtllib tie.mtl\nusemtl red\n{front}f -4 -3 -2\nf -4 -2 -1\n");
    folder.file("tie.obj", format!("{red}usemtl green\n{back}f -4 -3 -2\nf -4 -2 -1\n"));
    let (code, out, said) = bench(&folder, &[&["tie.obj"], &QUICK_FRAME[..]].concat());
    assert_eq!(code, 3, "{out}{said}");
    assert!(out.contains("MANY: more than 0.2 %"), "{out}");
}

#[test]
fn wrong_usage_exits_with_2_and_other_errors_with_1() {
    let folder = folder();
    for (arguments, code, words) in [
        (&["twice.toml", "-o", "r.txt"][..], 2, "must be .html"),
        (&["twice.toml", "--kinds", "first"], 2, "first-bounce"),
        (&["twice.toml", "--time", "90"], 2, "90s"),
        (&["twice.toml", "--time", "0s"], 2, "above 0"),
        (&["twice.toml", "--rays", "1G"], 2, "at most"),
        (&["twice.toml", "--threads", "1,many"], 2, "0 to 1024"),
        (&["twice.toml", "--isa", "neon"], 2, "avx2"),
        (&["twice.toml", "--repetitions", "0"], 2, "1..=1000"),
        (&["twice.toml", "--spp", "4"], 2, "--frame"),
        (&["twice.toml", "--size", "32x18"], 2, "--frame"),
        (&["twice.toml", "--frame", "--size", "32"], 2, "1280x720"),
        (&["twice.toml", "--frame", "--kinds", "primary"], 2, "cannot be used with"),
        (&["twice.toml", "--frame", "--rays", "1k"], 2, "cannot be used with"),
        (&[], 2, "SCENE"),
        (&["none.obj"], 1, "none.obj"),
        // Before the first one is raced.
        (&["twice.toml", "none.obj"], 1, "none.obj"),
        (&["twice.toml", "r.json"], 2, "a .toml or an .obj"),
        (&["twice.toml", "-o", "no/r.html"], 1, "cannot write"),
    ] {
        let (found, out, said) = bench(&folder, arguments);
        assert_eq!(found, code, "{arguments:?}: {said}");
        assert!(out.is_empty(), "{arguments:?}: {out}");
        assert!(said.contains(words), "{arguments:?}: {said}");
    }
    assert!(!folder.names().iter().any(|name| name.ends_with("html")));
}
