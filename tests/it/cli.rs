//! The program from outside: what a user gets for good and for bad input.

#![cfg(feature = "embree")]

use crate::support::program::{Bench, TRIANGLE, channels};
use glint::image::Attribute;
use std::fs;
use std::process::Command;

#[test]
fn a_bare_obj_becomes_an_exr_and_a_png() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let (code, said) = bench.render(&["model.obj"]);
    assert_eq!(code, 0, "{said}");
    assert_eq!(bench.names(), ["model.exr", "model.obj", "model.png"]);
    for words in ["lit by a clear sky", "camera automatic", "rays/s", "wrote model.exr, model.png"]
    {
        assert!(said.contains(words), "no `{words}` in: {said}");
    }
    let exr = glint::image::read_exr_channels(&bench.path("model.exr")).expect("an EXR");
    assert_eq!((exr.width, exr.height), (16, 12));
    let alpha = exr.channel("A").expect("alpha");
    assert!(alpha.contains(&1.0) && alpha.contains(&0.0));
}

#[test]
fn bad_input_gets_a_clear_error_and_leaves_nothing_behind() {
    let cases: [(&str, &[u8], &[&str]); 6] = [
        ("missing.obj", b"", &["missing.obj", "cannot"]),
        ("empty.obj", b"", &["empty.obj"]),
        ("junk.obj", &[0xff, 0x00, 0x13, 0x37, 0x80, 0x0a, 0x00], &["junk.obj"]),
        ("points.obj", b"v 0 0 0\nv 1 1 1\n", &["points.obj"]),
        ("index.obj", b"v 0 0 0\nf 1 2 3\n", &["index.obj"]),
        ("scene.toml", b"[film]\nsize = 3\n", &["scene.toml:2"]),
    ];
    for (name, content, words) in cases {
        let bench = Bench::new();
        if name != "missing.obj" {
            bench.file(name, content);
        }
        let before = bench.names();
        let (code, said) = bench.render(&[name]);
        assert_eq!(code, 1, "{name}: {said}");
        assert!(said.starts_with("error: ") || said.contains("\nerror: "), "{name}: {said}");
        for word in words {
            assert!(said.contains(word), "{name}: no `{word}` in {said}");
        }
        assert_eq!(bench.names(), before, "{name}");
    }
    let bench = Bench::new();
    fs::create_dir(bench.path("folder.obj")).expect("a folder");
    let (code, said) = bench.render(&["folder.obj"]);
    assert_eq!(code, 1, "{said}");
}

#[test]
fn a_bad_part_is_dropped_with_its_line() {
    let bench = Bench::new();
    let obj =
        "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\nf 1 2 9\n";
    bench.file("model.obj", obj).file("m.mtl", "newmtl a\nKd 1 1 1\nmap_Kd missing.png\n");
    let (code, said) = bench.render(&["model.obj"]);
    assert_eq!(code, 0, "{said}");
    for words in ["model.obj:9", "m.mtl:3", "missing.png"] {
        assert!(said.contains(words), "no `{words}` in {said}");
    }
    let (code, _) = bench.render(&["model.obj", "--strict"]);
    assert_eq!(code, 3);
}

#[test]
fn wrong_usage_exits_with_2() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    for arguments in [
        &["model.obj", "--size", "0x0"][..],
        &["model.obj", "--size", "10"],
        &["model.obj", "--filter", "box:-1"],
        &["model.obj", "--env", "constant:1,2"],
        &["model.obj", "--override-material", "shiny"],
        &["model.obj", "--crop", "0,0,999,999"],
        &["model.obj", "-o", "image.gif"],
        &["model.obj", "--no-such-option"],
        &["model.obj", "--spp", "0"],
    ] {
        let (code, said) = bench.render(arguments);
        assert_eq!(code, 2, "{arguments:?}: {said}");
        assert_eq!(bench.names(), ["model.obj"], "{arguments:?}");
    }
}

#[test]
fn an_unknown_name_gets_the_names_there_are_and_the_likeliest() {
    let bench = Bench::new();
    let scene =
        "[camera.front]\nfrom = [0, 0, 3]\nto = [0, 0, 0]\nperspective = { vertical_fov = 35 }\n";
    let scene = format!("{scene}[[object]]\nfile = 'model.obj'\n");
    bench.file("model.obj", TRIANGLE).file("scene.toml", scene);
    for (option, name, words) in [
        (
            "--effects",
            "pth",
            ["unknown effects `pth`", "did you mean `path`?", "Known: `auto`, `all`"],
        ),
        (
            "--effects",
            "all,no-glosy",
            ["unknown effects `glosy`", "did you mean `glossy`?", "`mirror`"],
        ),
        ("--sampler", "sobel", ["unknown sampler `sobel`", "did you mean `sobol`?", "`random`"]),
        ("--filter", "bax:2", ["unknown filter `bax`", "did you mean `box`?", "`lanczos`"]),
        ("--tonemap", "aegx", ["unknown tone map `aegx`", "did you mean `agx`?", "`reinhard`"]),
        ("--aov", "depth,normals", ["unknown AOV `normals`", "did you mean `normal`?", "`uv`"]),
        ("--camera", "frnt", ["unknown camera `frnt`", "did you mean `front`?", "Known: `front`"]),
    ] {
        let (code, said) = bench.render(&["scene.toml", option, name]);
        assert_eq!(code, 2, "{option} {name}: {said}");
        for word in words {
            assert!(said.contains(word), "no `{word}` in: {said}");
        }
    }
    assert_eq!(bench.names(), ["model.obj", "scene.toml"]);
}

#[test]
fn effects_are_said_by_word_or_by_file() {
    let bench = Bench::new();
    let scene = "[render]\neffects = 'all,no-refraction'\n[[object]]\nfile = 'model.obj'\n";
    bench.file("model.obj", TRIANGLE).file("scene.toml", scene);
    for (arguments, effects) in [
        (&["model.obj"][..], "auto"),
        (&["model.obj", "--effects", "path"], "auto"),
        (&["model.obj", "--effects", "whitted,no-mirror"], "auto,no-diffuse"),
        (&["scene.toml"], "all,no-refraction"),
        (&["scene.toml", "--effects", "direct"], "direct"),
    ] {
        let (code, said) = bench.render(&[arguments, &["-o", "a.exr"]].concat());
        assert_eq!(code, 0, "{said}");
        assert!(said.contains(&format!("effects {effects}")), "{said}");
    }
    bench.file("scene.toml", scene.replace("all,no-refraction", "paths"));
    let (code, said) = bench.render(&["scene.toml"]);
    assert_eq!(code, 1);
    assert!(said.contains("scene.toml:2: unknown effects `paths`; did you mean `path`?"), "{said}");
}

#[test]
fn an_impossible_camera_is_an_error() {
    let bench = Bench::new();
    let camera = "from = [0, 0, 3]\nto = [0, 0, 0]\northographic = { height = 2 }\n";
    let scene = format!("[camera.front]\n{camera}[[object]]\nfile = 'model.obj'\n");
    bench.file("model.obj", TRIANGLE).file("scene.toml", scene);
    // Impossible with this scene only; what is impossible with any is wrong usage.
    let (code, said) = bench.render(&["scene.toml", "--camera-to", "0,0,3"]);
    assert_eq!(code, 1, "{said}");
    let (code, said) = bench.render(&["scene.toml", "--fov", "40"]);
    assert_eq!(code, 2, "{said}");
}

#[test]
fn an_output_that_cannot_be_written_is_refused_before_rendering() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE).file("file", "");
    for output in ["no/such/folder/image.exr", "file/image.png", "/proc/image.exr"] {
        // A million samples: it would not come back in time if it rendered first.
        let (code, said) = bench.render(&["model.obj", "-o", output, "--size", "512x512"]);
        assert_eq!(code, 1, "{output}: {said}");
        assert!(said.contains("cannot write") || said.contains("cannot create"), "{said}");
    }
    fs::create_dir(bench.path("image.exr")).expect("a folder");
    for arguments in [["-o", "image.exr"], ["--stats", "no/such/folder/stats.json"]] {
        let (code, said) = bench.render(&[&["model.obj"], &arguments[..]].concat());
        assert_eq!(code, 1, "{said}");
        assert_eq!(bench.names(), ["file", "image.exr", "model.obj"]);
    }
}

/// A file size limit is what a full disk looks like to a process.
#[test]
fn a_full_disk_leaves_the_old_file() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE).file("image.exr", "old");
    let glint = env!("CARGO_BIN_EXE_glint");
    let line = format!(
        "trap '' XFSZ; ulimit -f 8; '{glint}' render model.obj --size 256x256 --spp 1 -o image.exr"
    );
    let output = Command::new("bash")
        .args(["-c", &line])
        .current_dir(bench.folder())
        .output()
        .expect("bash starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("image.exr"), "{said}");
    assert_eq!(fs::read(bench.path("image.exr")).expect("still there"), b"old");
    assert_eq!(bench.names(), ["image.exr", "model.obj"]);
}

#[test]
fn layers_statistics_and_header_say_what_was_done() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let names = "normal,albedo,depth,position,uv,primitive,material,samples,variance";
    let (code, said) = bench.render(&[
        "model.obj",
        "-o",
        "a.exr",
        "--aov",
        names,
        "--stats",
        "s.json",
        "--seed",
        "7",
    ]);
    assert_eq!(code, 0, "{said}");
    let exr = channels(&bench.path("a.exr"));
    let expected = [
        "R",
        "G",
        "B",
        "A",
        "normal.X",
        "albedo.R",
        "depth.Z",
        "position.X",
        "uv.U",
        "material.id",
        "primitive.primitive",
        "samples.N",
        "variance.R",
    ];
    for name in expected {
        assert!(exr.channels.contains_key(name), "{name} is not in {:?}", exr.channels.keys());
    }
    assert!(exr.channel("depth.Z").expect("depth").contains(&f32::INFINITY));
    assert_eq!(exr.channel("samples.N").expect("samples")[0], 4.0);
    for key in ["glint.version", "glint.seed", "glint.fingerprint", "glint.origin", "glint.error"] {
        assert!(exr.metadata.contains_key(key), "{key}");
    }
    let stats = fs::read_to_string(bench.path("s.json")).expect("statistics");
    let stats: serde_json::Value = serde_json::from_str(&stats).expect("JSON");
    assert_eq!(stats["paths"], 16 * 12 * 4);
}

/// The header's settings are options that make the same picture again, with the camera that was found.
#[test]
fn a_header_says_how_to_make_the_picture_again() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let first = ["model.obj", "-o", "a.exr", "--seed", "3", "--up", "z", "--crop", "3,2,16,11"];
    let (code, said) = bench.render(&first);
    assert_eq!(code, 0, "{said}");
    let settings = channels(&bench.path("a.exr")).metadata["glint.settings"].clone();
    let Attribute::Text(settings) = settings else { panic!("{settings:?}") };
    let again = ["render", "model.obj", "-o", "b.exr"].into_iter().chain(settings.split(' '));
    let output = bench.glint(&again.collect::<Vec<_>>());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let [a, b] = ["a.exr", "b.exr"].map(|name| channels(&bench.path(name)));
    assert_eq!(a.channels, b.channels, "{settings}");
    assert_eq!(a.metadata["glint.settings"], b.metadata["glint.settings"]);
}

#[test]
fn json_goes_to_stdout_and_quiet_is_quiet() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let base = ["render", "model.obj", "--size", "8x8", "--spp", "1", "-o", "a.png"];
    let output = bench.glint(&[&base[..], &["--json", "--quiet"]].concat());
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON alone");
    assert_eq!(json["samples_per_pixel"], 1);
}

#[test]
fn the_fingerprint_follows_contents_and_settings() {
    let fingerprint_at = |obj: &str, seed: &str| {
        let bench = Bench::new();
        bench.file("model.obj", obj);
        assert_eq!(bench.render(&["model.obj", "-o", "a.exr", "--seed", seed]).0, 0);
        channels(&bench.path("a.exr")).metadata["glint.fingerprint"].clone()
    };
    let fingerprint = |obj: &str| fingerprint_at(obj, "0");
    assert_eq!(fingerprint(TRIANGLE), fingerprint(TRIANGLE));
    assert_ne!(fingerprint(TRIANGLE), fingerprint_at(TRIANGLE, "1"));
    assert_ne!(fingerprint(TRIANGLE), fingerprint(&TRIANGLE.replace("v 1 0 0", "v 2 0 0")));
}

#[test]
fn a_replayed_sample_is_the_one_that_was_rendered() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let env = ["model.obj", "--env", "constant:1,1,1", "--size", "8x8", "--filter", "box"];
    let render = [&["render"], &env[..], &["--spp", "1", "-o", "a.exr"]].concat();
    assert!(bench.glint(&render).status.success());
    let red = channels(&bench.path("a.exr")).channel("R").expect("R")[4 * 8 + 4];
    let output = bench.glint(&[&["render"], &env[..], &["--replay", "4,4,0"]].concat());
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains(&format!("radiance {red} ")), "{red}: {said}");
}
