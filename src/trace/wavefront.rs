//! The wavefront: many paths advance together, one stage at a time.
//!
//! ```text
//! generate -> [ intersect -> interact -> emit -> sample lights -> shadow -> scatter -> roulette ]* -> accumulate
//! ```
//! A stage is a plain loop over the batch, so each is timed with two clock reads and its inner loop stays
//! small. Finished slots are refilled with the block's next samples, so batches stay full to the end.
//! Every path draws its own named numbers and sums its own radiance, so batch size, order and grouping
//! change no bit. Source of the estimator: Veach 1997, chapters 9 and 10 (light and BSDF sampling,
//! combined by the power heuristic).

use super::path::Path;
use super::{Block, PixelSample, RayKind, Tracer, power_heuristic, survival_probability};
use crate::accel::{Accelerator, HitFilter};
use crate::bsdf::{Bsdf, Scatter};
use crate::geometry::{Hit, Ray};
use crate::ledger::{Clock, Ledger, Stage};
use crate::math::{Rgb, Vec3, fun};
use crate::sampling::Dimension;
use crate::world::SurfaceInteraction;

/// A path vertex on a surface.
#[derive(Clone, Copy)]
struct Vertex {
    slot: u32,
    at: SurfaceInteraction,
    bsdf: Bsdf,
    /// Direction back along the ray, in the shading frame.
    wo: Vec3,
}

/// The arrays of one worker. They are allocated once; the bounce loop allocates nothing.
pub struct Wavefront {
    slots: Vec<Path>,
    free: Vec<u32>,
    /// Slots whose path goes on.
    active: Vec<u32>,
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    vertices: Vec<Vertex>,
    shadow_rays: Vec<Ray>,
    /// Slot, and what the light adds to it if it is visible.
    shadow_gains: Vec<(u32, Rgb)>,
    blocked: Vec<bool>,
    /// Slots whose path has ended.
    finished: Vec<u32>,
    capacity: usize,
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
            slots: Vec::with_capacity(capacity),
            free: Vec::with_capacity(capacity),
            active: Vec::with_capacity(capacity),
            rays: Vec::with_capacity(capacity),
            hits: Vec::with_capacity(capacity),
            vertices: Vec::with_capacity(capacity),
            shadow_rays: Vec::with_capacity(capacity),
            shadow_gains: Vec::with_capacity(capacity),
            blocked: Vec::with_capacity(capacity),
            finished: Vec::with_capacity(capacity),
            capacity,
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
        self.slots.clear();
        self.free.clear();
        self.active.clear();
        loop {
            self.generate(tracer, &mut starts, &mut clock);
            if self.active.is_empty() {
                return;
            }
            self.intersect(tracer, filter, &mut clock);
            self.interact(tracer, &mut clock);
            self.emit(tracer, &mut clock);
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
        for (pixel, sample) in starts.take(self.capacity - before) {
            let path = Path::begin(&tracer.camera_ray(pixel, sample), pixel, sample);
            let slot = match self.free.pop() {
                Some(slot) => {
                    self.slots[slot as usize] = path;
                    slot
                }
                None => {
                    self.slots.push(path);
                    self.slots.len() as u32 - 1
                }
            };
            self.active.push(slot);
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
        self.rays.extend(self.active.iter().map(|&slot| self.slots[slot as usize].ray));
        self.hits.resize(self.rays.len(), Hit::MISS);
        tracer.accelerator.closest(&self.rays, filter, &mut self.hits);
        clock.lap(&mut self.ledger, Stage::Intersect, self.rays.len());
    }

    /// Hits to path vertices; paths that left the scene see the lights at infinity and end.
    fn interact<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.vertices.clear();
        self.finished.clear();
        for (&slot, hit) in self.active.iter().zip(&self.hits) {
            let path = &mut self.slots[slot as usize];
            if !hit.is_hit() {
                if !(tracer.hide_background && path.bounce == 0) {
                    for (radiance, pdf) in tracer.world.lights.at_infinity(path.ray.direction) {
                        let weight = if path.is_delta {
                            1.0
                        } else {
                            power_heuristic(path.pdf_solid_angle, pdf)
                        };
                        path.radiance += path.throughput * radiance * weight;
                    }
                }
                self.finished.push(slot);
                continue;
            }
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
            let bsdf = tracer.world.bsdf(&at);
            self.vertices.push(Vertex { slot, at, bsdf, wo });
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

    /// Picks a light for every vertex that can scatter its light, and evaluates the BSDF towards it.
    fn sample_lights<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.shadow_rays.clear();
        self.shadow_gains.clear();
        let lights = &tracer.world.lights;
        if lights.is_empty() {
            return;
        }
        for vertex in &self.vertices {
            if vertex.bsdf.is_delta() {
                continue;
            }
            let path = &self.slots[vertex.slot as usize];
            let bounce = path.bounce;
            let select = path.sampler.one(Dimension::LightSelect { bounce });
            let position = path.sampler.two(Dimension::LightPosition { bounce });
            let Some(light) = lights.sample(tracer.world, vertex.at.point, select, position) else {
                continue;
            };
            let wi = vertex.at.frame.local_from_world(light.direction);
            // Shading and geometric normal must agree on which side the light is, or it would leak.
            if (wi.z > 0.0) != (vertex.at.n_geometric.dot(light.direction) > 0.0) {
                continue;
            }
            let value = vertex.bsdf.evaluate(vertex.wo, wi);
            if value.f_cos.is_black() {
                continue;
            }
            let weight = if light.is_delta {
                1.0
            } else {
                power_heuristic(light.pdf_solid_angle, value.pdf_solid_angle)
            };
            let factor = weight / light.pdf_solid_angle;
            let gain = path.throughput * value.f_cos * light.radiance * factor;
            let origin = vertex.at.origin_towards(light.direction);
            let mut ray = match light.end {
                Some(end) => Ray::between(origin, end),
                None => Ray::new(origin, light.direction),
            };
            ray.id = path.sampler.ray_id(bounce, RayKind::Shadow as u32);
            self.shadow_rays.push(ray);
            self.shadow_gains.push((vertex.slot, gain));
        }
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
        self.blocked.resize(self.shadow_rays.len(), false);
        tracer.accelerator.occluded(&self.shadow_rays, filter, &mut self.blocked);
        for (&(slot, gain), blocked) in self.shadow_gains.iter().zip(&self.blocked) {
            if !blocked {
                self.slots[slot as usize].radiance += gain;
            }
        }
        self.ledger.shadow_rays += self.shadow_rays.len() as u64;
        clock.lap(&mut self.ledger, Stage::Shadow, self.shadow_rays.len());
    }

    /// Chooses where each path goes on.
    fn scatter<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.active.clear();
        for vertex in &self.vertices {
            let path = &mut self.slots[vertex.slot as usize];
            if scatter_path(path, vertex, tracer) {
                self.active.push(vertex.slot);
            } else {
                self.finished.push(vertex.slot);
            }
        }
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
        for &slot in &self.finished {
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

/// Samples the BSDF and sets the path's next ray; false where the path ends.
#[inline]
fn scatter_path<A: Accelerator>(path: &mut Path, vertex: &Vertex, tracer: &Tracer<'_, A>) -> bool {
    let bounce = path.bounce;
    let lobe = path.sampler.one(Dimension::ScatterLobe { bounce });
    let direction = path.sampler.two(Dimension::ScatterDirection { bounce });
    let Some(sample) = vertex.bsdf.sample(vertex.wo, lobe, direction) else {
        return false;
    };
    let wi = vertex.at.frame.world_from_local(sample.wi);
    if (sample.wi.z > 0.0) != (vertex.at.n_geometric.dot(wi) > 0.0) {
        return false;
    }
    path.throughput *= sample.weight;
    if path.throughput.is_black() {
        return false;
    }
    if sample.wi.z < 0.0 {
        let inside = tracer.world.absorption(vertex.at.material);
        path.absorption = inside.filter(|_| vertex.at.entering).unwrap_or(Rgb::BLACK);
    }
    if !sample.is_delta {
        path.cone_spread += SCATTERED_SPREAD;
    }
    path.pdf_solid_angle = sample.pdf_solid_angle;
    path.is_delta = sample.is_delta;
    path.eta_scale *= sample.eta_scale;
    path.bounce += 1;
    path.ray = Ray::new(vertex.at.origin_towards(wi), wi);
    path.ray.id = path.sampler.ray_id(path.bounce, RayKind::Path as u32);
    true
}

/// Growth of the ray cone (radians) at a rough scattering: textures seen by scattered light are looked up
/// in coarser levels, far below the width of the scattering lobe itself.
pub(super) const SCATTERED_SPREAD: f32 = 0.05;
