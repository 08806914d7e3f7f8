//! The wavefront: many paths advance together, one stage at a time.
//!
//! ```text
//! generate -> [ intersect -> interact -> emit -> materials -> sample lights -> shadow -> scatter -> roulette ]* -> accumulate
//! ```
//! A stage is a plain loop over the batch, so each is timed with two clock reads and its inner loop stays
//! small. Finished slots are refilled with the block's next samples, so batches stay full to the end.
//! Every path draws its own named numbers and sums its own radiance, so batch size, order and grouping
//! change no bit. Source of the estimator: Veach 1997, chapters 9 and 10 (light and BSDF sampling,
//! combined by the power heuristic).

use super::batch::Batch;
use super::generate_stage::Starts;
use super::group::{Groups, Receiver};
use super::light_stage::LightStage;
use super::numbers::Pairs;
use super::path::Path;
use super::scatter_stage::ScatterStage;
use super::{Block, PixelSample, Tracer, Vertex, power_heuristic, survival_probability};
use crate::accel::{Accelerator, HitFilter};
use crate::geometry::{Hit, Ray};
use crate::ledger::{Clock, Ledger, Stage};
use crate::math::{Rgb, fun};
use crate::os::Isa;
use crate::sampling::Dimension;

/// The arrays of one worker. They are allocated once; the bounce loop allocates nothing.
pub struct Wavefront {
    begun: Starts,
    slots: Box<[Path]>,
    /// Slots without a path.
    free: Batch<u32>,
    /// Slots whose path goes on.
    active: Batch<u32>,
    rays: Batch<Ray>,
    hits: Box<[Hit]>,
    /// Places of the rays that met something, and of those that left the scene.
    met: Batch<u32>,
    missed: Batch<u32>,
    vertices: Batch<Vertex>,
    groups: Groups,
    /// Random numbers of the vertices, for the stage at hand.
    pairs: Pairs,
    shadow_rays: Batch<Ray>,
    /// Slot, and what the light adds to it if it is visible.
    shadow_gains: Batch<(u32, Rgb)>,
    blocked: Box<[bool]>,
    /// Slots whose path has ended.
    finished: Batch<u32>,
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
            free: Batch::new(capacity),
            active: Batch::new(capacity),
            rays: Batch::new(capacity),
            hits: vec![Hit::MISS; capacity].into(),
            met: Batch::new(capacity),
            missed: Batch::new(capacity),
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

    /// Traces every path of `block` and hands each to `sink`, in no particular order.
    pub fn run<A: Accelerator, F: HitFilter>(
        &mut self,
        tracer: &Tracer<'_, A>,
        filter: &F,
        block: &Block,
        mut sink: impl FnMut(&PixelSample),
    ) {
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
            self.interact(tracer, &mut clock);
            self.emit(tracer, &mut clock);
            self.materials(tracer, &mut clock);
            self.sample_lights(tracer, &mut clock);
            self.shadow(tracer, filter, &mut clock);
            self.scatter(tracer, &mut clock);
            self.roulette(&mut clock);
            self.accumulate(&mut sink, &mut clock);
        }
    }

    /// Camera rays into free slots, as long as the block has samples left.
    fn generate<A: Accelerator>(
        &mut self,
        tracer: &Tracer<'_, A>,
        starts: &mut impl Iterator<Item = ([u32; 2], u64)>,
        clock: &mut Clock,
    ) {
        let before = self.active.len();
        let Self { slots, free, active, begun, .. } = self;
        while begun.take(tracer, self.isa, starts, free.len()) > 0 {
            for path in begun.paths(tracer) {
                if let Some(slot) = free.pop() {
                    slots[slot as usize] = path;
                    active.push(slot);
                }
            }
        }
        let begun = self.active.len() - before;
        self.ledger.camera_rays += begun as u64;
        self.ledger.bounce_rays += before as u64;
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
            self.rays.push(self.slots[slot as usize].ray);
        }
        let hits = &mut self.hits[..self.rays.len()];
        tracer.accelerator.closest(&self.rays, filter, hits);
        clock.lap(&mut self.ledger, Stage::Intersect, self.rays.len());
    }

    /// Hits to path vertices; paths that left the scene see the lights at infinity and end.
    fn interact<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.vertices.clear();
        self.finished.clear();
        // Which rays met something is random: told apart without a branch, before two straight loops.
        self.met.clear();
        self.missed.clear();
        for (hit, i) in self.hits[..self.active.len()].iter().zip(0..) {
            self.met.push_if(hit.is_hit(), i);
            self.missed.push_if(!hit.is_hit(), i);
        }
        for &i in &*self.missed {
            let slot = self.active[i as usize];
            let path = &mut self.slots[slot as usize];
            if !(tracer.hide_background && path.bounce == 0) {
                for (radiance, pdf) in tracer.world.lights.at_infinity(path.ray.direction) {
                    let weight = match path.is_delta {
                        true => 1.0,
                        false => power_heuristic(path.pdf_solid_angle, pdf),
                    };
                    path.radiance += path.throughput * radiance * weight;
                }
            }
            self.finished.push(slot);
        }
        for &i in &*self.met {
            let (slot, hit) = (self.active[i as usize], &self.hits[i as usize]);
            let path = &mut self.slots[slot as usize];
            // What the medium absorbed on the way (Beer-Lambert).
            if !path.absorption.is_black() {
                path.throughput *= (path.absorption * -hit.t).map(fun::exp);
            }
            if path.bounce == 0 {
                path.coverage = 1.0;
            }
            path.cone_width += path.cone_spread * hit.t;
            path.last_hit = hit.id;
            let at = tracer.world.interact(&path.ray, hit, path.cone_width);
            let wo = at.frame.local_from_world(-path.ray.direction);
            self.vertices.push(Vertex { slot, at, wo });
        }
        clock.lap(&mut self.ledger, Stage::Interact, self.active.len());
    }

    /// Emission of the surfaces that the rays met; paths at their last segment end.
    fn emit<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        let count = self.vertices.len();
        let (slots, finished) = (&mut self.slots, &mut self.finished);
        self.vertices.retain(|vertex| {
            let path = &mut slots[vertex.slot as usize];
            let emitted = tracer.world.emitted(&vertex.at);
            if !emitted.is_black() {
                let weight = if path.is_delta {
                    1.0
                } else {
                    let distance = (vertex.at.point - path.ray.origin).length();
                    let cos_theta = vertex.at.n_geometric.dot(path.ray.direction);
                    let lights = &tracer.world.lights;
                    let pdf = lights.pdf_of_emitter(vertex.at.material, distance, cos_theta);
                    power_heuristic(path.pdf_solid_angle, pdf)
                };
                path.radiance += path.throughput * emitted * weight;
            }
            let goes_on = path.bounce + 1 < tracer.max_depth;
            if !goes_on {
                finished.push(vertex.slot);
            }
            goes_on
        });
        clock.lap(&mut self.ledger, Stage::Emit, count);
    }

    /// The scattering model of every vertex, filed by its kind.
    fn materials<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.groups.clear();
        for (vertex, i) in self.vertices.iter().zip(0..) {
            let mut receiver = Receiver { groups: &mut self.groups, vertex: i };
            tracer.world.scattering(&vertex.at, &mut receiver);
        }
        clock.lap(&mut self.ledger, Stage::Materials, self.vertices.len());
    }

    /// Shadow rays towards a light for every vertex that can scatter its light.
    fn sample_lights<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.shadow_rays.clear();
        self.shadow_gains.clear();
        if tracer.world.lights.is_empty() {
            return;
        }
        let position = |bounce| Dimension::LightPosition { bounce };
        let positions = self.pairs.draw(self.isa, &self.vertices, &self.slots, position);
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

    /// Adds the light of every shadow ray that nothing blocks.
    fn shadow<A: Accelerator, F: HitFilter>(
        &mut self,
        tracer: &Tracer<'_, A>,
        filter: &F,
        clock: &mut Clock,
    ) {
        if self.shadow_rays.is_empty() {
            return;
        }
        let blocked = &mut self.blocked[..self.shadow_rays.len()];
        tracer.accelerator.occluded(&self.shadow_rays, filter, blocked);
        for (&(slot, gain), blocked) in self.shadow_gains.iter().zip(blocked) {
            // A select, not a branch: what is blocked is random.
            self.slots[slot as usize].radiance += if *blocked { Rgb::BLACK } else { gain };
        }
        self.ledger.shadow_rays += self.shadow_rays.len() as u64;
        clock.lap(&mut self.ledger, Stage::Shadow, self.shadow_rays.len());
    }

    /// Chooses where each path goes on.
    fn scatter<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.active.clear();
        let direction = |bounce| Dimension::ScatterDirection { bounce };
        let directions = self.pairs.draw(self.isa, &self.vertices, &self.slots, direction);
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
    fn roulette(&mut self, clock: &mut Clock) {
        let count = self.active.len();
        let (slots, finished) = (&mut self.slots, &mut self.finished);
        self.active.retain(|&slot| {
            let path = &mut slots[slot as usize];
            let bounce = path.bounce - 1;
            let survival = survival_probability(path.throughput, path.eta_scale, bounce);
            if survival < 1.0 {
                if path.sampler.one(Dimension::Roulette { bounce }) >= survival {
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
    fn accumulate(&mut self, sink: &mut impl FnMut(&PixelSample), clock: &mut Clock) {
        for &slot in &*self.finished {
            let path = &self.slots[slot as usize];
            sink(&PixelSample {
                pixel: path.pixel,
                sample: path.sample,
                radiance: path.radiance * path.weight,
                coverage: path.coverage * path.weight,
                bounces: path.bounce,
                last_hit: path.last_hit,
            });
            self.free.push(slot);
        }
        clock.lap(&mut self.ledger, Stage::Accumulate, self.finished.len());
    }
}
