//! The script `x`, in a folder of its own and with a cargo that succeeds at everything without doing it.

// Where Embree is missing `x` would install it.
#![cfg(feature = "embree")]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

/// Whether `./x test` with this in `GLINT_FULL` writes results.
fn writes_results(full: &str) -> bool {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for file in ["x", "Cargo.toml"] {
        fs::copy(root.join(file), folder.path().join(file)).expect("a copy");
    }
    let bin = folder.path().join("bin");
    fs::create_dir(&bin).expect("a folder");
    fs::write(bin.join("cargo"), "#!/bin/sh\necho cargo 999.0.0\n").expect("a cargo");
    fs::set_permissions(bin.join("cargo"), fs::Permissions::from_mode(0o755)).expect("executable");
    let output = Command::new("bash")
        .arg(folder.path().join("x"))
        .arg("test")
        .env("CARGO_HOME", folder.path())
        .env("GLINT_FULL", full)
        .output()
        .expect("x starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    folder.path().join("benches/results").exists()
}

#[test]
fn only_glint_full_1_is_the_full_run() {
    assert!(writes_results("1"));
    for less in ["", "0", "no"] {
        assert!(!writes_results(less), "GLINT_FULL={less}");
    }
}
