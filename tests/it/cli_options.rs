//! Options that are wrong in themselves: refused before the scene is read, which here would be an error of its own.

#![cfg(feature = "embree")]

use crate::support::program::Bench;

/// What `glint render` says of a scene that is not there: exit code and stderr.
fn refused(arguments: &[&str]) -> (Option<i32>, String) {
    let bench = Bench::new();
    let output = bench.glint(&[&["render", "missing.obj"], arguments].concat());
    assert!(bench.names().is_empty(), "{arguments:?}");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn is_wrong_usage(arguments: &[&str], words: &str) {
    let (code, said) = refused(arguments);
    assert_eq!(code, Some(2), "{arguments:?}: {said}");
    assert!(said.contains(words), "{arguments:?}: no `{words}` in: {said}");
}

#[test]
fn names_that_do_not_exist() {
    for (option, name, words) in [
        ("--effects", "pth", "unknown effects `pth`; did you mean `path`?"),
        ("--sampler", "sobel", "unknown sampler `sobel`; did you mean `sobol`?"),
        ("--filter", "bax:2", "unknown filter `bax`; did you mean `box`?"),
        ("--tonemap", "aegx", "unknown tone map `aegx`; did you mean `agx`?"),
        ("--aov", "depth,normals", "unknown AOV `normals`; did you mean `normal`?"),
        ("--override-material", "shiny", "expected diffuse:R,G,B"),
        ("-o", "image.gif", "the ending must be .exr, .png or .hdr"),
    ] {
        is_wrong_usage(&[option, name], words);
    }
}

#[test]
fn numbers_that_cannot_be() {
    for (option, value, words) in [
        ("--filter", "box:99", "up to 16"),
        ("--exposure", "nan", "expected a number"),
        ("--background", "255,255,255", "from 0 to 1"),
        ("--override-material", "diffuse:2,0,0", "from 0 to 1"),
        ("--fov", "180", "below 180"),
        ("--camera-from", "0,nan,0", "-1e15 to 1e15"),
        ("--camera-to", "1e300,0,0", "-1e15 to 1e15"),
        ("--camera-up", "0,0,0", "no direction"),
        ("--env", "constant:1,2", "expected 3 numbers"),
        ("--env", "constant:-1,0,0", "at least 0"),
        ("--env", "sky:91,0", "-90 to 90"),
        ("--env", "sky:0,inf", "any azimuth"),
        ("--size", "0x0", "1 to 65536"),
        ("--threads", "100000", "0 to 1024"),
        ("--spp", "0", "'--spp <N>'"),
    ] {
        is_wrong_usage(&[option, value], words);
    }
}

#[test]
fn options_that_contradict_each_other() {
    for (one, other, words) in [
        (["--size", "16x12"], ["--crop", "0,0,17,12"], "--crop reaches beyond the image of 16x12"),
        (["--size", "16x12"], ["--replay", "0,12,0"], "--replay reaches beyond the image"),
        (["--camera-from", "1,2,3"], ["--camera-to", "1,2,3"], "the same point"),
    ] {
        is_wrong_usage(&[one, other].concat(), words);
    }
    let down = ["--camera-from", "0,5,0", "--camera-to", "0,0,0", "--camera-up", "0,-1,0"];
    is_wrong_usage(&down, "along its view");
}

#[test]
fn an_environment_that_is_not_there() {
    let (code, said) = refused(&["--env", "missing.hdr"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("missing.hdr") && !said.contains("missing.obj"), "{said}");
}

/// How a hierarchy is built, and in how much memory, changes no pixel, on either backend.
#[cfg(feature = "bvh")]
#[test]
fn how_hierarchies_are_built_changes_no_pixel() {
    let bench = Bench::new();
    let made = bench.glint(&["generate", "hairball", "-o", "hair.obj", "--triangles", "5k"]);
    assert_eq!(made.status.code(), Some(0));
    for backend in ["embree", "bvh"] {
        let mut bytes = Vec::new();
        let pictures = ["", "--low-memory", "--quality=fast", "--quality=high"].map(|option| {
            let mut all = vec!["hair.obj", "--size", "48x48", "-o", "a.png", "--exposure", "0"];
            all.extend(["--accel", backend, "--stats", "a.json"]);
            all.extend(Some(option).filter(|option| !option.is_empty()));
            let (code, said) = bench.render(&all);
            assert_eq!(code, 0, "{said}");
            let stats = std::fs::read_to_string(bench.path("a.json")).expect("statistics");
            let stats: serde_json::Value = serde_json::from_str(&stats).expect("JSON");
            bytes.push(stats["memory_bytes"]["acceleration"].as_f64().expect("a number"));
            assert_eq!(stats["hierarchy"].is_object(), backend == "bvh");
            std::fs::read(bench.path("a.png")).expect("a picture")
        });
        assert!(pictures.iter().all(|picture| *picture == pictures[0]), "{backend}");
        assert!(bytes[1] < 0.75 * bytes[0], "{backend}: {bytes:?}");
    }
}
