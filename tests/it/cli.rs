//! The program from outside: what a user gets for good and for bad input.

#![cfg(feature = "embree")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A folder of its own, and glint run in it.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        fs::write(self.path(name), content).expect("a writable folder");
        self
    }

    fn glint(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_glint"))
            .args(arguments)
            .current_dir(self.folder.path())
            .output()
            .expect("glint starts")
    }

    /// Renders small; the exit code and what stderr says.
    fn render(&self, arguments: &[&str]) -> (i32, String) {
        let small = ["--size", "16x12", "--spp", "4"];
        let has_size = arguments.contains(&"--size");
        let small = if has_size { &small[2..] } else { &small[..] };
        let all = [&["render"][..], arguments, small].concat();
        let output = self.glint(&all);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{said}");
        (output.status.code().unwrap_or(-1), said)
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("a folder");
        let mut names: Vec<_> = entries
            .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

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
        &["model.obj", "--sampler", "nope"],
        &["model.obj", "--filter", "box:-1"],
        &["model.obj", "--aov", "smell"],
        &["model.obj", "--tonemap", "nope"],
        &["model.obj", "--env", "constant:1,2"],
        &["model.obj", "--override-material", "shiny"],
        &["model.obj", "--crop", "0,0,999,999"],
        &["model.obj", "--camera", "nope"],
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
fn an_impossible_camera_is_an_error() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    for arguments in [
        &["model.obj", "--fov", "180"][..],
        &["model.obj", "--camera-from", "0,0,0", "--camera-to", "0,0,0"],
        &["model.obj", "--camera-up", "0,0,0"],
    ] {
        let (code, said) = bench.render(arguments);
        assert_eq!(code, 1, "{arguments:?}: {said}");
    }
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
    let (code, said) = bench.render(&["model.obj", "-o", "image.exr"]);
    assert_eq!(code, 1, "{said}");
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
        .current_dir(bench.folder.path())
        .output()
        .expect("bash starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("image.exr"), "{said}");
    assert_eq!(fs::read(bench.path("image.exr")).expect("still there"), b"old");
    assert_eq!(bench.names(), ["image.exr", "model.obj"]);
}

fn channels(path: &Path) -> glint::image::ExrImage {
    glint::image::read_exr_channels(path).expect("an EXR")
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
    for key in ["glint.version", "glint.seed", "glint.fingerprint", "glint.origin"] {
        assert!(exr.metadata.contains_key(key), "{key}");
    }
    let stats = fs::read_to_string(bench.path("s.json")).expect("statistics");
    let stats: serde_json::Value = serde_json::from_str(&stats).expect("JSON");
    for pointer in [
        "/version",
        "/command",
        "/host",
        "/backend/name",
        "/backend/version",
        "/triangles",
        "/threads",
        "/seconds/load",
        "/seconds/build",
        "/seconds/render",
        "/seconds/write",
        "/seconds/total",
        "/memory_bytes/geometry",
        "/memory_bytes/acceleration",
        "/memory_bytes/textures",
        "/memory_bytes/peak_rss",
        "/samples_per_pixel",
        "/paths",
        "/rays/camera",
        "/rays/bounce",
        "/rays/shadow",
        "/rays/total",
        "/rays_per_second",
        "/ledger/stages/0/stage",
        "/ledger/stages/0/seconds",
        "/ledger/stages/0/calls",
        "/ledger/stages/0/rays",
        "/ledger/stages/0/mean_batch",
        "/non_finite",
    ] {
        assert!(stats.pointer(pointer).is_some(), "{pointer} is not in {stats}");
    }
    assert_eq!(stats["paths"], 16 * 12 * 4);
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

/// A child that does not outlive its test.
struct Child(std::process::Child);

impl Drop for Child {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

#[test]
fn a_signal_writes_what_there_is_and_exits_with_3() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let child = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["render", "model.obj", "--size", "512x512", "--spp", "1000000", "-o", "a.exr"])
        .args(["--quiet"])
        .current_dir(bench.folder.path())
        .spawn();
    let mut child = Child(child.expect("glint starts"));
    // The handlers are set before the first file is opened; wait for the render itself.
    std::thread::sleep(std::time::Duration::from_secs(2));
    // The shell's own kill: a bare system has no other.
    let kill = format!("kill -INT {}", child.0.id());
    assert!(Command::new("bash").args(["-c", &kill]).status().expect("bash").success());
    assert_eq!(child.0.wait().expect("it ends").code(), Some(3));
    assert!(channels(&bench.path("a.exr")).metadata.contains_key("glint.samples"));
}
