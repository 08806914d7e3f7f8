//! `glint render`: a scene file in, a picture out. The newcomer's page: the whole pipeline in order.

use super::args::{Backend, Render};
use super::backend::Task;
use super::output::Picture;
use super::prepare::Prepared;
use super::statistics::{Phases, Statistics};
use super::{DONE, NOT_MET, plan, progress, report};
use crate::accel::Accelerator;
use crate::error::{Error, Result};
use crate::film::Region;
use crate::filter::FilterSampler;
use crate::render::{Bill, RenderJob, Rendered, render, render_layers};
use crate::trace::{Tracer, Wavefront};
use crate::world::World;
use signal_hook::consts::TERM_SIGNALS;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// A render of fewer paths has no forecast: that would take a noticeable part of its own time.
const FORECAST_FROM: u64 = 4_000_000;

/// Renders as told; the exit code.
pub(super) fn run(args: &Render) -> Result<u8> {
    let stop = stop_flag()?;
    let prepared = Prepared::new(args)?;
    let geometry = prepared.world.geometry.clone();
    let options = args.build.options(args.threads);
    let task = Picturing { args, prepared: &prepared, stop: &stop };
    prepared.chosen.build(geometry, &options, task)
}

/// Everything after the accelerator is built.
struct Picturing<'a> {
    args: &'a Render,
    prepared: &'a Prepared,
    stop: &'a Arc<AtomicBool>,
}

impl Task for Picturing<'_> {
    fn run<A: Accelerator>(
        self,
        name: &'static str,
        version: String,
        accelerator: &A,
    ) -> Result<u8> {
        let Self { args, prepared, stop } = self;
        let phases = Phases {
            load: prepared.load_seconds,
            build: prepared.build_start.elapsed().as_secs_f64(),
            ..Phases::default()
        };
        if args.replay.is_none() {
            let is_large = prepared.paths() >= FORECAST_FROM;
            let forecast =
                is_large.then(|| plan::predict(args, prepared, accelerator)).transpose()?;
            prepared.busy.suspend(|| report::plan(args, prepared, forecast.as_ref()));
        }
        prepared.busy.finish_and_clear();
        if args.accel == Backend::Auto {
            report::backend(args, name);
        }
        finish(&Job { args, prepared, stop, name: (name, version) }, accelerator, phases)
    }
}

/// What does not depend on the backend's type.
pub(super) struct Job<'a> {
    pub(super) args: &'a Render,
    pub(super) prepared: &'a Prepared,
    pub(super) stop: &'a Arc<AtomicBool>,
    pub(super) name: (&'static str, String),
}

/// A world and an accelerator to files and a summary.
fn finish<A: Accelerator>(job: &Job<'_>, accelerator: &A, mut phases: Phases) -> Result<u8> {
    let Prepared { settings, outputs, world, plan, camera, .. } = job.prepared;
    let filter = FilterSampler::new(settings.filter);
    let tracer = settings.tracer(world, plan, camera, &filter).on(accelerator);
    if let Some((pixel, sample)) = job.args.replay {
        return replay(job, &tracer, pixel, sample);
    }

    // Paths to the film.
    let (region, threads) = (settings.region, job.args.threads);
    let render_job = RenderJob {
        region,
        samples_per_pixel: settings.samples_per_pixel,
        threads,
        batch: Wavefront::DEFAULT_BATCH,
        stop: Some(job.stop),
    };
    job.stop.store(false, Ordering::Relaxed);
    let bar = progress::bar(job.args, job.prepared.paths());
    let rendered = render(&tracer, &render_job, &|paths| bar.inc(paths))?;
    bar.finish_and_clear();
    phases.render = rendered.seconds;
    let layers = if settings.aovs.is_empty() || !outputs.has_exr() {
        None
    } else {
        Some(render_layers(&tracer, region, settings.samples_per_pixel, threads)?)
    };

    // The film to files.
    let start = Instant::now();
    let bill = Bill::new(&rendered);
    let pixels = rendered.film.develop();
    let (files, exposure) = outputs.write(&Picture {
        settings,
        pixels: &pixels,
        samples: rendered.film.samples().0 as f32,
        layers: layers.as_ref(),
        background: job.args.background,
        metadata: report::metadata(job, &rendered, &bill),
    })?;
    phases.write = start.elapsed().as_secs_f64();

    let statistics = Statistics::new(job, accelerator.build_stats(), &rendered, bill, phases);
    report::finished(job, &statistics, &rendered, &files, exposure)?;
    Ok(exit_code(job, world, &rendered))
}

/// Done, or done but for something that was asked for.
fn exit_code(job: &Job<'_>, world: &World, rendered: &Rendered) -> u8 {
    let strict = job.args.strict && (!world.warnings.is_empty() || rendered.non_finite.count > 0);
    if rendered.interrupted || strict { NOT_MET } else { DONE }
}

/// Traces one sample again and says what it met.
fn replay<A: Accelerator>(
    job: &Job<'_>,
    tracer: &Tracer<'_, A>,
    pixel: [u32; 2],
    sample: u64,
) -> Result<u8> {
    let region = Region { start: pixel, end: [pixel[0] + 1, pixel[1] + 1] };
    let found = crate::render::replay(tracer, region, sample);
    report::replayed(job, tracer.world, &found);
    Ok(DONE)
}

/// A flag that Ctrl-C sets; where it finds it set already it ends the process with code 130. It is set from the
/// beginning, because until the work starts (and takes it down) there is nothing to write.
pub(super) fn stop_flag() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(true));
    let failed = |e| Error::Usage(format!("cannot handle signals: {e}"));
    for &signal in TERM_SIGNALS {
        // In this order: a signal must not find the flag that it has set itself.
        signal_hook::flag::register_conditional_shutdown(signal, 130, stop.clone())
            .map_err(failed)?;
        signal_hook::flag::register(signal, stop.clone()).map_err(failed)?;
    }
    Ok(stop)
}
