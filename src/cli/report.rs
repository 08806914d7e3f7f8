//! What a render says: warnings, choices, progress, the closing summary, statistics and metadata.
//!
//! Progress and prose go to stderr, JSON to stdout. The header of an image carries reproducible facts
//! only; what a machine did goes to the statistics.

use super::args::Render;
use super::render::Job;
use super::select::Settings;
use crate::accel::BuildStats;
use crate::error::{Error, Result, Warning};
use crate::film::{Film, Region};
use crate::geometry::PrimitiveId;
use crate::image::{Attribute, write_whole};
use crate::ledger::{Ledger, Stage};
use crate::math::DVec3;
use crate::os::peak_rss_bytes;
use crate::render::Rendered;
use crate::scene;
use crate::trace::PixelSample;
use crate::world::World;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::io::Write;
use std::time::Duration;

/// Wall-clock seconds of each phase.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Phases {
    pub(super) load: f64,
    pub(super) build: f64,
    pub(super) render: f64,
    pub(super) write: f64,
    pub(super) total: f64,
}

/// What a machine did: the JSON of `--stats` and `--json`.
#[derive(Debug, Serialize)]
pub(super) struct Statistics {
    version: &'static str,
    command: String,
    host: String,
    backend: BackendName,
    triangles: usize,
    threads: usize,
    seconds: Phases,
    memory_bytes: Memory,
    samples_per_pixel: u64,
    paths: u64,
    rays: Rays,
    rays_per_second: f64,
    ledger: StageTable,
    non_finite: u64,
    fingerprint: String,
}

#[derive(Debug, Serialize)]
struct BackendName {
    name: &'static str,
    version: String,
}

#[derive(Debug, Serialize)]
struct Memory {
    geometry: usize,
    acceleration: usize,
    textures: usize,
    film: usize,
    peak_rss: u64,
}

#[derive(Debug, Serialize)]
struct Rays {
    camera: u64,
    bounce: u64,
    shadow: u64,
    total: u64,
}

#[derive(Debug, Serialize)]
struct StageTable {
    stages: Vec<StageRow>,
}

#[derive(Debug, Serialize)]
struct StageRow {
    stage: &'static str,
    seconds: f64,
    calls: u64,
    rays: u64,
    mean_batch: f64,
}

impl Statistics {
    pub(super) fn new(
        job: &Job<'_>,
        world: &World,
        build: BuildStats,
        rendered: &Rendered,
        mut seconds: Phases,
    ) -> Self {
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
                film: rendered.film.region().pixels() * Film::BYTES_PER_PIXEL,
                peak_rss: peak_rss_bytes(),
            },
            samples_per_pixel: rendered.film.samples().0,
            paths: ledger.camera_rays,
            rays: Rays {
                camera: ledger.camera_rays,
                bounce: ledger.bounce_rays,
                shadow: ledger.shadow_rays,
                total: ledger.rays(),
            },
            rays_per_second: ledger.rays() as f64 / rendered.seconds.max(1e-9),
            ledger: StageTable { stages: stage_rows(ledger) },
            non_finite: rendered.non_finite.count,
            fingerprint: job.fingerprint.clone(),
        }
    }
}

fn stage_rows(ledger: &Ledger) -> Vec<StageRow> {
    let row = |stage: Stage| {
        let totals = ledger.stage(stage);
        StageRow {
            stage: stage.name(),
            seconds: totals.seconds,
            calls: totals.calls,
            rays: totals.items,
            mean_batch: totals.items as f64 / totals.calls.max(1) as f64,
        }
    };
    Stage::ALL.into_iter().map(row).collect()
}

fn command() -> String {
    std::env::args().collect::<Vec<_>>().join(" ")
}

fn host() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default().trim().to_owned()
}

/// Writes a line to stderr; a closed stderr is nobody's error.
fn say(args: &Render, line: &str) {
    if !args.quiet {
        let _ = writeln!(std::io::stderr(), "{line}");
    }
}

/// An error, on stderr whatever was asked for.
pub(super) fn error(error: &Error) {
    let _ = writeln!(std::io::stderr(), "error: {error}");
}

/// Everything that was dropped or repaired.
pub(super) fn warnings(args: &Render, warnings: &[Warning]) {
    for warning in warnings {
        say(args, &format!("warning: {warning}"));
    }
}

/// What will be rendered, defaults included.
pub(super) fn choices(
    args: &Render,
    settings: &Settings,
    camera: &scene::Camera,
    world: &World,
    up: DVec3,
) {
    let [width, height] = settings.size;
    let depth = match settings.max_depth {
        u32::MAX => "unbounded depth".to_owned(),
        n => format!("depth {n}"),
    };
    let point = |p: DVec3| format!("{:.6},{:.6},{:.6}", p.x, p.y, p.z);
    say(
        args,
        &format!(
            "{} triangles, {} emissive; {width}x{height}, {} spp, {depth}, seed {}",
            world.geometry.placed_triangles(),
            world.lights.emitter_count(),
            settings.samples_per_pixel,
            settings.seed
        ),
    );
    say(
        args,
        &format!(
            "camera {}: --camera-from {} --camera-to {} --camera-up {}",
            camera.name,
            point(camera.from),
            point(camera.to),
            point(camera.up)
        ),
    );
    if args.up.is_none() && camera.name == "automatic" && up == DVec3::Y {
        // What a model stands on is flat: a larger base along z than along y says that z is up.
        let base = |axis| world.geometry.resting_area(&world.bounds, axis);
        if base(2) > 3.0 * base(1) && base(2) > 1e-3 * world.bounds.extent().length_squared() {
            say(args, "hint: the model seems to stand along z; if it lies on its back, try --up z");
        }
    }
}

/// Something that moves on a terminal while there is no telling how long it will take.
pub(super) fn busy(args: &Render, what: &'static str) -> ProgressBar {
    if args.quiet {
        return ProgressBar::hidden();
    }
    let spinner = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(5));
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed_precise}") {
        spinner.set_style(style);
    }
    spinner.set_message(what);
    spinner.enable_steady_tick(Duration::from_millis(200));
    spinner
}

/// A bar with an ETA on stderr when that is a terminal; otherwise nothing.
pub(super) fn progress(args: &Render, paths: u64) -> ProgressBar {
    if args.quiet {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::with_draw_target(Some(paths), ProgressDrawTarget::stderr_with_hz(5));
    let template = "{bar:40} {percent:>3} %  {elapsed_precise} elapsed, {eta_precise} to go";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// The closing summary, the statistics file and the JSON.
pub(super) fn finished(
    job: &Job<'_>,
    statistics: &Statistics,
    rendered: &Rendered,
    files: &[String],
    exposure: f32,
) -> Result<()> {
    let args = job.args;
    let s = &statistics.seconds;
    if rendered.interrupted {
        let (low, high) = rendered.film.samples();
        say(args, &format!("interrupted: {low} to {high} samples a pixel"));
    }
    let megabytes = |bytes: u64| bytes as f64 / 1e6;
    say(
        args,
        &format!(
            "load {:.2} s, build {:.2} s, render {:.2} s, write {:.2} s",
            s.load, s.build, s.render, s.write
        ),
    );
    say(
        args,
        &format!(
            "{:.2} M rays/s, {} paths, {} rays; {} {}, {} threads; {:.0} MB ({:.0} geometry, {:.0} \
             acceleration, {:.0} textures, {:.0} film)",
            statistics.rays_per_second / 1e6,
            statistics.paths,
            statistics.rays.total,
            statistics.backend.name,
            statistics.backend.version,
            statistics.threads,
            megabytes(statistics.memory_bytes.peak_rss),
            megabytes(statistics.memory_bytes.geometry as u64),
            megabytes(statistics.memory_bytes.acceleration as u64),
            megabytes(statistics.memory_bytes.textures as u64),
            megabytes(statistics.memory_bytes.film as u64),
        ),
    );
    for example in &rendered.non_finite.examples {
        let [x, y] = example.pixel;
        say(
            args,
            &format!(
                "not finite: pixel {x},{y} sample {} after {} bounces on {} (line {}): --replay {x},{y},{}",
                example.sample,
                example.bounces,
                example.material.as_deref().unwrap_or("nothing"),
                example.line.map_or("?".into(), |l| l.to_string()),
                example.sample
            ),
        );
    }
    if rendered.non_finite.count > 0 {
        let count = rendered.non_finite.count;
        say(args, &format!("warning: {count} samples were not finite and are not in the image"));
    }
    if files.iter().any(|f| f.ends_with("png")) {
        say(args, &format!("PNG exposure {exposure:+.2} EV"));
    }
    say(args, &format!("wrote {}", files.join(", ")));

    let json = serde_json::to_string_pretty(statistics)
        .map_err(|e| Error::Usage(format!("statistics cannot be written: {e}")))?;
    if let Some(path) = &args.stats {
        write_whole(path, |file| file.write_all(json.as_bytes()))?;
    }
    if args.json {
        let _ = writeln!(std::io::stdout(), "{json}");
    }
    Ok(())
}

/// Reproducible facts for the image's header.
pub(super) fn metadata(
    job: &Job<'_>,
    rendered: &Rendered,
    world: &World,
) -> Vec<(&'static str, Attribute)> {
    let settings = job.settings;
    let text = |value: String| Attribute::Text(value);
    let (low, high) = rendered.film.samples();
    let [width, height] = settings.size;
    let Region { start, end } = settings.region;
    let origin = world.origin;
    vec![
        ("glint.version", text(env!("CARGO_PKG_VERSION").into())),
        ("glint.command", text(command())),
        ("glint.fingerprint", text(job.fingerprint.clone())),
        ("glint.size", text(format!("{width}x{height}"))),
        ("glint.region", text(format!("{},{},{},{}", start[0], start[1], end[0], end[1]))),
        (
            "glint.samples",
            text(if low == high { low.to_string() } else { format!("{low}..{high}") }),
        ),
        ("glint.seed", text(settings.seed.to_string())),
        ("glint.settings", text(format!("{settings:?}"))),
        ("glint.origin", text(format!("{},{},{}", origin.x, origin.y, origin.z))),
        ("glint.backend", text(format!("{} {}", job.name.0, job.name.1))),
    ]
}

/// What a replayed sample met.
pub(super) fn replayed(job: &Job<'_>, world: &World, found: &[PixelSample]) {
    for sample in found {
        let met = (sample.last_hit != PrimitiveId::MISS).then(|| {
            let id = sample.last_hit;
            let name = &world.material(world.material_id(id)).name;
            let line = world.source_line(id).map_or("?".into(), |l| l.to_string());
            format!("triangle {} ({name}, line {line})", id.primitive)
        });
        let c = sample.radiance;
        let _ = writeln!(
            std::io::stdout(),
            "pixel {},{} sample {}: radiance {} {} {} after {} bounces, last met {} ({})",
            sample.pixel[0],
            sample.pixel[1],
            sample.sample,
            c.r,
            c.g,
            c.b,
            sample.bounces,
            met.unwrap_or_else(|| "nothing".into()),
            job.name.0
        );
    }
}
