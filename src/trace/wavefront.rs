//! The wavefront: many paths advance together, one stage at a time.
//!
//! ```text
//! generate -> [ intersect -> environment -> interact -> emit -> materials -> sample lights -> shadow -> scatter -> roulette ]*
//!          -> accumulate
//! ```
//! Which of them run, the plan says.
//! A stage is a plain loop over the batch, so each is timed with two clock reads and its inner loop stays
//! small. Finished slots are refilled with the block's next samples, so batches stay full to the end.
//! Every path draws its own named numbers and sums its own radiance, so batch size, order and grouping
//! change no bit. Source of the estimator: Veach 1997, chapters 9 and 10 (light and BSDF sampling,
//! combined by the power heuristic).

use super::batch::Batch;
use super::generate_stage::Starts;
use super::group::Groups;
use super::light_stage::LightStage;
use super::numbers::Pairs;
use super::path::Path;
use super::scatter_stage::ScatterStage;
use super::{
    Block, BlockPaths, ClassRadiance, PixelSample, Tracer, Vertex, Watched, survival_probability,
};
use crate::accel::{Accelerator, HitFilter};
use crate::geometry::{Hit, Ray};
use crate::ledger::{Class, Clock, Ledger, Stage};
use crate::math::Rgb;
use crate::os::Isa;
use crate::sampling::{Dimension, Sampler};

/// The arrays of one worker. They are allocated once; the bounce loop allocates nothing.
pub struct Wavefront {
    begun: Starts,
    pub(super) slots: Box<[Path]>,
    /// What watched paths have gathered, by class.
    pub(super) parts: Box<[ClassRadiance]>,
    /// Slots without a path.
    free: Batch<u32>,
    /// Slots whose path goes on.
    pub(super) active: Batch<u32>,
    rays: Batch<Ray>,
    pub(super) hits: Box<[Hit]>,
    /// Places of the rays that met something, and of those that left the scene.
    pub(super) met: Batch<u32>,
    pub(super) missed: Batch<u32>,
    /// Places of those that met a surface which looks something up.
    pub(super) detailed: Batch<u32>,
    pub(super) vertices: Batch<Vertex>,
    pub(super) groups: Groups,
    /// Random numbers of the vertices, for the stage at hand.
    pairs: Pairs,
    shadow_rays: Batch<Ray>,
    /// Slot, what the light adds to it if it is visible, and in which class.
    shadow_gains: Batch<(u32, Class, Rgb)>,
    blocked: Box<[bool]>,
    /// Slots whose path has ended.
    pub(super) finished: Batch<u32>,
    isa: Isa,
    /// What the stages have cost so far.
    pub ledger: Ledger,
}

impl Wavefront {
    /// Paths in flight by default: their state fits a core's second-level cache.
    pub const DEFAULT_BATCH: usize = 1024;

    /// Room for `batch` paths, at least one.
    pub fn new(batch: usize) -> Self {
        let capacity = batch.max(1);
        Self {
            begun: Starts::new(),
            slots: vec![Path::default(); capacity].into(),
            parts: vec![[Rgb::BLACK; Class::COUNT]; capacity].into(),
            free: Batch::new(capacity),
            active: Batch::new(capacity),
            rays: Batch::new(capacity),
            hits: vec![Hit::MISS; capacity].into(),
            met: Batch::new(capacity),
            missed: Batch::new(capacity),
            detailed: Batch::new(capacity),
            vertices: Batch::new(capacity),
            groups: Groups::with_capacity(capacity),
            pairs: Pairs::new(capacity),
            shadow_rays: Batch::new(capacity),
            shadow_gains: Batch::new(capacity),
            blocked: vec![false; capacity].into(),
            finished: Batch::new(capacity),
            isa: Isa::current(),
            ledger: Ledger::default(),
        }
    }

    /// Traces every path of `block` and hands each to `sink`, in no particular order; with its parts by class where
    /// its pixel is watched.
    pub fn run<A: Accelerator, F: HitFilter>(
        &mut self,
        tracer: &Tracer<'_, A>,
        filter: &F,
        block: &Block,
        mut sink: impl FnMut(&PixelSample, Watched<'_>),
    ) {
        let pipeline = &tracer.plan.pipeline;
        let mut starts = block.iter();
        let mut clock = Clock::start();
        self.active.clear();
        self.free.clear();
        (0..self.slots.len() as u32).rev().for_each(|slot| self.free.push(slot));
        loop {
            self.generate(tracer, &mut starts, &mut clock);
            if self.active.is_empty() {
                return;
            }
            self.intersect(tracer, filter, &mut clock);
            self.tell_apart();
            self.environment(tracer, &mut clock);
            self.interact(tracer, &mut clock);
            if pipeline.emission || pipeline.bounded {
                self.emit(tracer, &mut clock);
            }
            self.active.clear();
            if pipeline.scatters() {
                self.materials(tracer, &mut clock);
                if pipeline.light_sampling {
                    self.sample_lights(tracer, &mut clock);
                    self.shadow(tracer, filter, &mut clock);
                }
                self.scatter(tracer, &mut clock);
                if pipeline.roulette {
                    self.roulette(&tracer.sampler, &mut clock);
                }
            }
            self.accumulate(&mut sink, &mut clock);
        }
    }

    /// Camera rays into free slots, as long as the block has samples left.
    fn generate<A: Accelerator>(
        &mut self,
        tracer: &Tracer<'_, A>,
        starts: &mut BlockPaths,
        clock: &mut Clock,
    ) {
        let before = self.active.len();
        let Self { slots, parts, free, active, begun, ledger, isa, .. } = self;
        loop {
            let count = begun.take(starts, free.len());
            if count == 0 {
                break;
            }
            begun.film(tracer, *isa);
            if tracer.plan.pipeline.lens {
                clock.charge(ledger, Stage::Generate);
                begun.lens(&tracer.sampler, *isa);
                clock.lap(ledger, Stage::Lens, count);
            }
            begun.rays(tracer, *isa);
            for path in begun.paths(tracer) {
                if let Some(slot) = free.pop() {
                    if path.cell != Path::UNWATCHED {
                        parts[slot as usize] = [Rgb::BLACK; Class::COUNT];
                    }
                    slots[slot as usize] = path;
                    active.push(slot);
                }
            }
        }
        let begun = self.active.len() - before;
        clock.lap(&mut self.ledger, Stage::Generate, begun);
    }

    /// Closest hits of all active paths.
    fn intersect<A: Accelerator, F: HitFilter>(
        &mut self,
        tracer: &Tracer<'_, A>,
        filter: &F,
        clock: &mut Clock,
    ) {
        self.rays.clear();
        for &slot in &*self.active {
            let path = &self.slots[slot as usize];
            self.rays.push(path.ray);
            self.ledger.count_path_ray(path.ray_class);
        }
        let hits = &mut self.hits[..self.rays.len()];
        tracer.accelerator.closest(&self.rays, filter, hits);
        clock.lap(&mut self.ledger, Stage::Intersect, self.rays.len());
    }

    /// Shadow rays towards a light for every vertex that can scatter its light.
    fn sample_lights<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.shadow_rays.clear();
        self.shadow_gains.clear();
        let position = |bounce| Dimension::LightPosition { bounce };
        let positions =
            self.pairs.draw(self.isa, &tracer.sampler, &self.vertices, &self.slots, position);
        self.groups.each(&mut LightStage {
            tracer,
            vertices: &self.vertices,
            slots: &self.slots,
            positions,
            shadow_rays: &mut self.shadow_rays,
            shadow_gains: &mut self.shadow_gains,
        });
        clock.lap(&mut self.ledger, Stage::SampleLights, self.vertices.len());
    }

    /// Adds the light of every shadow ray that nothing blocks; without shadows, of every light, and no ray is traced.
    fn shadow<A: Accelerator, F: HitFilter>(
        &mut self,
        tracer: &Tracer<'_, A>,
        filter: &F,
        clock: &mut Clock,
    ) {
        let pipeline = &tracer.plan.pipeline;
        if self.shadow_rays.is_empty() && !pipeline.everything {
            return;
        }
        if !pipeline.shadows {
            for &(slot, class, gain) in &*self.shadow_gains {
                self.slots[slot as usize].add(gain, class, &mut self.parts[slot as usize]);
                self.ledger.count_light_sample(class);
            }
            clock.charge(&mut self.ledger, Stage::SampleLights);
            return;
        }
        let blocked = &mut self.blocked[..self.shadow_rays.len()];
        tracer.accelerator.occluded(&self.shadow_rays, filter, blocked);
        for (&(slot, class, gain), blocked) in self.shadow_gains.iter().zip(blocked) {
            // A select, not a branch: what is blocked is random.
            let gain = if *blocked { Rgb::BLACK } else { gain };
            self.slots[slot as usize].add(gain, class, &mut self.parts[slot as usize]);
            self.ledger.count_light_sample(class);
        }
        clock.lap(&mut self.ledger, Stage::Shadow, self.shadow_rays.len());
    }

    /// Chooses where each path goes on.
    fn scatter<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        let direction = |bounce| Dimension::ScatterDirection { bounce };
        let directions =
            self.pairs.draw(self.isa, &tracer.sampler, &self.vertices, &self.slots, direction);
        self.groups.each(&mut ScatterStage {
            tracer,
            vertices: &self.vertices,
            directions,
            slots: &mut self.slots,
            active: &mut self.active,
            finished: &mut self.finished,
        });
        clock.lap(&mut self.ledger, Stage::Scatter, self.vertices.len());
    }

    /// Ends dim paths at random, and gives the survivors the energy of those that ended.
    fn roulette(&mut self, sampler: &Sampler, clock: &mut Clock) {
        let count = self.active.len();
        let (slots, finished) = (&mut self.slots, &mut self.finished);
        self.active.retain(|&slot| {
            let path = &mut slots[slot as usize];
            let bounce = path.bounce - 1;
            let survival = survival_probability(path.throughput, path.eta_scale, bounce);
            if survival < 1.0 {
                if sampler.one(path.key, Dimension::Roulette { bounce }) >= survival {
                    finished.push(slot);
                    return false;
                }
                path.throughput *= 1.0 / survival;
            }
            true
        });
        clock.lap(&mut self.ledger, Stage::Roulette, count);
    }

    /// Hands finished paths over and frees their slots.
    fn accumulate(&mut self, sink: &mut impl FnMut(&PixelSample, Watched<'_>), clock: &mut Clock) {
        for &slot in &*self.finished {
            let path = &self.slots[slot as usize];
            let sample = PixelSample {
                pixel: path.pixel,
                sample: path.sample,
                radiance: path.radiance * path.weight,
                coverage: path.coverage * path.weight,
                bounces: path.bounce,
                last_hit: path.last_hit,
            };
            if path.cell == Path::UNWATCHED {
                sink(&sample, None);
            } else {
                let parts = self.parts[slot as usize].map(|part| part * path.weight);
                sink(&sample, Some((path.cell, &parts)));
            }
            self.free.push(slot);
        }
        clock.lap(&mut self.ledger, Stage::Accumulate, self.finished.len());
    }
}
