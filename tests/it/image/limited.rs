//! Image files when the system is at its limits: each test runs again alone, in a process with less to take.

use super::damaged::forgeries;
use super::radiance;
use glint::image::{ColorSpace, ExrImage, read, write_exr, write_hdr, write_png};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Runs the test `name` of this binary by itself, in `dir`, after the shell command `limit`.
fn run_limited(name: &str, limit: &str, dir: &Path) {
    let output = Command::new("sh")
        .args([
            "-c",
            &format!("{limit} && exec \"$0\" --exact {name} --nocapture --test-threads 1"),
        ])
        .arg(std::env::current_exe().unwrap())
        .env("GLINT_TEST_DIR", dir)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && text.contains("1 passed"), "{text}");
}

/// The folder that [`run_limited`] gave; a test that has none does nothing.
fn limited_dir() -> Option<PathBuf> {
    std::env::var_os("GLINT_TEST_DIR").map(PathBuf::from)
}

/// With a gigabyte of address space, an attempt to hold the pixels would abort the process.
#[test]
fn forged_sizes_are_refused_without_taking_memory() {
    let dir = TempDir::new().unwrap();
    forgeries(dir.path());
    run_limited("image::limited::limited_memory", "ulimit -v 1048576", dir.path());
}

#[test]
fn limited_memory() {
    let Some(dir) = limited_dir() else { return };
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        let message = read(&path, ColorSpace::Srgb).unwrap_err().to_string();
        assert!(message.contains("scale it down"), "{message}");
    }
}

/// A disk that is full after 8 KiB: no file, no litter, an error; and an old file stays.
#[test]
fn a_full_disk_leaves_no_file() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("old.exr"), "old").unwrap();
    // Without the trap the system would kill the process instead of failing the write.
    let limit = "trap '' XFSZ && ulimit -f 16";
    run_limited("image::limited::limited_disk", limit, dir.path());
}

#[test]
fn limited_disk() {
    let Some(dir) = limited_dir() else { return };
    let n = 100;
    let pixels = radiance(n * n);
    let bytes: Vec<[u8; 3]> =
        pixels.iter().map(|p| p.to_array().map(|c| c.to_bits() as u8)).collect();
    let exr = || {
        let mut image = ExrImage::new(n as u32, n as u32);
        image.add_layer("", ["R", "G", "B"], pixels.iter().map(|p| p.to_array()));
        image
    };
    let results = [
        write_png(&dir.join("a.png"), &bytes, n as u32, n as u32),
        write_hdr(&dir.join("a.hdr"), &pixels, n as u32, n as u32),
        write_exr(&dir.join("a.exr"), exr()),
        write_exr(&dir.join("old.exr"), exr()),
    ];
    for result in results {
        let message = result.unwrap_err().to_string();
        assert!(message.contains("cannot write: File too large"), "{message}");
    }
    let left: Vec<_> = fs::read_dir(&dir).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["old.exr"]);
    assert_eq!(fs::read(dir.join("old.exr")).unwrap(), b"old");
}
