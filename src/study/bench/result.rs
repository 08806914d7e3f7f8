//! What a bench found out, in the names of `--json`: SI units, bytes, counts.
//!
//! The schema is `tests/schemas/bench.json`, generated from these types by a test. All lists are flat; `scene`
//! says where an entry belongs.

use super::agreement::Agreement;
use super::frame_result::{DifferingPixels, Frame, FrameFindings, FrameRatio};
use super::judge::Judging;
use super::sample::Sample;
use super::statistics::{Ratio, Spread};
use crate::error::Result;
use serde::Serialize;

/// Everything about one run of `glint bench`.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Report {
    /// Of glint.
    pub version: &'static str,
    /// The command line.
    pub command: String,
    /// Where it ran.
    pub machine: Machine,
    /// What was traced.
    pub scenes: Vec<Scene>,
    /// What building took.
    pub builds: Vec<Build>,
    /// Embree's calls for several rays: how fast each was on a sample. The best two went into the race.
    pub heats: Vec<Heat>,
    /// The race.
    pub runs: Vec<Run>,
    /// The in-house BVH against Embree.
    pub ratios: Vec<Comparison>,
    /// Whole frames; with them there is none of the four lists before.
    pub frames: Vec<Frame>,
    /// The in-house BVH against Embree, whole frames.
    pub frame_ratios: Vec<FrameRatio>,
    /// Where the pictures of both differ.
    pub differing_pixels: Vec<DifferingPixels>,
}

/// Where a bench ran.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Machine {
    /// Name of the processor.
    pub cpu: String,
    /// Threads that it runs at once.
    pub threads: usize,
    /// When the bench began (UTC, RFC 3339).
    pub date: String,
    /// Version of Embree; nothing where it is not built in.
    pub embree: Option<String>,
}

/// A scene, and how it was benched.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Scene {
    /// As the user named it.
    pub scene: String,
    /// With every instance counted.
    pub triangles: usize,
    /// In memory.
    pub stored_triangles: usize,
    /// Vertices and indices.
    pub geometry_bytes: usize,
    /// Rays of each kind that the scene has any for.
    pub rays: Vec<RayCount>,
    /// How often each contestant's time was taken.
    pub repetitions: usize,
    /// Turns that were repeated because the machine was busy.
    pub repeated_turns: usize,
    /// The fixed piece of arithmetic that shows a busy machine, for each number of threads.
    pub probes: Vec<ProbeSpread>,
    /// What the exact oracle did.
    pub oracle: Judging,
    /// Wall-clock seconds of the whole bench.
    pub seconds: f64,
}

/// How many rays of a kind there are.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct RayCount {
    /// Name of the kind.
    pub ray_kind: &'static str,
    /// Rays.
    pub rays: usize,
    /// Those that meet a surface, by the reference.
    pub hits: usize,
    /// Some of the rays on which all agree.
    pub agreed: Sample,
}

/// How evenly a fixed piece of arithmetic ran between the turns: times in units of the shortest.
#[derive(Clone, Copy, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct ProbeSpread {
    /// On so many threads at once.
    pub threads: usize,
    /// Half of the probes were quicker.
    pub median: f64,
    /// 95 of 100 were quicker.
    pub p95: f64,
    /// The slowest.
    pub max: f64,
}

/// What building a structure took.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Build {
    /// Of which scene.
    pub scene: String,
    /// "embree" or "bvh".
    pub backend: &'static str,
    /// Quality and kind.
    pub variant: String,
    /// Threads that worked on it.
    pub threads: usize,
    /// Median.
    pub seconds: f64,
    /// Shortest.
    pub seconds_min: f64,
    /// Longest.
    pub seconds_max: f64,
    /// How often it was built.
    pub repetitions: usize,
    /// Nodes and leaves, without vertices and indices.
    pub bytes: usize,
    /// The same for each stored triangle.
    pub bytes_per_triangle: f64,
    /// Inner nodes of the trees over triangles; of the in-house BVH only, as all that follows.
    pub nodes: Option<usize>,
    /// Their leaves.
    pub leaves: Option<usize>,
    /// Longest way from a root to an inner node, in nodes.
    pub depth: Option<usize>,
    /// Nodes and leaves that a random ray is expected to visit, by the surface area heuristic.
    pub sah_cost: Option<f64>,
}

/// A call of Embree's that had to qualify, on one thread.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Heat {
    /// Of which scene.
    pub scene: String,
    /// Scene variant and call.
    pub variant: String,
    /// Of which rays.
    pub ray_kind: &'static str,
    /// The best of three short runs; nothing where answers were wrong.
    pub rays_per_second: Option<f64>,
    /// Whether it went into the race.
    pub qualified: bool,
}

/// A contestant on one kind of rays.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Run {
    /// Of which scene.
    pub scene: String,
    /// "embree" or "bvh".
    pub backend: &'static str,
    /// How it was built and is called.
    pub variant: String,
    /// The widest instructions that it may use.
    pub isa: &'static str,
    /// How many threads traced at once.
    pub threads: usize,
    /// Which rays.
    pub ray_kind: &'static str,
    /// Over the repetitions; nothing where answers were wrong.
    pub rays_per_second: Option<Spread>,
    /// Rays that met a surface.
    pub hits: usize,
    /// Of its answers with the reference's.
    pub agreement: Agreement,
    /// Turns that were timed though the machine was busy, of every repetition.
    pub busy_turns: usize,
}

/// The in-house BVH's speed over a rival's.
#[derive(Clone, Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub struct Comparison {
    /// Of which scene.
    pub scene: String,
    /// On which rays.
    pub ray_kind: &'static str,
    /// On how many threads.
    pub threads: usize,
    /// Instructions of the in-house BVH.
    pub isa: &'static str,
    /// How the in-house BVH is called.
    pub variant: String,
    /// "baseline" (Embree as renders use it: robust, a ray at a time) or "best" (the fastest of all).
    pub against: &'static str,
    /// The rival.
    pub rival: String,
    /// Above 1, the in-house BVH is the faster one.
    pub ratio: Ratio,
}

impl Scene {
    /// What the exact oracle found, in a line.
    pub fn verdict(&self) -> String {
        let Judging { judged, build_seconds, judge_seconds } = self.oracle;
        let sum = |count: fn(&Sample) -> usize| self.rays.iter().map(|r| count(&r.agreed)).sum();
        let (agreed, wrong): (usize, usize) = (sum(|s| s.judged), sum(|s| s.wrong));
        format!(
            "exact oracle: {} answers that differ judged, {agreed} that all agree on, of which {wrong} wrong; \
             {build_seconds:.1} + {judge_seconds:.1} s",
            judged - agreed
        )
    }
}

impl Report {
    /// Nothing found out yet, on this machine, by the command line `command`.
    ///
    /// # Errors
    /// Where Embree is built in but does not run here.
    pub fn new(command: String) -> Result<Self> {
        Ok(Self {
            version: env!("CARGO_PKG_VERSION"),
            command,
            machine: Machine::here()?,
            scenes: Vec::new(),
            builds: Vec::new(),
            heats: Vec::new(),
            runs: Vec::new(),
            ratios: Vec::new(),
            frames: Vec::new(),
            frame_ratios: Vec::new(),
            differing_pixels: Vec::new(),
        })
    }

    /// Runs whose answers were wrong, and which therefore have no time.
    pub fn disqualified(&self) -> impl Iterator<Item = &Run> {
        self.runs.iter().filter(|run| run.rays_per_second.is_none())
    }

    /// Adds the findings of a bench of another scene.
    pub fn add(&mut self, other: Findings) {
        self.scenes.push(other.scene);
        self.builds.extend(other.builds);
        self.heats.extend(other.heats);
        self.runs.extend(other.runs);
        self.ratios.extend(other.ratios);
    }

    /// Adds the findings of frames of another scene.
    pub fn add_frames(&mut self, other: FrameFindings) {
        self.scenes.push(other.scene);
        self.frames.extend(other.frames);
        self.frame_ratios.extend(other.ratios);
        self.differing_pixels.extend(other.differing_pixels);
    }
}

/// What a bench found out about one scene.
#[derive(Clone, Debug)]
pub struct Findings {
    /// The scene.
    pub scene: Scene,
    /// See [`Report`], as the others.
    pub builds: Vec<Build>,
    /// Heats.
    pub heats: Vec<Heat>,
    /// Runs.
    pub runs: Vec<Run>,
    /// Ratios.
    pub ratios: Vec<Comparison>,
}
