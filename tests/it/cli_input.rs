//! The program and the files that it reads: what is no file, and what no one can see.

#![cfg(feature = "embree")]

use crate::support::program::{Bench, TRIANGLE};
use std::fs;
use std::os::unix::net::UnixListener;
use std::process::Command;

/// A triangle of material `a` and one of `b`, whose library is `m.mtl`.
const TWO_MATERIALS: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n\
    usemtl a\nf 1 2 3\nusemtl b\nf 2 4 3\n";

fn pipe(bench: &Bench, name: &str) {
    let made = Command::new("mkfifo").arg(bench.path(name)).status();
    assert!(made.expect("mkfifo starts").success());
}

/// A render with `arguments` must end with `code` and say `words`.
fn says(bench: &Bench, arguments: &[&str], code: i32, words: &[&str]) {
    let (found, said) = bench.render(&[arguments, &["-o", "image.exr"]].concat());
    assert_eq!(found, code, "{arguments:?}: {said}");
    for word in words {
        assert!(said.contains(word), "{arguments:?}: no `{word}` in: {said}");
    }
}

#[test]
fn pipes_devices_and_sockets_are_not_read() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    for ending in ["obj", "toml", "hdr", "png", "mtl"] {
        pipe(&bench, &format!("pipe.{ending}"));
        std::os::unix::fs::symlink("/dev/zero", bench.path(&format!("zero.{ending}"))).unwrap();
    }
    let _socket = UnixListener::bind(bench.path("socket.obj")).expect("a socket");
    for (name, kind) in [
        ("pipe.obj", "pipe"),
        ("pipe.toml", "pipe"),
        ("zero.obj", "device"),
        ("zero.toml", "device"),
        ("socket.obj", "socket"),
    ] {
        let reason = format!("{name}: cannot read: this is not a regular file but a {kind}");
        says(&bench, &[name], 1, &[&reason]);
    }
    for kind in ["pipe", "zero"] {
        // Named in a scene file: an error with its line.
        let scene = |text: &str| bench.file("scene.toml", text).path("scene.toml");
        scene(&format!("[[object]]\nfile = '{kind}.obj'\n"));
        says(&bench, &["scene.toml"], 1, &["scene.toml:2", "not a regular file"]);
        let object = "[[object]]\nfile = 'model.obj'\n";
        scene(&format!("{object}[environment.image]\nfile = '{kind}.hdr'"));
        says(&bench, &["scene.toml"], 1, &["scene.toml:4", "not a regular file"]);
        let env = format!("{kind}.hdr");
        says(&bench, &["model.obj", "--env", &env], 1, &[&env, "not a regular file"]);

        // Named in a model: a warning with its line, and a picture without it.
        bench.file("a.obj", format!("mtllib {kind}.mtl\nusemtl a\n{TRIANGLE}"));
        says(&bench, &["a.obj"], 0, &["a.obj:1", "not a regular file"]);
        bench.file("b.obj", format!("mtllib m.mtl\nusemtl a\n{TRIANGLE}"));
        bench.file("m.mtl", format!("newmtl a\nmap_Kd {kind}.png\n"));
        says(&bench, &["b.obj"], 0, &["m.mtl:2", "not a regular file", "stand-in"]);
    }
}

/// A terabyte of nothing, which takes no room on the disk.
#[test]
fn a_scene_file_beyond_all_measure_is_refused() {
    let bench = Bench::new();
    let file = fs::File::create(bench.path("scene.toml")).expect("a writable folder");
    if file.set_len(1 << 40).is_ok() {
        says(&bench, &["scene.toml"], 1, &["scene.toml: more than 256 MiB"]);
    }
}

#[test]
fn materials_that_no_one_sees_are_not_looked_at() {
    let bench = Bench::new();
    bench.file("model.obj", TWO_MATERIALS).file("broken.png", "no image");
    bench.file("m.mtl", "newmtl a\nmap_Kd missing.png\nKd purple\nnewmtl b\nmap_Kd broken.png\n");
    let broken = ["missing.png", "broken.png", "m.mtl:3"];
    says(&bench, &["model.obj"], 0, &broken);
    says(&bench, &["model.obj", "--strict"], 3, &[]);

    // The command line's material, on a model that stands once and on one that stands twice.
    let object = "[[object]]\nfile = 'model.obj'\n";
    bench.file("twice.toml", format!("{object}{object}translate = [2, 0, 0]\n"));
    for scene in ["model.obj", "twice.toml"] {
        let grey = ["--override-material", "diffuse:0.5,0.5,0.5"];
        // It has no light, which is worth a word; so it gets one.
        let lit = ["--env", "constant:1,1,1", "--strict"];
        says(&bench, &[&[scene], &grey[..], &lit].concat(), 0, &["wrote"]);
    }

    // The scene file's material, on every placement, on one of them, and on one of the materials.
    let material =
        "[material.red.lambert]\nalbedo = [1, 0, 0]\n[environment.constant]\nradiance = 1\n";
    let red = format!("{object}material = 'red'\n");
    bench.file("all.toml", format!("{red}{red}{material}"));
    says(&bench, &["all.toml", "--strict"], 0, &["wrote"]);
    bench.file("one.toml", format!("{red}{object}{material}"));
    says(&bench, &["one.toml", "--strict"], 3, &broken);
    bench.file("a.toml", format!("{object}{material}[override]\na = 'red'\nb = 'red'"));
    let (_, said) = bench.render(&["a.toml", "-o", "image.exr"]);
    assert!(!said.contains(".png"), "{said}");
}

#[test]
fn an_environment_that_is_replaced_is_not_looked_at() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE).file("broken.hdr", "no image");
    let scene = "[[object]]\nfile = 'model.obj'\n[environment.image]\nfile = 'broken.hdr'\n";
    bench.file("scene.toml", scene);
    says(&bench, &["scene.toml"], 1, &["scene.toml:4", "broken.hdr"]);
    says(&bench, &["scene.toml", "--env", "constant:1,1,1", "--strict"], 0, &["wrote"]);
}

/// A second core would show: the machine's default here is eight threads.
#[test]
fn threads_bounds_every_thread() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let layers = "normal,albedo,position,primitive,variance";
    let mut child = Command::new(env!("CARGO_BIN_EXE_glint"))
        .args(["render", "model.obj", "--size", "512x512", "--spp", "1", "--threads", "1"])
        .args(["-o", "a.exr", "--quiet", "--aov", layers])
        .env("RAYON_NUM_THREADS", "8")
        .current_dir(bench.folder())
        .spawn()
        .expect("glint starts");
    let tasks = format!("/proc/{}/task", child.id());
    let mut most = 0;
    let status = loop {
        most = most.max(fs::read_dir(&tasks).map_or(0, |list| list.count()));
        if let Some(status) = child.try_wait().expect("a child") {
            break status;
        }
        std::thread::sleep(std::time::Duration::from_millis(1));
    };
    assert!(status.success());
    assert!((1..8).contains(&most), "{most} threads");
}
