//! Stages "environment", "interact", "details", "emit", "materials" and "textures": what rays met.

use super::group::Receiver;
use super::path::Path;
use super::wavefront::Wavefront;
use super::{ClassRadiance, Tracer, Vertex, power_heuristic, transmittance};
use crate::accel::Accelerator;
use crate::geometry::Hit;
use crate::ledger::{Class, Clock, Ledger, Stage};
use crate::light::LightKind;
use crate::math::Rgb;
use crate::world::Details;

impl Wavefront {
    /// Tells the rays that met something from those that left the scene.
    pub(super) fn tell_apart(&mut self) {
        // Which are which is random: told apart without a branch, before straight loops.
        self.met.clear();
        self.missed.clear();
        for (hit, i) in self.hits[..self.active.len()].iter().zip(0..) {
            self.met.push_if(hit.is_hit(), i);
            self.missed.push_if(!hit.is_hit(), i);
        }
    }

    /// Paths that left the scene see the lights at infinity, if there are any, and end.
    pub(super) fn environment<A: Accelerator>(
        &mut self,
        tracer: &Tracer<'_, A>,
        clock: &mut Clock,
    ) {
        self.finished.clear();
        let plan = tracer.plan;
        for &i in &*self.missed {
            let slot = self.active[i as usize];
            self.finished.push(slot);
            if !plan.pipeline.environment {
                continue;
            }
            let path = &mut self.slots[slot as usize];
            let seen = plan.lights.at_infinity(tracer.world, path.ray.direction);
            for (kind, radiance, pdf) in seen.filter(|seen| !seen.1.is_black()) {
                if let Some(class) = path.class_of_met(kind, &plan.pipeline) {
                    path.met_light(class, &mut self.ledger);
                    let weight = match path.is_delta || !plan.pipeline.combination {
                        true => 1.0,
                        false => power_heuristic(path.pdf_solid_angle, pdf),
                    };
                    let gain = path.throughput * radiance * weight;
                    path.add(gain, class, &mut self.parts[slot as usize]);
                }
            }
        }
        if plan.pipeline.environment {
            clock.lap(&mut self.ledger, Stage::Environment, self.missed.len());
        }
    }

    /// Hits to path vertices: first those that look nothing up, then those that do.
    pub(super) fn interact<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.vertices.clear();
        self.detailed.clear();
        let details = tracer.plan.pipeline.details;
        if details == Details::Nowhere {
            for k in 0..self.met.len() {
                self.expand(tracer, self.met[k], false);
            }
        } else {
            for k in 0..self.met.len() {
                let i = self.met[k];
                if tracer.world.is_detailed(self.hits[i as usize].id, details) {
                    self.detailed.push(i);
                } else {
                    self.expand(tracer, i, false);
                }
            }
        }
        clock.lap(&mut self.ledger, Stage::Interact, self.vertices.len());
        if details != Details::Nowhere {
            for k in 0..self.detailed.len() {
                self.expand(tracer, self.detailed[k], true);
            }
            clock.lap(&mut self.ledger, Stage::Details, self.detailed.len());
        }
    }

    /// The path vertex of ray number `i`, which met something.
    #[inline(always)]
    fn expand<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, i: u32, is_detailed: bool) {
        let (slot, hit): (u32, &Hit) = (self.active[i as usize], &self.hits[i as usize]);
        let path = &mut self.slots[slot as usize];
        path.throughput *= transmittance(path.absorption, hit.t);
        if path.bounce == 0 {
            path.coverage = 1.0;
        }
        path.cone_width += path.cone_spread * hit.t;
        path.last_hit = hit.id;
        let at = tracer.world.interact(&path.ray, hit, path.cone_width, is_detailed);
        let wo = at.frame.local_from_world(-path.ray.direction);
        self.vertices.push(Vertex { slot, is_detailed, at, wo });
    }

    /// Emission of the surfaces that the rays met; paths at their last segment end.
    pub(super) fn emit<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        let count = self.vertices.len();
        let pipeline = &tracer.plan.pipeline;
        let (slots, parts) = (&mut self.slots, &mut self.parts);
        if pipeline.emission {
            for vertex in &*self.vertices {
                let emitted = tracer.world.emitted(&vertex.at);
                if !emitted.is_black() {
                    let path = &mut slots[vertex.slot as usize];
                    let parts = &mut parts[vertex.slot as usize];
                    add_emission(tracer, path, vertex, emitted, parts, &mut self.ledger);
                }
            }
        }
        let finished = &mut self.finished;
        if pipeline.bounded {
            self.vertices.retain(|vertex| {
                let path = &slots[vertex.slot as usize];
                let goes_on = path.bounce + 1 < pipeline.max_depth && !path.only_looks_for_lights;
                if !goes_on {
                    finished.push(vertex.slot);
                }
                goes_on
            });
        }
        clock.lap(&mut self.ledger, Stage::Emit, count);
    }

    /// The scattering model of every vertex, filed by its kind.
    pub(super) fn materials<A: Accelerator>(&mut self, tracer: &Tracer<'_, A>, clock: &mut Clock) {
        self.groups.clear();
        let plain = self.vertices.partition_point(|vertex| !vertex.is_detailed);
        let mut file = |range: std::ops::Range<usize>| {
            for i in range {
                let mut receiver = Receiver { groups: &mut self.groups, vertex: i as u32 };
                tracer.world.scattering(&self.vertices[i].at, &mut receiver);
            }
        };
        file(0..plain);
        clock.lap(&mut self.ledger, Stage::Materials, plain);
        if tracer.plan.pipeline.details != Details::Nowhere {
            file(plain..self.vertices.len());
            clock.lap(&mut self.ledger, Stage::Textures, self.vertices.len() - plain);
        }
    }
}

/// Adds what a surface emits towards the ray that met it.
#[inline]
fn add_emission<A: Accelerator>(
    tracer: &Tracer<'_, A>,
    path: &mut Path,
    vertex: &Vertex,
    emitted: Rgb,
    parts: &mut ClassRadiance,
    ledger: &mut Ledger,
) {
    let plan = tracer.plan;
    let class: Option<Class> = path.class_of_met(LightKind::Surface, &plan.pipeline);
    let Some(class) = class else { return };
    path.met_light(class, ledger);
    let weight = if path.is_delta || !plan.pipeline.combination {
        1.0
    } else {
        let distance = (vertex.at.point - path.ray.origin).length();
        let cos_theta = vertex.at.n_geometric.dot(path.ray.direction);
        let pdf = plan.lights.pdf_of_emitter(vertex.at.material, distance, cos_theta);
        power_heuristic(path.pdf_solid_angle, pdf)
    };
    path.add(path.throughput * emitted * weight, class, parts);
}
