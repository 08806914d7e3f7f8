//! The render loop: tiles and passes over all threads until every sample is taken.
//!
//! Work is a list of (pass, tile) blocks that workers take in order. The film adds exactly, so neither
//! the number of threads nor the order of blocks changes a byte. The first pass is one sample a pixel
//! over the whole image; later ones double. Prints nothing: progress is a callback.

mod bill;
mod forecast;
mod layers;
mod non_finite;

pub use bill::{Bill, ClassRow, CutOutsRow, StageRow};
pub use forecast::{FORECAST_SIZE, Forecast, forecast};
pub use layers::{Aov, Layers, render_layers};
pub use non_finite::{NonFinite, NonFiniteSample};

use crate::accel::{Accelerator, AcceptAll, HitFilter};
use crate::error::{Error, Result};
use crate::film::{ClassFilm, ClassSample, Film, Region};
use crate::ledger::{Class, Clock, Ledger, Stage, Watch};
use crate::trace::{Block, ClassRadiance, PixelSample, Tracer, Wavefront};
use crate::world::CutOuts;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
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
    /// Sums by transport class, of the watched pixels.
    pub classes: ClassFilm,
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
    // Scenes without cut-outs carry no filter at all.
    if tracer.plan.pipeline.hit_filter {
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
    let block =
        Block { start, end, first_sample: sample, end_sample: sample + 1, watch: Watch::NONE };
    let mut found = Vec::new();
    let mut wavefront = Wavefront::new(region.pixels());
    if tracer.plan.pipeline.hit_filter {
        let filter = CutOuts::new(tracer.world);
        wavefront.run(tracer, &filter, &block, |s, _| found.push(*s));
    } else {
        wavefront.run(tracer, &AcceptAll, &block, |s, _| found.push(*s));
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

fn run<A: Accelerator, F: HitFilter + Clone>(
    tracer: &Tracer<'_, A>,
    filter: &F,
    job: &RenderJob<'_>,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<Rendered> {
    let start = Instant::now();
    let blocks = Blocks::new(job);
    let next = AtomicU64::new(0);
    let total = Mutex::new(Total {
        film: Film::new(job.region),
        classes: ClassFilm::new(blocks.watch, job.region.height()),
        ledger: Ledger::default(),
        non_finite: NonFinite::default(),
    });
    let stopped = || job.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));

    thread_pool(job.threads)?.broadcast(|_| {
        let begin = Instant::now();
        let filter = filter.clone();
        let mut wavefront = Wavefront::new(job.batch);
        let mut watched: Vec<ClassSample> = Vec::new();
        let mut non_finite = NonFinite::default();
        let mut film = Film::new(Region { start: [0; 2], end: [0; 2] });
        while !stopped() {
            let Some(block) = blocks.get(next.fetch_add(1, Ordering::Relaxed)) else { break };
            film.restart(Region { start: block.start, end: block.end });
            wavefront.run(tracer, &filter, &block, |sample, parts| {
                if !sample.radiance.is_finite() {
                    non_finite.record(sample, tracer.world);
                    return;
                }
                film.add(sample.pixel, sample.sample, sample.radiance, sample.coverage);
                if let Some((cell, parts)) = parts {
                    watch(cell, sample.sample, parts, &mut watched);
                }
            });
            let mut clock = Clock::start();
            if let Ok(mut total) = total.lock() {
                total.film.merge(&film);
                total.classes.add(&watched);
            }
            watched.clear();
            clock.charge(&mut wavefront.ledger, Stage::Accumulate);
            progress(block.paths());
        }
        wavefront.ledger.cut_outs = filter.cost();
        wavefront.ledger.worker_seconds += begin.elapsed().as_secs_f64();
        if let Ok(mut total) = total.lock() {
            total.ledger.add(&wavefront.ledger);
            total.non_finite.add(&non_finite);
        }
    });

    let Total { film, classes, ledger, non_finite } = match total.into_inner() {
        Ok(total) => total,
        Err(poisoned) => poisoned.into_inner(),
    };
    let seconds = start.elapsed().as_secs_f64();
    let interrupted = blocks.get(next.into_inner()).is_some();
    Ok(Rendered { film, classes, ledger, seconds, non_finite, interrupted })
}

/// Files the light of a watched sample by its class.
fn watch(cell: u32, sample: u64, parts: &ClassRadiance, watched: &mut Vec<ClassSample>) {
    for (&class, &radiance) in Class::ALL.iter().zip(parts) {
        if !radiance.is_black() {
            watched.push(ClassSample { cell, sample, class, radiance });
        }
    }
}

/// What workers add up.
struct Total {
    film: Film,
    classes: ClassFilm,
    ledger: Ledger,
    non_finite: NonFinite,
}

/// The blocks of a job in the order in which they are taken: every tile of a pass, then the next pass.
/// Computed, not stored: a job may have any number of samples.
struct Blocks {
    tiles: Vec<Region>,
    samples_per_pixel: u64,
    watch: Watch,
}

impl Blocks {
    /// Samples of the largest pass.
    const LARGEST_PASS: u64 = 32;
    /// Number of the first pass of that size: the passes before it are 1, 1, 2, 4, 8 and 16 samples, so
    /// that there is a whole picture at once, and then ever better ones.
    const FIRST_LARGE: u64 = 6;

    fn new(job: &RenderJob<'_>) -> Self {
        let Region { start, end } = job.region;
        Self {
            tiles: job.region.tiles(TILE),
            samples_per_pixel: job.samples_per_pixel,
            watch: Watch::new(start, end, ClassFilm::PIXELS),
        }
    }

    /// First sample of a pass.
    fn first_sample(pass: u64) -> u64 {
        match pass {
            0 => 0,
            1..Self::FIRST_LARGE => 1 << (pass - 1),
            _ => (pass - Self::FIRST_LARGE + 1).saturating_mul(Self::LARGEST_PASS),
        }
    }

    /// Block number `n`, while there are samples left.
    fn get(&self, n: u64) -> Option<Block> {
        let tiles = self.tiles.len() as u64;
        let tile = self.tiles.get((n % tiles) as usize)?;
        let pass = n / tiles;
        let first_sample = Self::first_sample(pass);
        let end_sample = Self::first_sample(pass + 1).min(self.samples_per_pixel);
        let (start, end, watch) = (tile.start, tile.end, self.watch);
        let block = Block { start, end, first_sample, end_sample, watch };
        (first_sample < end_sample).then_some(block)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_take_every_sample_of_every_pixel_once() {
        let region = Region { start: [3, 5], end: [70, 41] };
        for samples_per_pixel in [1, 2, 5, 31, 32, 33, 200] {
            let watch = Watch::NONE;
            let blocks = Blocks { tiles: region.tiles(TILE), samples_per_pixel, watch };
            let mut taken = vec![0; region.pixels()];
            let mut last_sample = 0;
            for block in (0..).map_while(|n| blocks.get(n)) {
                assert!(block.first_sample >= last_sample, "passes are in order");
                last_sample = block.first_sample;
                for (pixel, _) in block.iter() {
                    taken[region.index(pixel)] += 1;
                }
            }
            assert!(taken.iter().all(|&n| n == samples_per_pixel), "{samples_per_pixel}");
        }
    }
}
