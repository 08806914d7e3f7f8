//! What a render says: warnings, choices, the closing summary and metadata.
//!
//! Prose goes to stderr, JSON to stdout. The header of an image carries reproducible facts only; what a
//! machine did goes to the statistics.

use super::args::Render;
use super::prepare::Prepared;
use super::render::Job;
use super::select::Settings;
use super::statistics::{Statistics, command, error_in_words, image_error};
use super::{ledger_table, options, plan_table};
use crate::error::{Error, Result, Warning};
use crate::film::Region;
use crate::geometry::PrimitiveId;
use crate::image::{Attribute, write_whole};
use crate::math::DVec3;
use crate::os::Isa;
use crate::render::{Bill, ClassRow, Forecast, Rendered};
use crate::sampling::{Sampler, Strategy};
use crate::scene::{self, Effect};
use crate::study::report::render_page;
use crate::trace::PixelSample;
use crate::world::World;
use serde::Serialize;
use std::borrow::Borrow;
use std::io::Write;
use std::path::Path;

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

/// Says which backend was taken, and why.
pub(super) fn backend(args: &Render, name: &str) {
    let widest = Isa::detect().name();
    say(
        args,
        &format!(
            "rays are traced by {name}, the faster one on this machine ({widest}; --accel auto)"
        ),
    );
}

/// Which effects are simulated, and why.
pub(super) fn plan(args: &Render, prepared: &Prepared, forecast: Option<&Forecast>) {
    say_all(args, &plan_table::head(prepared, forecast));
}

/// Lines to stderr.
pub(super) fn say_all(args: &Render, lines: &[String]) {
    lines.iter().for_each(|line| say(args, line));
}

/// JSON to stdout.
pub(super) fn json(value: &impl Serialize) -> Result<()> {
    let json = serde_json::to_string_pretty(value)
        .map_err(|e| Error::Usage(format!("what was found cannot be written: {e}")))?;
    print(&json)
}

/// What was asked for, to stdout; whoever stops reading has read enough.
///
/// # Errors
/// [`Error::Io`] where it cannot be written.
pub(super) fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::io(Path::new("standard output"), "write", error))
        }
        _ => Ok(()),
    }
}

/// What `--sampler grid` does to an image.
const GRID_BIAS: &str =
    "the grid is not randomised: the image is biased, and its noise says nothing of its error";

/// The strategy; and the size of its sets, after which it begins anew, where it cannot go on for ever.
fn sampler(settings: &Settings) -> String {
    let name = settings.sampler.name();
    match Sampler::set_size(settings.sampler, settings.samples_per_pixel) {
        Some(size) => format!("{name} (sets of {size})"),
        None => name.to_owned(),
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
            "{} triangles, {} emissive; {width}x{height}, {} spp, sampler {}, effects {}, {depth}, seed {}",
            world.geometry.placed_triangles(),
            world.lights.emitter_count(),
            settings.samples_per_pixel,
            sampler(settings),
            settings.effects,
            settings.seed
        ),
    );
    if settings.sampler == Strategy::Grid {
        say(args, &format!("warning: {GRID_BIAS}"));
    }
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

/// The closing summary, the statistics file and the JSON.
pub(super) fn finished(
    job: &Job<'_>,
    statistics: &Statistics,
    rendered: &Rendered,
    files: &[String],
    exposure: f32,
) -> Result<()> {
    let args = job.args;
    if rendered.interrupted {
        let (low, high) = rendered.film.samples();
        say(args, &format!("interrupted: {low} to {high} samples a pixel"));
    }
    say_all(args, &ledger_table::lines(&statistics.ledger));
    say_all(args, &statistics.summary());
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
    if let Some(path) = &args.report {
        let title = args.scene.display().to_string();
        let mut facts = vec![command()];
        facts.extend(statistics.summary());
        let page = render_page(&title, &facts, &job.prepared.plan, &statistics.ledger);
        write_whole(path, |file| file.write_all(page.as_bytes()))?;
    }
    if args.json {
        print(&json)?;
    }
    Ok(())
}

fn listed<S: Borrow<str>>(words: &[S]) -> String {
    if words.is_empty() { "nothing".into() } else { words.join(", ") }
}

/// What of the scene a picture does not show, because a user took it out.
fn lacks(settings: &Settings) -> Vec<String> {
    let mut lacks: Vec<String> = settings.effects.left_out().map(|e| e.name().into()).collect();
    if settings.hide_background && settings.effects.allowed.has(Effect::Environment) {
        lacks.push("environment behind the scene".into());
    }
    if settings.max_depth < u32::MAX {
        lacks.push(format!("light after {} segments", settings.max_depth));
    }
    lacks
}

/// Reproducible facts for the image's header.
pub(super) fn metadata(
    job: &Job<'_>,
    rendered: &Rendered,
    bill: &Bill,
) -> Vec<(&'static str, Attribute)> {
    let Prepared { settings, world, plan, description, up, fingerprint, .. } = job.prepared;
    let text = |value: String| Attribute::Text(value);
    let share = |row: &ClassRow| {
        let noise = |share| format!(", {:.2} % variance", 100.0 * share);
        let noise = row.variance_share.map_or(String::new(), noise);
        format!("{}: {:.2} % energy{noise}", row.class, 100.0 * row.energy_share)
    };
    let shares: Vec<String> = bill.classes.iter().map(share).collect();
    let simulated: Vec<&str> =
        plan.rows.iter().filter(|row| row.on).map(|row| row.effect).collect();
    let lacks = lacks(settings);
    let (low, high) = rendered.film.samples();
    let [width, height] = settings.size;
    let Region { start, end } = settings.region;
    let origin = world.origin;
    vec![
        ("glint.version", text(env!("CARGO_PKG_VERSION").into())),
        ("glint.command", text(command())),
        ("glint.fingerprint", text(fingerprint.clone())),
        ("glint.size", text(format!("{width}x{height}"))),
        ("glint.region", text(format!("{},{},{},{}", start[0], start[1], end[0], end[1]))),
        (
            "glint.samples",
            text(if low == high { low.to_string() } else { format!("{low}..{high}") }),
        ),
        ("glint.seed", text(settings.seed.to_string())),
        ("glint.sampler", text(sampler(settings))),
        (
            "glint.bias",
            text(if settings.sampler == Strategy::Grid { GRID_BIAS } else { "none" }.into()),
        ),
        ("glint.effects", text(settings.effects.to_string())),
        ("glint.simulated", text(listed(&simulated))),
        ("glint.lacks", text(listed(&lacks))),
        ("glint.error", text(error_in_words(image_error(settings, rendered).as_ref()))),
        ("glint.shares", text(shares.join("; "))),
        ("glint.settings", text(options::of(settings, description, *up))),
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
