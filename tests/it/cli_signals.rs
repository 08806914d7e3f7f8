//! Ctrl-C: before there is anything to write, and after.

#![cfg(feature = "embree")]

use crate::support::program::{Bench, TRIANGLE, channels};
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// glint at work on more samples than it will ever take; it does not outlive its test.
struct Program(Child);

impl Program {
    fn start(bench: &Bench) -> Self {
        let child = Command::new("nice")
            .args(["-n", "19", env!("CARGO_BIN_EXE_glint")])
            .args(["render", "model.obj", "--size", "512x512", "--spp", "1000000", "-o", "a.exr"])
            .current_dir(bench.folder())
            .stderr(Stdio::piped())
            .spawn();
        Self(child.expect("glint starts"))
    }

    /// Sends it the signal of Ctrl-C.
    fn interrupt(&self) {
        // The shell's own kill: a bare system has no other.
        let kill = format!("kill -INT {}", self.0.id());
        assert!(Command::new("bash").args(["-c", &kill]).status().expect("bash").success());
    }

    fn code(&mut self) -> Option<i32> {
        self.0.wait().expect("it ends").code()
    }

    /// Whether it has said what a signal of Ctrl-C does.
    fn handles_signals(&self) -> bool {
        let status =
            fs::read_to_string(format!("/proc/{}/status", self.0.id())).expect("a process");
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = u64::from_str_radix(caught.expect("signals").trim(), 16).expect("a mask");
        const SIGINT: u32 = 2;
        caught & 1 << (SIGINT - 1) != 0
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

#[test]
fn while_loading_it_ends_at_once() {
    let bench = Bench::new();
    // Half a second of work, and far more on a busy machine, where the program waits for all others and so for us.
    let vertices = (0..1_000_000).map(|i| format!("v {} {} {}\n", i % 1000, i / 1000, i % 7));
    let faces = (0..999_000).map(|i| format!("f {} {} {}\n", i + 1, i + 2, i + 1001));
    bench.file("model.obj", vertices.chain(faces).collect::<String>());
    let mut program = Program::start(&bench);
    while !program.handles_signals() {
        std::thread::sleep(Duration::from_millis(1));
    }
    program.interrupt();
    assert_eq!(program.code(), Some(130));
    assert_eq!(bench.names(), ["model.obj"]);
}

#[test]
fn while_rendering_it_writes_what_there_is_and_exits_with_3() {
    let bench = Bench::new();
    bench.file("model.obj", TRIANGLE);
    let mut program = Program::start(&bench);
    // What it says last before it renders; from then on there is something to write.
    let said = BufReader::new(program.0.stderr.take().expect("a pipe"));
    let mut lines = said.lines().map(|line| line.expect("text"));
    assert!(lines.any(|line| line.starts_with("rays are traced by ")));
    std::thread::sleep(Duration::from_secs(2));
    program.interrupt();
    assert!(lines.any(|line| line.starts_with("interrupted: ")));
    assert_eq!(lines.last().as_deref(), Some("wrote a.exr"));
    assert_eq!(program.code(), Some(3));
    assert!(channels(&bench.path("a.exr")).metadata.contains_key("glint.samples"));
}
