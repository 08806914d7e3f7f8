//! The program, run in a folder of its own.

#![cfg(feature = "embree")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A model of one triangle, in the plane z = 0.
pub(crate) const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A folder of its own, and glint run in it.
pub(crate) struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a temporary folder") }
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn file(&self, name: &str, content: impl AsRef<[u8]>) -> &Self {
        fs::write(self.path(name), content).expect("a writable folder");
        self
    }

    pub(crate) fn glint(&self, arguments: &[&str]) -> Output {
        // What waits for ever fails here. (It would wait on through any signal but this one.)
        Command::new("timeout")
            .args(["--signal=KILL", "300", env!("CARGO_BIN_EXE_glint")])
            .args(arguments)
            .current_dir(self.folder())
            .output()
            .expect("glint starts")
    }

    /// Renders small; the exit code and what stderr says.
    pub(crate) fn render(&self, arguments: &[&str]) -> (i32, String) {
        let small = ["--size", "16x12", "--spp", "4"];
        let has_size = arguments.contains(&"--size");
        let small = if has_size { &small[2..] } else { &small[..] };
        let all = [&["render"][..], arguments, small].concat();
        let output = self.glint(&all);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{said}");
        (output.status.code().unwrap_or(-1), said)
    }

    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("a folder");
        let mut names: Vec<_> = entries
            .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

/// What is in an EXR file.
pub(crate) fn channels(path: &Path) -> glint::image::ExrImage {
    glint::image::read_exr_channels(path).expect("an EXR")
}
