//! What a machine did: the JSON of `--stats` and `--json`, in SI units, bytes and counts.
//!
//! Its schema is `tests/schemas/render.json`, generated from these types by a test. Must not print.

use super::plan;
use super::render::Job;
use super::select::Settings;
use crate::accel::BuildStats;
use crate::film::{ErrorEstimate, Film};
use crate::os::peak_rss_bytes;
use crate::plan::Row;
use crate::render::{Bill, Forecast, Rendered};
use crate::sampling::Strategy;
use serde::Serialize;

/// Wall-clock seconds of each phase.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Phases {
    pub(super) load: f64,
    pub(super) build: f64,
    pub(super) render: f64,
    pub(super) write: f64,
    pub(super) total: f64,
}

/// What `glint render` did and what it cost.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Statistics {
    /// Of glint.
    version: &'static str,
    /// The command line.
    command: String,
    /// Name of the machine.
    host: String,
    backend: BackendName,
    /// With every instance counted.
    triangles: usize,
    threads: usize,
    seconds: Phases,
    memory_bytes: Memory,
    /// What the hierarchy is made of, where the backend says so.
    hierarchy: Option<Hierarchy>,
    /// The least that a pixel got.
    samples_per_pixel: u64,
    paths: u64,
    rays: Rays,
    /// Of the render alone.
    rays_per_second: f64,
    plan: Vec<PlanRow>,
    /// The bill, by stage and by class.
    pub(super) ledger: Bill,
    /// The error to be expected of the image, from the spread of its replicates; none of a black or biased image.
    pub(super) error: Option<ErrorEstimate>,
    /// Samples that were not finite and are not in the image.
    non_finite: u64,
    /// Hash of the settings and of the contents of every file read.
    fingerprint: String,
}

/// What found what rays hit.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct BackendName {
    name: &'static str,
    version: String,
}

/// Bytes; the peak is of the whole process.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct Memory {
    geometry: usize,
    acceleration: usize,
    textures: usize,
    film: usize,
    peak_rss: u64,
}

/// The trees over triangles together, each object's once.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct Hierarchy {
    nodes: usize,
    leaves: usize,
    /// Longest way from a root to an inner node, in nodes.
    depth: usize,
    /// Nodes and leaves that a random ray is expected to visit, by the surface area heuristic.
    sah_cost: f64,
    /// Of nodes and leaves, for each stored triangle.
    bytes_per_triangle: f64,
}

/// Rays traced.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
struct Rays {
    camera: u64,
    bounce: u64,
    shadow: u64,
    total: u64,
}

/// One effect or strategy: whether it was simulated, and why.
#[derive(Debug, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct PlanRow {
    effect: &'static str,
    on: bool,
    reason: String,
    /// `FILE:LINE` of what calls for it.
    source: Option<String>,
    /// Part of the time that it was predicted to take; of what is off, that it would take if everything ran.
    predicted_share: Option<f64>,
}

impl Statistics {
    pub(super) fn new(
        job: &Job<'_>,
        build: BuildStats,
        rendered: &Rendered,
        bill: Bill,
        mut seconds: Phases,
    ) -> Self {
        let world = &job.prepared.world;
        seconds.total = seconds.load + seconds.build + seconds.render + seconds.write;
        let ledger = &rendered.ledger;
        Self {
            version: env!("CARGO_PKG_VERSION"),
            command: command(),
            host: host(),
            backend: BackendName { name: job.name.0, version: job.name.1.clone() },
            triangles: world.geometry.placed_triangles(),
            threads: match job.args.threads {
                0 => std::thread::available_parallelism().map_or(1, usize::from),
                n => n,
            },
            seconds,
            memory_bytes: Memory {
                geometry: world.geometry.bytes(),
                acceleration: build.bytes,
                textures: world.texture_bytes(),
                film: rendered.film.region().pixels() * Film::BYTES_PER_PIXEL
                    + rendered.classes.bytes(),
                peak_rss: peak_rss_bytes(),
            },
            hierarchy: build.shape.map(|shape| Hierarchy {
                nodes: shape.nodes,
                leaves: shape.leaves,
                depth: shape.depth,
                sah_cost: shape.sah_cost,
                bytes_per_triangle: build.bytes as f64
                    / world.geometry.stored_triangles().max(1) as f64,
            }),
            samples_per_pixel: rendered.film.samples().0,
            paths: ledger.camera_rays(),
            rays: Rays {
                camera: ledger.camera_rays(),
                bounce: ledger.bounce_rays(),
                shadow: ledger.shadow_rays(),
                total: ledger.rays(),
            },
            rays_per_second: ledger.rays() as f64 / rendered.seconds.max(1e-9),
            plan: plan::rows(&job.prepared.plan, None),
            ledger: bill,
            error: image_error(&job.prepared.settings, rendered),
            non_finite: rendered.non_finite.count,
            fingerprint: job.prepared.fingerprint.clone(),
        }
    }

    /// The most important of it, in lines for people.
    pub(super) fn summary(&self) -> [String; 3] {
        let megabytes = |bytes: u64| bytes as f64 / 1e6;
        let (s, memory) = (&self.seconds, &self.memory_bytes);
        [
            format!(
                "load {:.2} s, build {:.2} s, render {:.2} s, write {:.2} s",
                s.load, s.build, s.render, s.write
            ),
            format!(
                "{:.2} M rays/s, {} paths, {} rays; {} {}, {} threads; {:.0} MB ({:.0} geometry, \
                 {:.0} acceleration, {:.0} textures, {:.0} film)",
                self.rays_per_second / 1e6,
                self.paths,
                self.rays.total,
                self.backend.name,
                self.backend.version,
                self.threads,
                megabytes(memory.peak_rss),
                megabytes(memory.geometry as u64),
                megabytes(memory.acceleration as u64),
                megabytes(memory.textures as u64),
                megabytes(memory.film as u64),
            ),
            format!("error: {}", error_in_words(self.error.as_ref())),
        ]
    }
}

impl PlanRow {
    pub(super) fn new(row: &Row, forecast: Option<&Forecast>) -> Self {
        Self {
            effect: row.effect,
            on: row.on,
            reason: row.reason.clone(),
            source: row.source.as_ref().map(ToString::to_string),
            predicted_share: forecast.and_then(|forecast| forecast.share(row)),
        }
    }
}

/// The error of a render; none where the replicates are not independent.
pub(super) fn image_error(settings: &Settings, rendered: &Rendered) -> Option<ErrorEstimate> {
    let is_random = settings.sampler != Strategy::Grid;
    is_random.then(|| rendered.film.error()).flatten()
}

/// The same for people.
pub(super) fn error_in_words(error: Option<&ErrorEstimate>) -> String {
    let Some(ErrorEstimate { relative_rmse, low, high, confidence, certain }) = error else {
        return "not known".into();
    };
    let percent = |error: f64| format!("{:.2} %", 100.0 * error);
    format!(
        "{} relative RMSE ({:.0} % confidence: {} to {}){}",
        percent(*relative_rmse),
        100.0 * confidence,
        percent(*low),
        percent(*high),
        if *certain { "" } else { "; not certain: few bright samples decide" }
    )
}

/// The command line as it was typed.
pub(super) fn command() -> String {
    std::env::args().collect::<Vec<_>>().join(" ")
}

fn host() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default().trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::compare;
    use super::super::samples::{measure, stipple, zoneplate};
    use super::*;
    use schemars::generate::SchemaSettings;

    use crate::study::bench;

    /// `GLINT_WRITE_SCHEMA=1` writes the file before it is compared.
    fn schema_is_that_of<T: schemars::JsonSchema>(command: &str) {
        let settings = SchemaSettings::draft2020_12().for_serialize();
        let settings = settings.with(|settings| settings.inline_subschemas = true);
        let schema = settings.into_generator().into_root_schema_for::<T>();
        let path = format!("{}/tests/schemas/{command}.json", env!("CARGO_MANIFEST_DIR"));
        if std::env::var_os("GLINT_WRITE_SCHEMA").is_some() {
            let text = serde_json::to_string_pretty(&schema).unwrap() + "\n";
            std::fs::write(&path, text).unwrap();
        }
        let written = std::fs::read_to_string(&path).unwrap_or_default();
        let written: serde_json::Value = serde_json::from_str(&written).unwrap_or_default();
        let advice = "type: GLINT_WRITE_SCHEMA=1 cargo test --lib the_schema";
        assert!(written == schema.to_value(), "{path} is out of date; {advice}");
    }

    #[test]
    fn the_schemas_in_the_repository_are_those_of_the_types() {
        schema_is_that_of::<Statistics>("render");
        schema_is_that_of::<plan::PlanReport>("plan");
        schema_is_that_of::<bench::Report>("bench");
        schema_is_that_of::<compare::Report>("compare");
        schema_is_that_of::<measure::Report>("samples-measure");
        schema_is_that_of::<zoneplate::Report>("samples-zoneplate");
        schema_is_that_of::<stipple::Summary<'_>>("samples-stipple");
    }
}
