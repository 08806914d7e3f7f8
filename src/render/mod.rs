//! The render loop: tiles and passes over all threads until every sample is taken.
//!
//! Work is a list of (pass, tile) blocks that workers take in order. The film adds exactly, so neither
//! the number of threads nor the order of blocks changes a byte. The first pass is one sample a pixel
//! over the whole image; later ones double. Prints nothing: progress is a callback.

mod layers;
mod non_finite;

pub use layers::{Aov, Layers, render_layers};
pub use non_finite::{NonFinite, NonFiniteSample};

use crate::accel::{Accelerator, AcceptAll, HitFilter};
use crate::error::{Error, Result};
use crate::film::{Film, Region};
use crate::ledger::Ledger;
use crate::trace::{Block, PixelSample, Tracer, Wavefront};
use crate::world::CutOuts;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// What is rendered, and with what means.
#[derive(Clone, Debug)]
pub struct RenderJob<'a> {
    /// Pixels, in image coordinates.
    pub region: Region,
    /// Samples of every pixel.
    pub samples_per_pixel: u64,
    /// Worker threads; 0: one a core.
    pub threads: usize,
    /// Paths in flight a worker.
    pub batch: usize,
    /// Set to stop after the blocks in work.
    pub stop: Option<&'a AtomicBool>,
}

/// A finished (or stopped) render.
#[derive(Debug)]
pub struct Rendered {
    /// The sums.
    pub film: Film,
    /// What the stages cost, over all workers.
    pub ledger: Ledger,
    /// Wall-clock seconds.
    pub seconds: f64,
    /// Samples that were NaN or infinite, kept out of the image.
    pub non_finite: NonFinite,
    /// Whether it was stopped before the last sample.
    pub interrupted: bool,
}

/// Edge of a tile in pixels.
const TILE: u32 = 32;

/// Renders a job. `progress` is told how many paths each finished block had, from any thread.
///
/// # Errors
/// When the thread pool cannot be made.
pub fn render<A: Accelerator>(
    tracer: &Tracer<'_, A>,
    job: &RenderJob<'_>,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Rendered> {
    // The one place where cut-outs are decided: scenes without them carry no filter at all.
    if tracer.world.has_cut_outs() {
        run(tracer, &CutOuts::new(tracer.world), job, progress)
    } else {
        run(tracer, &AcceptAll, job, progress)
    }
}

/// Traces sample number `sample` of every pixel of `region` again: what a render summed there.
pub fn replay<A: Accelerator>(
    tracer: &Tracer<'_, A>,
    region: Region,
    sample: u64,
) -> Vec<PixelSample> {
    let (start, end) = (region.start, region.end);
    let block = Block { start, end, first_sample: sample, end_sample: sample + 1 };
    let mut found = Vec::new();
    let mut wavefront = Wavefront::new(region.pixels());
    if tracer.world.has_cut_outs() {
        let filter = CutOuts::new(tracer.world);
        wavefront.run(tracer, &filter, &block, |s| found.push(*s));
    } else {
        wavefront.run(tracer, &AcceptAll, &block, |s| found.push(*s));
    }
    found
}

/// A pool of `threads` workers (0: one a core).
pub(crate) fn thread_pool(threads: usize) -> Result<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Error::Usage(format!("cannot start {threads} threads: {error}")))
}

fn run<A: Accelerator, F: HitFilter>(
    tracer: &Tracer<'_, A>,
    filter: &F,
    job: &RenderJob<'_>,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Rendered> {
    let start = Instant::now();
    let blocks = blocks(job);
    let next = AtomicUsize::new(0);
    let total = Mutex::new((Film::new(job.region), Ledger::default(), NonFinite::default()));
    let stopped = || job.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));

    thread_pool(job.threads)?.broadcast(|_| {
        let mut wavefront = Wavefront::new(job.batch);
        let mut non_finite = NonFinite::default();
        while !stopped() {
            let Some(block) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
            let mut film = Film::new(Region { start: block.start, end: block.end });
            wavefront.run(tracer, filter, block, |sample| {
                if sample.radiance.is_finite() {
                    film.add(sample.pixel, sample.sample, sample.radiance, sample.coverage);
                } else {
                    non_finite.record(sample, tracer.world);
                }
            });
            if let Ok(mut total) = total.lock() {
                total.0.merge(&film);
            }
            progress(block.paths());
        }
        if let Ok(mut total) = total.lock() {
            total.1.add(&wavefront.ledger);
            total.2.add(&non_finite);
        }
    });

    let (film, ledger, non_finite) = match total.into_inner() {
        Ok(total) => total,
        Err(poisoned) => poisoned.into_inner(),
    };
    let interrupted = next.into_inner() < blocks.len();
    Ok(Rendered { film, ledger, seconds: start.elapsed().as_secs_f64(), non_finite, interrupted })
}

/// All blocks in the order in which they are taken: every tile of a pass, then the next pass.
fn blocks(job: &RenderJob<'_>) -> Vec<Block> {
    const LARGEST_PASS: u64 = 32;
    let tiles = job.region.tiles(TILE);
    let mut blocks = Vec::new();
    let mut first_sample = 0;
    while first_sample < job.samples_per_pixel {
        // 1, 1, 2, 4, ... 32, 32, ...: a whole picture at once, then ever better ones.
        let size = first_sample.clamp(1, LARGEST_PASS);
        let end_sample = (first_sample + size).min(job.samples_per_pixel);
        blocks.extend(tiles.iter().map(|t| Block {
            start: t.start,
            end: t.end,
            first_sample,
            end_sample,
        }));
        first_sample = end_sample;
    }
    blocks
}
