//! `glint render`: a scene file in, a picture out. The newcomer's page: the whole pipeline in order.

use super::args::{Backend, Render};
use super::output::{Outputs, Picture};
use super::select::{self, Settings};
use super::statistics::{Phases, Statistics};
use super::{DONE, NOT_MET, instructions};
use super::{progress, report};
use crate::accel::Accelerator;
#[cfg(feature = "bvh")]
use crate::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use crate::accel::embree::EmbreeAccelerator;
use crate::camera::Camera;
use crate::error::{Error, Result};
use crate::film::Region;
use crate::filter::FilterSampler;
use crate::load;
use crate::os::Isa;
use crate::plan::Plan;
use crate::render::{RenderJob, Rendered, render, render_layers};
use crate::trace::{Tracer, Wavefront};
use crate::world::World;
use signal_hook::consts::TERM_SIGNALS;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Renders as told; the exit code.
pub(super) fn run(args: &Render) -> Result<u8> {
    let mut phases = Phases::default();
    select::check(args)?;
    instructions(args.isa)?.limit();
    let chosen = backend(args.accel)?;
    let stop = stop_flag()?;
    // Loading, the sky and the PNG use the global pool; a second call in one process may fail, harmlessly.
    let _ = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build_global();

    // Files to a scene; what the command line says goes over what the file says.
    let start = Instant::now();
    let busy = progress::busy(args, "loading");
    let outputs = Outputs::check(args)?;
    let reading = |done, total| progress::reading(&busy, done, total);
    let (mut scene, settings) = select::scene(args, Some(&reading))?;
    phases.load = start.elapsed().as_secs_f64();

    // A scene to a world, and the camera in it.
    let start = Instant::now();
    busy.set_message("building");
    let (cameras, up) = (std::mem::take(&mut scene.cameras), scene.up);
    let (inputs, environment) = (std::mem::take(&mut scene.inputs), scene.environment);
    let whole = World::compile(scene)?;
    busy.suspend(|| report::warnings(args, &whole.warnings));
    let (camera, description) = select::camera(args, &cameras, up, &whole, settings.size)?;

    // The effects that it calls for, and what runs for them.
    let (world, plan) = settings.plan(&whole, &description, args.background.is_some())?;
    let overrides = (args.background, &args.override_material, environment, up);
    let fingerprint =
        load::fingerprint(&inputs, &format!("{settings:?} {description:?} {overrides:?}"))?;
    busy.suspend(|| report::choices(args, &settings, &description, &world, up));
    busy.suspend(|| report::plan(args, &plan));
    if args.accel == Backend::Auto {
        busy.suspend(|| report::backend(args, chosen.name()));
    }

    // A world to an accelerator: the only place where a backend is chosen.
    let geometry = world.geometry.clone();
    let options = args.build.options(args.threads);
    let mut job = Job {
        args,
        settings: &settings,
        plan: &plan,
        outputs: &outputs,
        stop: &stop,
        name: ("", String::new()),
        fingerprint,
    };
    let built = |phases: &mut Phases| {
        phases.build = start.elapsed().as_secs_f64();
        busy.finish_and_clear();
    };
    match chosen {
        #[cfg(feature = "embree")]
        Chosen::Embree => {
            let embree = EmbreeAccelerator::with_options(geometry, &options, Isa::detect())?;
            built(&mut phases);
            job.name = ("embree", embree.version());
            finish(&job, &world, &embree, &camera, phases)
        }
        #[cfg(feature = "bvh")]
        Chosen::Bvh => {
            let bvh = Bvh::with_options(geometry, &options)?;
            built(&mut phases);
            job.name = ("bvh", env!("CARGO_PKG_VERSION").to_owned());
            finish(&job, &world, &bvh, &camera, phases)
        }
    }
}

/// Backends that this build has.
enum Chosen {
    #[cfg(feature = "embree")]
    Embree,
    #[cfg(feature = "bvh")]
    Bvh,
}

impl Chosen {
    fn name(&self) -> &'static str {
        match self {
            #[cfg(feature = "embree")]
            Self::Embree => "embree",
            #[cfg(feature = "bvh")]
            Self::Bvh => "bvh",
        }
    }
}

fn backend(wanted: Backend) -> Result<Chosen> {
    match wanted {
        // README's table: with wide vectors the in-house BVH is ahead on every kind of scene. `--isa` has no say, so
        // that it changes no picture.
        #[cfg(feature = "bvh")]
        Backend::Auto if cfg!(not(feature = "embree")) || Isa::detect() == Isa::Avx512 => {
            Ok(Chosen::Bvh)
        }
        #[cfg(feature = "embree")]
        Backend::Embree | Backend::Auto => Ok(Chosen::Embree),
        #[cfg(not(feature = "embree"))]
        Backend::Embree => Err(Error::Usage("--accel embree: built without Embree".into())),
        #[cfg(not(feature = "embree"))]
        Backend::Auto => Ok(Chosen::Bvh),
        #[cfg(feature = "bvh")]
        Backend::Bvh => Ok(Chosen::Bvh),
        #[cfg(not(feature = "bvh"))]
        Backend::Bvh => Err(Error::Usage("--accel bvh: built without the in-house BVH".into())),
    }
}

/// What does not depend on the backend's type.
pub(super) struct Job<'a> {
    pub(super) args: &'a Render,
    pub(super) settings: &'a Settings,
    pub(super) plan: &'a Plan,
    pub(super) outputs: &'a Outputs,
    pub(super) stop: &'a Arc<AtomicBool>,
    pub(super) name: (&'static str, String),
    pub(super) fingerprint: String,
}

/// A world and an accelerator to files and a summary.
fn finish<A: Accelerator>(
    job: &Job<'_>,
    world: &World,
    accelerator: &A,
    camera: &Camera,
    mut phases: Phases,
) -> Result<u8> {
    let settings = job.settings;
    let filter = FilterSampler::new(settings.filter);
    let tracer = settings.tracer(world, job.plan, camera, &filter).on(accelerator);
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
    let bar = progress::bar(
        job.args,
        (region.pixels() as u64).saturating_mul(settings.samples_per_pixel),
    );
    let rendered = render(&tracer, &render_job, &|paths| bar.inc(paths))?;
    bar.finish_and_clear();
    phases.render = rendered.seconds;
    let layers = if settings.aovs.is_empty() || !job.outputs.has_exr() {
        None
    } else {
        Some(render_layers(&tracer, region, settings.samples_per_pixel, threads)?)
    };

    // The film to files.
    let start = Instant::now();
    let pixels = rendered.film.develop();
    let (files, exposure) = job.outputs.write(&Picture {
        settings,
        pixels: &pixels,
        samples: rendered.film.samples().0 as f32,
        layers: layers.as_ref(),
        background: job.args.background,
        metadata: report::metadata(job, &rendered, world),
    })?;
    phases.write = start.elapsed().as_secs_f64();

    let statistics = Statistics::new(job, world, accelerator.build_stats(), &rendered, phases);
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
