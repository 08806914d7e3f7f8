//! Stage "sample lights": picks a light for every vertex that can scatter its light, evaluates the BSDF
//! towards it, and leaves a shadow ray with what it would add.

use super::batch::Batch;
use super::group::{Entry, GroupStage};
use super::path::Path;
use super::{RayKind, Tracer, Vertex, direct_class, power_heuristic, transmittance};
use crate::accel::Accelerator;
use crate::bsdf::Scatter;
use crate::geometry::Ray;
use crate::ledger::{Class, Events};
use crate::math::Rgb;
use crate::sampling::Dimension;

/// What the stage reads and writes.
pub(super) struct LightStage<'a, 't, A> {
    pub(super) tracer: &'a Tracer<'t, A>,
    pub(super) vertices: &'a [Vertex],
    pub(super) slots: &'a [Path],
    /// Where on its light each vertex looks.
    pub(super) positions: &'a [[f32; 2]],
    pub(super) shadow_rays: &'a mut Batch<Ray>,
    /// Slot, what the light adds to it if it is visible, and in which class.
    pub(super) shadow_gains: &'a mut Batch<(u32, Class, Rgb)>,
}

impl<A: Accelerator> GroupStage for LightStage<'_, '_, A> {
    fn visit<M: Scatter>(&mut self, group: &[Entry<M>]) {
        let world = self.tracer.world;
        let (lights, pipeline) = (&self.tracer.plan.lights, &self.tracer.plan.pipeline);
        for entry in group {
            let (vertex, model) = (&self.vertices[entry.vertex as usize], &entry.model);
            if model.is_delta() {
                continue;
            }
            let path = &self.slots[vertex.slot as usize];
            let bounce = path.bounce;
            let select = match pipeline.light_choice {
                true => self.tracer.sampler.one(path.key, Dimension::LightSelect { bounce }),
                false => 0.0,
            };
            let position = self.positions[entry.vertex as usize];
            let Some(light) = lights.sample(world, vertex.at.point, select, position) else {
                continue;
            };
            let wi = vertex.at.frame.local_from_world(light.direction);
            let value = model.evaluate(vertex.wo, wi);
            // Shading and geometric normal must agree on which side the light is, or it would leak.
            let is_same_side = (wi.z > 0.0) == (vertex.at.n_geometric.dot(light.direction) > 0.0);
            // By transmission, the light does more than arrive straight from its source.
            let confirmed = path.confirmed();
            let events = match wi.z < 0.0 {
                true => confirmed.followed_by(Events::REFRACTION),
                false => confirmed,
            };
            let class = events.class().unwrap_or(direct_class(light.kind));
            let adds = is_same_side & !value.f_cos.is_black() & pipeline.counts(events);
            let weight = match light.is_delta | !pipeline.combination {
                true => 1.0,
                false => power_heuristic(light.pdf_solid_angle, value.pdf_solid_angle),
            };
            let mut gain =
                path.throughput * value.f_cos * light.radiance * (weight / light.pdf_solid_angle);
            let origin = vertex.at.origin_towards(light.direction);
            let mut ray = match light.end {
                Some(end) => Ray::between(origin, end),
                None => Ray::new(origin, light.direction),
            };
            // What the medium absorbs on the way, as of a scattered ray: nothing of what comes from infinity.
            if let (true, Some(end)) = (pipeline.absorption, light.end) {
                let absorption = match wi.z < 0.0 {
                    true => self.tracer.absorption_beyond(&vertex.at),
                    false => path.absorption,
                };
                gain *= transmittance(absorption, (end - origin).length());
            }
            ray.id = self.tracer.ray_id(path.key, bounce, RayKind::Shadow);
            self.shadow_rays.push_if(adds, ray);
            self.shadow_gains.push_if(adds, (vertex.slot, class, gain));
        }
    }
}
